/** Which studies and sessions use a version. It stays as it is: saving makes a new version. */
import { Anchor } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import { type AvatarVersionDetail, usageQuery } from "./api";
import classes from "./Editor.module.css";

interface UsedByProps {
  readonly avatarKey: string;
  readonly version: number;
}

export function UsedBy({ avatarKey, version }: UsedByProps): JSX.Element {
  const { t } = useTexts();
  const { data } = useQuery(usageQuery(avatarKey, version));
  return (
    <section className={classes.panel} aria-label={t("avatars.used")}>
      <h3 className={classes.sub}>{t("avatars.used")}</h3>
      <p>
        {data === undefined
          ? "…"
          : t(data.sessions === 0 ? "avatars.used.none" : "avatars.used.sessions", {
              count: data.sessions,
              number: version,
            })}
      </p>
      {data !== undefined && data.used_by.length > 0 && (
        <ul className={classes.list}>
          {data.used_by.map((use) => (
            <li key={`${use.study} ${use.study_version}`}>
              <Icon name="form" size={16} />
              <span>
                <Anchor component={Link} href={`/studies/${use.study}`} size="sm">
                  {use.title}
                </Anchor>
                <span className={classes.soft}>
                  {t("avatars.version", { number: use.study_version })} ·{" "}
                  {t("avatars.used.count", { count: use.sessions })}
                  {use.running_sessions > 0 &&
                    ` · ${t("avatars.used.running", { count: use.running_sessions })}`}
                </span>
              </span>
              {use.sessions > 0 && <FrozenMark running={use.running_sessions} />}
            </li>
          ))}
        </ul>
      )}
      <p className={classes.soft}>{t("avatars.used.frozen")}</p>
      <pre className={classes.lines}>
        {`avatar: physics\navatar_configuration: {key: ${avatarKey}, version: ${version}}`}
      </pre>
    </section>
  );
}

/** Says that sessions have used what is saved here, and whether one of them runs now. */
function FrozenMark({ running }: { readonly running: number }): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={classes.frozen}>
      <Icon name="lock" size={14} />
      {running > 0 ? t("avatars.frozen.running", { count: running }) : t("avatars.frozen")}
    </span>
  );
}

interface FrozenProps {
  readonly version: AvatarVersionDetail;
}

/** The same for a version with all its studies; nothing while no session has used it. */
export function Frozen({ version }: FrozenProps): JSX.Element | null {
  // The version says who used it when it was loaded, so the mark is there from the start.
  const { data = version } = useQuery(usageQuery(version.key, version.number));
  if (data.sessions === 0) return null;
  const running = data.used_by.reduce((sum, use) => sum + use.running_sessions, 0);
  return <FrozenMark running={running} />;
}
