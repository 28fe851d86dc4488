/** All versions of an avatar: their notes, how they differ from the work, loading, and files. */
import { Button, FileButton, Select } from "@mantine/core";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useRef, useState } from "react";
import { Link } from "wouter";
import { nameOf } from "../account";
import { useTexts } from "../i18n";
import { Loaded } from "../ui/Loaded";
import {
  type AvatarVersion,
  type AvatarVersionDetail,
  type AvatarView,
  avatars,
  type Operation,
  versionQuery,
} from "./api";
import type { AvatarFile } from "./axes";
import { Differences } from "./Differences";
import classes from "./Editor.module.css";
import { loadVersion } from "./operations";
import { originOf } from "./origin";
import { TakeFrom } from "./TakeFrom";
import { savedAvatarsQuery } from "./tryout/source";
import { UsedBy } from "./UsedBy";

interface VersionsPanelProps {
  readonly avatar: AvatarView;
  readonly basedOn: number;
  /** The version that the address leads to: it is shown first, with how it differs. */
  readonly linked: number | null;
  /** Name a version in a study; undefined for people who write no studies. */
  readonly onUse: ((version: number) => void) | undefined;
  readonly configuration: AvatarFile;
  readonly edit: (operations: readonly Operation[], label: string) => Promise<boolean>;
  readonly onFile: (file: File) => void;
  readonly isReadOnly: boolean;
}

export function VersionsPanel(props: VersionsPanelProps): JSX.Element {
  const { avatar, basedOn, linked, onUse, configuration, edit, onFile, isReadOnly } = props;
  const { t, language } = useTexts();
  const all = useQuery(savedAvatarsQuery);
  const [compared, setCompared] = useState<number | null>(linked === basedOn ? null : linked);
  // A file that was corrected outside can be chosen again.
  const forget = useRef<() => void>(null);
  return (
    <div className={classes.stack}>
      <UsedBy avatarKey={avatar.key} version={linked ?? basedOn} />
      <section className={classes.panel} aria-label={t("avatars.versions")}>
        <h3 className={classes.sub}>{t("avatars.versions")}</h3>
        <ul className={classes.list}>
          {avatar.versions.map((version) => (
            <li
              key={version.number}
              aria-current={version.number === linked || undefined}
              ref={(line) => {
                if (version.number === linked) line?.scrollIntoView({ block: "nearest" });
              }}
            >
              <span className={classes.versionNumber}>{version.number}</span>
              <span>
                <strong>
                  {version.note === "" ? t("avatars.noNote") : firstSentence(version)}
                </strong>
                <span className={classes.soft}>
                  {originOf(version, avatar.key, all.data ?? [], t)} · {nameOf(version.by)} ·{" "}
                  {dateTime(version.at, language)} ·{" "}
                  <code title={version.content_hash}>{version.content_hash.slice(0, 12)}</code>
                  {version.number === basedOn &&
                    ` · ${t(isReadOnly ? "avatars.shown" : "avatars.basedOn")}`}
                </span>
              </span>
              <span className={classes.buttons}>
                {onUse !== undefined && (
                  <Button
                    size="compact-xs"
                    variant="default"
                    aria-label={t("avatars.use.version", { number: version.number })}
                    onClick={() => onUse(version.number)}
                  >
                    {t("avatars.use")}
                  </Button>
                )}
                <Button
                  size="compact-xs"
                  variant="default"
                  aria-expanded={compared === version.number}
                  onClick={() => setCompared(compared === version.number ? null : version.number)}
                >
                  {t("avatars.compare")}
                </Button>
                {isReadOnly ? (
                  <Button
                    component={Link}
                    size="compact-xs"
                    variant="default"
                    aria-label={t("avatars.open.version", { number: version.number })}
                    href={`/avatars/${avatar.key}/${version.number}`}
                  >
                    {t("avatars.open")}
                  </Button>
                ) : (
                  <Button
                    size="compact-xs"
                    variant="default"
                    onClick={() =>
                      void edit(
                        loadVersion(avatar.key, version.number),
                        t("avatars.did.load", { number: version.number }),
                      )
                    }
                  >
                    {t("avatars.load")}
                  </Button>
                )}
                <Button
                  component="a"
                  size="compact-xs"
                  variant="default"
                  href={avatars.fileUrl(avatar.key, version.number)}
                  download
                >
                  {t("avatars.file")}
                </Button>
              </span>
              {version.note !== "" && firstSentence(version) !== version.note && (
                <details className={`${classes.more} ${classes.wholeNote}`}>
                  <summary>
                    {t("avatars.note.whole")}
                    <span className="visually-hidden">
                      {" "}
                      {t("avatars.version", { number: version.number })}
                    </span>
                  </summary>
                  <p>{version.note}</p>
                </details>
              )}
              {compared === version.number && (
                <div className={classes.compared}>
                  <Compared
                    avatar={avatar}
                    number={compared}
                    configuration={configuration}
                    work={
                      isReadOnly ? t("avatars.version", { number: basedOn }) : t("avatars.yourWork")
                    }
                  />
                </div>
              )}
            </li>
          ))}
        </ul>
        {!isReadOnly && (
          <FileButton
            accept="application/json,.json"
            resetRef={forget}
            onChange={(file) => {
              if (file !== null) onFile(file);
              forget.current?.();
            }}
          >
            {(button) => (
              <Button
                {...button}
                size="xs"
                variant="default"
                className={classes.start ?? ""}
                leftSection={<Icon name="upload" size={15} />}
              >
                {t("avatars.import")}
              </Button>
            )}
          </FileButton>
        )}
      </section>
      <TakeFrom
        avatarKey={avatar.key}
        configuration={configuration}
        work={isReadOnly ? t("avatars.version", { number: basedOn }) : t("avatars.yourWork")}
        edit={edit}
        isReadOnly={isReadOnly}
      />
    </div>
  );
}

const firstSentence = ({ note }: AvatarVersion): string => note.split(/(?<=\.)\s/, 1)[0] ?? note;

interface ComparedProps {
  readonly avatar: AvatarView;
  readonly number: number;
  readonly configuration: AvatarFile;
  /** What it is compared with. */
  readonly work: string;
}

function Compared({ avatar, number, configuration, work }: ComparedProps): JSX.Element {
  const { t } = useTexts();
  const [other, setOther] = useState<number | null>(null);
  const version = useQuery(versionQuery(avatar.key, number));
  const second = useQuery({
    ...versionQuery(avatar.key, other ?? number),
    enabled: other !== null,
  });
  const others = avatar.versions.filter((one) => one.number !== number);
  const nameOfVersion = (one: number) => t("avatars.version", { number: one });
  // What came first stands first, so that the difference is what has changed since.
  const isSwapped = other !== null && other < number;
  const differencesOf = (one: AvatarVersionDetail, after: AvatarFile) => (
    <Differences
      label={t("avatars.compare")}
      before={isSwapped ? after : one.configuration}
      after={isSwapped ? one.configuration : after}
      columns={
        other === null
          ? [nameOfVersion(number), work]
          : [nameOfVersion(Math.min(number, other)), nameOfVersion(Math.max(number, other))]
      }
    />
  );
  return (
    <div className={classes.stack}>
      {others.length > 0 && (
        <Select
          size="xs"
          w={260}
          label={t("avatars.compare.with", { number })}
          allowDeselect={false}
          value={other === null ? WORK : String(other)}
          onChange={(value) => setOther(value === WORK || value === null ? null : Number(value))}
          data={[
            { value: WORK, label: work },
            ...others.map((one) => ({
              value: String(one.number),
              label: nameOfVersion(one.number),
            })),
          ]}
        />
      )}
      <Loaded query={version}>
        {(one) =>
          other === null ? (
            differencesOf(one, configuration)
          ) : (
            <Loaded query={second}>{(two) => differencesOf(one, two.configuration)}</Loaded>
          )
        }
      </Loaded>
    </div>
  );
}

/** The choice of what is being edited, or shown. */
const WORK = "work";
