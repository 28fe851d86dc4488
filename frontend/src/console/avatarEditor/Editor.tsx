/** The editor of one avatar: the body with its joints, the table, and everything else in tabs. */
import { Button, Tabs } from "@mantine/core";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useEffect, useRef, useState } from "react";
import { useLocation } from "wouter";
import { bodiesQuery } from "../bodies/queries";
import { LeaveGuard } from "../editor/LeaveGuard";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { type AvatarVersionDetail, type AvatarView, avatars, type Loss } from "./api";
import { type AvatarFile, differences, partOf } from "./axes";
import { BodyPanel } from "./BodyPanel";
import { CastPanel } from "./CastPanel";
import { CollisionPanel } from "./CollisionPanel";
import { ConvertDialog } from "./ConvertDialog";
import classes from "./Editor.module.css";
import { Head, StayingButton, UndoButtons } from "./Head";
import { ImportDialog, type ReadFile } from "./ImportDialog";
import { JointPicture } from "./JointPicture";
import { JointTable, type View } from "./JointTable";
import { isJustMade } from "./justMade";
import { KeptDrafts, useKeptDrafts } from "./KeptDrafts";
import { Mirrored, MirrorMenu, useMirroring } from "./Mirror";
import { withOwnChanges } from "./merge";
import { loadFile } from "./operations";
import { readAvatarFile } from "./readFile";
import { SaveDialog } from "./SaveDialog";
import { Trouble } from "./Trouble";
import { TABS, type Tab } from "./tabs";
import { Tryout } from "./tryout/Tryout";
import { TuningPanel } from "./tuning/TuningPanel";
import { UseInStudy } from "./UseInStudy";
import { useKeys } from "./useKeys";
import { useWork, type WorkState } from "./useWork";
import { VersionsPanel } from "./VersionsPanel";

interface AvatarEditorProps {
  readonly avatar: AvatarView;
  readonly base: AvatarVersionDetail;
  /** The version that the address leads to, in the list of versions. */
  readonly linked: number | null;
  /** A version that the address names and the avatar does not have. */
  readonly missing: string | null;
  readonly first: WorkState;
  /** The work goes on from another saved version. */
  readonly onBase: (version: AvatarVersionDetail) => void;
  readonly onSaved: (saved: AvatarView) => void;
}

/** The body that stands for any where a configuration names none. */
const NEUTRAL = "neutral";
const NO_AXES: ReadonlySet<string> = new Set();
const SHOWN_TAB = '[role="tab"][aria-selected="true"]';
const FIRST_AXIS = "LeftLowerLegX";

export function AvatarEditor(props: AvatarEditorProps): JSX.Element {
  const { avatar, base, linked, missing, first, onBase, onSaved } = props;
  const texts = useTexts();
  const { t } = texts;
  const [, navigate] = useLocation();
  const can = usePermissions();
  const isReadOnly = !can("body");
  const work = useWork(first);
  const { configuration } = work;
  const [tab, setTab] = useState<Tab>(linked === null ? "joints" : "versions");
  const [view, setView] = useState<View>("axes");
  const [losses, setLosses] = useState<readonly Loss[] | null>(null);
  const [chosen, setChosen] = useState<string | null>(FIRST_AXIS);
  const [selected, setSelected] = useState<ReadonlySet<string>>(NO_AXES);
  const tabs = useRef<HTMLDivElement>(null);
  const [isSaving, setSaving] = useState(false);
  const [used, setUsed] = useState<number | null>(null);
  const [file, setFile] = useState<ReadFile | null>(null);
  const isChanged = work.contentHash !== base.content_hash;
  const unsaved = isChanged ? differences(base.configuration, configuration).length : 0;
  const kept = useKeptDrafts(avatar, base, onBase, work, isChanged);
  useKeys(work, isReadOnly, () => isChanged && setSaving(true));
  const mirroring = useMirroring(work);
  useEffect(() => {
    if (isJustMade()) tabs.current?.querySelector<HTMLElement>(SHOWN_TAB)?.focus();
  }, []);
  const toTab = () => tabs.current?.querySelector<HTMLElement>(SHOWN_TAB)?.focus();
  // To the cell of the table where the arrows begin, or to the tabs where there is no table.
  const toWork = () => {
    const cell = tabs.current?.querySelector<HTMLElement>('[role="treegrid"] [tabindex="0"]');
    (cell ?? tabs.current?.querySelector<HTMLElement>(SHOWN_TAB))?.focus();
  };
  const chosenAxis = axisOf(configuration, chosen);
  const bodies = useQuery(bodiesQuery);
  const neutral = bodies.data?.humanoids.find(({ name }) => name === NEUTRAL);
  const bodyHash = configuration.humanoid ?? neutral?.content_hash ?? null;
  const newestFile = useRef<File | null>(null);
  const show = async (wished: View) => {
    setSelected(NO_AXES);
    // People who only read convert nothing, so they lose nothing.
    if (wished === "axes" || isReadOnly) return setView(wished);
    try {
      const { lost } = await avatars.edit(configuration, [
        { operation: "convert", to: "single", targets: ["all"] },
      ]);
      if (lost.length === 0) setView(wished);
      else setLosses(lost);
    } catch (failure) {
      work.fail(failure);
    }
  };
  const openFile = async (chosenFile: File) => {
    work.dismiss();
    newestFile.current = chosenFile;
    // What is found out about a file counts only until another one is chosen.
    const isNewest = () => newestFile.current === chosenFile;
    try {
      const read = await readAvatarFile(chosenFile, texts);
      if (isNewest()) setFile(read);
    } catch (failure) {
      if (isNewest()) work.fail(failure);
    }
  };
  const follow = async (theirs: AvatarView): Promise<boolean> => {
    const merged = withOwnChanges(base.configuration, configuration, theirs.newest.configuration);
    const label = t("avatars.did.follow", { number: theirs.newest.number });
    const isMade = await work.editFrom(theirs.newest, loadFile(merged), label);
    if (isMade) onSaved(theirs);
    return isMade;
  };
  return (
    <div className={classes.page}>
      <LeaveGuard unsaved={isChanged && !isReadOnly} />
      <button type="button" className={classes.toTable} onClick={toWork}>
        {t("avatars.toTable")}
      </button>
      <Head avatar={avatar} base={base} work={work} unsaved={unsaved}>
        {!isReadOnly && (
          <div className={classes.buttons}>
            <UndoButtons work={work} />
            <MirrorMenu mirroring={mirroring} selected={view === "axes" ? selected : NO_AXES} />
            {can("design") && (
              <Button size="xs" variant="default" onClick={() => setUsed(base.number)}>
                {t("avatars.use")}
              </Button>
            )}
            <StayingButton isOff={!isChanged} onClick={() => setSaving(true)}>
              {t("avatars.save")}
            </StayingButton>
          </div>
        )}
      </Head>
      {missing !== null && (
        <Notice tone="warn" title={t("avatars.missing", { title: avatar.title, version: missing })}>
          {t("avatars.missing.instead", { number: base.number })}
        </Notice>
      )}
      <KeptDrafts
        kept={kept}
        avatar={avatar}
        base={base}
        configuration={configuration}
        onGone={toTab}
      />
      <Mirrored mirroring={mirroring} work={work} onGone={toTab} />
      <Trouble work={work} onUnderstood={toTab} />
      {/* Above both columns, so that it stays where it is when the picture goes. */}
      <Tabs
        value={tab}
        onChange={(value) => value !== null && setTab(value as Tab)}
        keepMounted={false}
        ref={tabs}
        className={classes.tabs ?? ""}
      >
        <Tabs.List aria-label={avatar.title}>
          {Object.keys(TABS).map((name) => (
            <Tabs.Tab key={name} value={name}>
              {t(`avatars.tab.${name as Tab}`)}
            </Tabs.Tab>
          ))}
        </Tabs.List>
        <div className={classes.columns} data-wide={TABS[tab].isWide || undefined}>
          {!TABS[tab].isWide && (
            <JointPicture
              configuration={configuration}
              bodyHash={bodyHash}
              chosen={chosenAxis}
              selected={view === "axes" ? selected : NO_AXES}
              onChoose={setChosen}
            />
          )}
          <div className={classes.panelsOfTabs}>
            <Tabs.Panel value="joints">
              <JointTable
                configuration={configuration}
                base={base.configuration}
                joints={work.joints}
                baseJoints={base.joints}
                view={view}
                onView={(wished) => void show(wished)}
                chosen={chosen}
                onChoose={setChosen}
                selected={selected}
                onSelected={setSelected}
                edit={work.edit}
                isReadOnly={isReadOnly}
                onCompliance={() => setTab("body")}
              />
            </Tabs.Panel>
            <Tabs.Panel value="body">
              <BodyPanel
                configuration={configuration}
                base={base.configuration}
                edit={work.edit}
                isReadOnly={isReadOnly}
              />
            </Tabs.Panel>
            <Tabs.Panel value="collisions">
              <CollisionPanel
                configuration={configuration}
                base={base.configuration}
                edit={work.edit}
                isReadOnly={isReadOnly}
              />
            </Tabs.Panel>
            <Tabs.Panel value="casts">
              <CastPanel configuration={configuration} edit={work.edit} isReadOnly={isReadOnly} />
            </Tabs.Panel>
            <Tabs.Panel value="tryout">
              <Tryout
                title={avatar.title}
                configuration={configuration}
                axis={chosenAxis}
                onAxis={setChosen}
              />
            </Tabs.Panel>
            <Tabs.Panel value="tuning">
              <TuningPanel
                avatarKey={avatar.key}
                base={base}
                configuration={configuration}
                contentHash={work.contentHash}
                chosen={chosenAxis}
                selected={view === "axes" ? selected : NO_AXES}
                edit={work.edit}
                isReadOnly={isReadOnly}
              />
            </Tabs.Panel>
            <Tabs.Panel value="versions">
              <VersionsPanel
                avatar={avatar}
                basedOn={base.number}
                linked={linked}
                onUse={can("design") ? setUsed : undefined}
                configuration={configuration}
                edit={work.edit}
                onFile={(one) => void openFile(one)}
                isReadOnly={isReadOnly}
              />
            </Tabs.Panel>
          </div>
        </div>
      </Tabs>
      <ConvertDialog
        losses={losses}
        isReadOnly={isReadOnly}
        onClose={() => setLosses(null)}
        onLook={() => {
          setLosses(null);
          setView("parts");
        }}
        onConvert={() => {
          setLosses(null);
          setView("parts");
          void work.edit(
            [{ operation: "convert", to: "single", targets: ["all"] }],
            t("avatars.did.convert"),
          );
        }}
      />
      <ImportDialog
        file={file}
        configuration={configuration}
        unsaved={unsaved}
        onClose={() => setFile(null)}
        onReplace={({ name, configuration: read }) => {
          setFile(null);
          void work.edit(loadFile(read), t("avatars.did.file", { name }), "loaded");
        }}
      />
      <UseInStudy
        avatarKey={avatar.key}
        title={avatar.title}
        version={used}
        unsaved={unsaved}
        onClose={() => setUsed(null)}
      />
      <SaveDialog
        isOpen={isSaving}
        onClose={() => setSaving(false)}
        avatarKey={avatar.key}
        title={avatar.title}
        basedOn={base.number}
        base={base.configuration}
        configuration={configuration}
        made={work.madeSince(base.content_hash)}
        onFollow={follow}
        onSaved={(saved) => {
          setSaving(false);
          kept.forget();
          if (saved.key === avatar.key) onSaved(saved);
          else navigate(`/avatars/${saved.key}`);
        }}
      />
    </div>
  );
}

/** The chosen axis; in the single template a part is chosen, and its first axis stands for it. */
const axisOf = (configuration: AvatarFile, chosen: string | null): string | null =>
  chosen === null || chosen in configuration.axes
    ? chosen
    : (Object.keys(configuration.axes).find((axis) => partOf(axis) === chosen) ?? null);
