/** The other tunings of an avatar, for example a colleague's that is running. */
import { Button } from "@mantine/core";
import { dateTime } from "@shared/format";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { nameOf } from "../../account";
import { useTexts } from "../../i18n";
import classes from "../Editor.module.css";
import { type TuningListed, tuningsQuery } from "./tunings";

/** The most that are listed, newest first. */
const MOST = 5;

interface KnownTuningsProps {
  /** The one that is shown already. */
  readonly shown: string;
  readonly avatarKey: string;
  /** Content hashes of configurations that are the avatar's without naming it. */
  readonly contents: readonly string[];
  /** By id: those that were shown here, whatever became of the work that they tuned. */
  readonly remembered: Readonly<Record<string, unknown>>;
  readonly onShow: (id: string) => void;
}

export function KnownTunings(props: KnownTuningsProps): JSX.Element | null {
  const { shown, avatarKey, contents, remembered, onShow } = props;
  const { t } = useTexts();
  const listed = useQuery(tuningsQuery);
  const others = (listed.data ?? [])
    .filter(
      ({ id, avatar, content_hash }) =>
        id !== shown &&
        (id in remembered ||
          (avatar === null ? contents.includes(content_hash) : avatar.key === avatarKey)),
    )
    .slice(0, MOST);
  if (others.length === 0) return null;
  return (
    <section className={classes.panel} aria-label={t("avatars.tuning.known")}>
      <h3 className={classes.sub}>{t("avatars.tuning.known")}</h3>
      <ul className={classes.list}>
        {others.map((one) => (
          <Known key={one.id} tuning={one} onShow={onShow} />
        ))}
      </ul>
    </section>
  );
}

interface KnownProps {
  readonly tuning: TuningListed;
  readonly onShow: (id: string) => void;
}

function Known({ tuning, onShow }: KnownProps): JSX.Element {
  const { t, language } = useTexts();
  const { id, state, axes, avatar, by, at } = tuning;
  const number = avatar?.version;
  const words = [
    ...(axes === null ? [] : [t("avatars.tuning.known.axes", { count: axes })]),
    number == null
      ? t("avatars.tuning.known.unsaved")
      : t("avatars.tuning.known.version", { number }),
    nameOf(by),
    dateTime(at, language),
  ];
  return (
    <li>
      <strong>{t(`avatars.tuning.known.${state}`)}</strong>
      <span className={classes.soft}>{words.join(" · ")}</span>
      <Button size="compact-xs" variant="default" onClick={() => onShow(id)}>
        {t("avatars.tuning.known.show")}
      </Button>
    </li>
  );
}
