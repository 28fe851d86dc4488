/** The joint map: 22 joints of the body, each with the joint of the skeleton assigned to it. */
import { Button, Center, Loader, Title } from "@mantine/core";
import type { JointMapView } from "@shared/api/captures";
import { ApiError } from "@shared/api/request";
import { BODY } from "@shared/bodyJoints";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useEffect, useMemo, useState } from "react";
import { nameOf } from "../account";
import { Failure } from "../errors";
import { type Key, useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { EmptyState } from "../ui/EmptyState";
import { GROUPS, type Group } from "./bodyJoints";
import classes from "./JointMap.module.css";
import { JointRow } from "./JointRow";
import { type MapProblem, problemsOf, redo, replace, sameMap, undo } from "./jointMapEdit";
import { MapPreview } from "./MapPreview";
import type { TabProps } from "./NoAvatar";
import { UnassignedJoints } from "./UnassignedJoints";
import type { JointMapDraft } from "./useJointMap";

export function JointMapTab({ capture, map }: TabProps): JSX.Element {
  const { t } = useTexts();
  const { view } = map;
  if (!capture.has_skeleton) {
    return (
      <EmptyState icon="body" title={t("map.none")}>
        {t("capture.noAvatar.skeleton", { why: capture.summary.no_skeleton ?? "" })}
      </EmptyState>
    );
  }
  if (view === undefined) {
    return map.loadError === null ? (
      <Center mih={240}>
        <Loader />
      </Center>
    ) : (
      <Failure error={map.loadError} />
    );
  }
  return <JointMapEditor capture={capture} map={map} view={view} />;
}

interface EditorProps extends TabProps {
  readonly view: JointMapView;
}

function JointMapEditor({ capture, map, view }: EditorProps): JSX.Element {
  const { t } = useTexts();
  const canWrite = usePermissions()("capture");
  const [editing, setEditing] = useState<string | null>(null);
  const { present } = map.edit;
  const problems = useMemo(
    () => problemsOf(present, BODY, { names: view.rig_joints, parents: view.rig_parents }),
    [present, view],
  );
  const words = useProblemWords();
  const refused = refusedJoints(map.error);
  return (
    <div className={classes.layout}>
      <MapPreview capture={capture} joints={present} editing={editing} problems={problems} />
      <div className={classes.main}>
        <p className={classes.lead}>
          {t("map.lead")} <State view={view} />
        </p>
        {canWrite && <MapBar map={map} view={view} problems={problems.size} />}
        <SaveStatus map={map} view={view} />
        <div className={classes.groups}>
          {(Object.keys(GROUPS) as Group[]).map((group) => (
            <section key={group} className={classes.group} data-group={group}>
              <Title order={2} size="h4" fz="0.9375rem">
                {t(`map.group.${group}`)}
              </Title>
              {GROUPS[group].map((joint) => (
                <JointRow
                  key={joint}
                  joint={joint}
                  view={view}
                  map={map}
                  disabled={!canWrite}
                  problem={words(problems.get(joint)) ?? refused.get(joint) ?? null}
                  isEditing={joint === editing}
                  onFocus={() => setEditing(joint)}
                />
              ))}
            </section>
          ))}
        </div>
        <UnassignedJoints present={present} view={view} />
      </div>
    </div>
  );
}

function State({ view }: { readonly view: JointMapView }): JSX.Element {
  const { t, language } = useTexts();
  const at = view.at === null ? "" : dateTime(view.at, language);
  return (
    <span className={classes.state}>
      {view.chosen
        ? t("map.state.saved", { by: nameOf(view.by ?? ""), at, version: view.version })
        : t("map.state.proposal")}
      {" · "}
      {t("map.captures", { count: view.captures })}
    </span>
  );
}

interface MapBarProps {
  readonly map: JointMapDraft;
  readonly view: JointMapView;
  readonly problems: number;
}

function MapBar({ map, view, problems }: MapBarProps): JSX.Element {
  const { t } = useTexts();
  useUndoKeys(map);
  return (
    <div className={classes.bar}>
      <Button
        size="xs"
        variant="default"
        disabled={map.edit.past.length === 0}
        onClick={() => map.change(undo)}
      >
        {t("map.undo")}
      </Button>
      <Button
        size="xs"
        variant="default"
        disabled={map.edit.future.length === 0}
        onClick={() => map.change(redo)}
      >
        {t("map.redo")}
      </Button>
      <Button
        size="xs"
        variant="default"
        leftSection={<Icon name="redo" size={15} />}
        disabled={sameMap(map.edit.present, view.proposal)}
        onClick={() => map.change((edit) => replace(edit, view.proposal))}
      >
        {t("map.proposal")}
      </Button>
      <span className={classes.unsaved} role="status">
        {problems > 0 ? t("map.problems", { count: problems }) : map.unsaved && t("map.unsaved")}
      </span>
      <Button
        size="xs"
        disabled={!map.unsaved || problems > 0}
        loading={map.saving}
        onClick={map.save}
      >
        {t("map.save")}
      </Button>
    </div>
  );
}

/** The result of saving, or what prevents it. */
function SaveStatus({ map, view }: Omit<MapBarProps, "problems">): JSX.Element | null {
  const { t } = useTexts();
  if (map.stale) {
    return (
      <Notice
        tone="warn"
        title={t("map.stale")}
        remedy={t("map.stale.body", { version: view.version, by: nameOf(view.by ?? "") })}
        actions={
          <span className={classes.choices}>
            <Button size="xs" variant="default" onClick={map.takeTheirs}>
              {t("map.stale.theirs")}
            </Button>
            <Button size="xs" variant="default" loading={map.saving} onClick={map.saveMine}>
              {t("map.stale.mine")}
            </Button>
          </span>
        }
      />
    );
  }
  if (map.error !== null) return <Failure error={map.error} />;
  if (!map.saved) return null;
  return <Notice tone="info" icon="check" title={t("map.saved")} remedy={t("map.saved.body")} />;
}

/** The problems that the server found, by joint. */
function refusedJoints(error: unknown): ReadonlyMap<string, string> {
  const details = error instanceof ApiError ? error.details : [];
  return new Map(details.map(({ path, message }) => [path ?? "", message]));
}

function useProblemWords(): (problem: MapProblem | undefined) => string | null {
  const { t } = useTexts();
  const name = (joint: string) => t(`joint.${joint}` as Key);
  return (problem) => {
    if (problem === undefined) return null;
    if (problem.kind === "hips") return t("map.problem.hips");
    if (problem.kind === "twice") return t("map.problem.twice", { other: name(problem.other) });
    const { above, aboveJoint } = problem;
    return t("map.problem.order", { above: name(above), aboveJoint });
  };
}

/** The usual keys: Ctrl Z undoes, Ctrl Shift Z or Ctrl Y redoes. */
function useUndoKeys(map: JointMapDraft): void {
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
      const key = event.key.toLowerCase();
      if (key === "z") map.change(event.shiftKey ? redo : undo);
      else if (key === "y") map.change(redo);
      else return;
      event.preventDefault();
    };
    window.addEventListener("keydown", onKey);
    return () => window.removeEventListener("keydown", onKey);
  });
}
