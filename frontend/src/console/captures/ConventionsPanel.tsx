/** The conventions by which the file was read, their source, and a form to change them. */
import { Title } from "@mantine/core";
import type { Capture, Conventions, Origin } from "@shared/api/captures";
import { number } from "@shared/format";
import { boxOf, type PointMotion } from "@shared/stage/motion";
import { Icon, type IconName } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { type JSX, type ReactNode, useMemo } from "react";
import { type Key, useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { AnatomyNotices } from "./AnatomyNotices";
import classes from "./Capture.module.css";
import { ReadingForm } from "./ReadingForm";

interface ConventionsPanelProps {
  readonly capture: Capture;
  /** The movement, whose size is shown; null while something else is shown. */
  readonly motion: PointMotion | null;
}

const CONVENTIONS: readonly (keyof Conventions)[] = ["length", "axes", "rotations", "rate"];

export function ConventionsPanel({ capture, motion }: ConventionsPanelProps): JSX.Element {
  const { t, language } = useTexts();
  const canWrite = usePermissions()("capture");
  const { conventions, notes, observed } = capture.summary;
  const notices = capture.summary.skeleton?.notices ?? [];
  // A notice about the unit says more than that something was guessed.
  const isUnitTold = notices.some(({ rule }) => rule === "unit");
  const isGuessed = CONVENTIONS.some(
    (name) => conventions[name].origin === "guessed" && !(name === "length" && isUnitTold),
  );
  const size = useMemo(() => (motion === null ? null : boxOf(motion)), [motion]);
  // Significant digits rather than decimals: a wrong unit changes the size by a factor of a
  // thousand.
  const digits = new Intl.NumberFormat(language, { maximumSignificantDigits: 3 });
  const side = (axis: 0 | 1 | 2) =>
    size === null ? "" : digits.format(size.max[axis] - size.min[axis]);
  return (
    <aside className={classes.facts} aria-label={t("conventions.title")}>
      <Title order={2} size="h3">
        {t("conventions.title")}
      </Title>
      <dl className={classes.convention}>
        {CONVENTIONS.map((name) => (
          <Fact key={name} name={t(`conventions.${name}`)}>
            {conventions[name].value} <OriginMark origin={conventions[name].origin} />
          </Fact>
        ))}
        <Fact name={t("conventions.size")}>
          <span className="numbers" title={t("conventions.size.hint")}>
            {size === null
              ? "…"
              : t("conventions.size.value", { width: side(0), depth: side(2), height: side(1) })}
          </span>
        </Fact>
        {observed < 1 && (
          <Fact name={t("conventions.observed")}>
            {t("conventions.observed.value", { percent: number(100 * observed, language, 1) })}
          </Fact>
        )}
        <SkeletonFact capture={capture} />
      </dl>
      {isGuessed && (
        <Notice
          tone="warn"
          title={t("conventions.guessed")}
          remedy={t("conventions.guessed.body")}
        />
      )}
      <AnatomyNotices notices={notices} />
      {canWrite && <ReadingForm capture={capture} />}
      {notes.length > 0 && (
        <div>
          <Title order={3} size="h4" fz="0.9375rem">
            {t("conventions.notes")}
          </Title>
          <ul className={classes.notes}>
            {notes.map((note) => (
              <li key={note}>{note}</li>
            ))}
          </ul>
        </div>
      )}
    </aside>
  );
}

function Fact({
  name,
  children,
}: {
  readonly name: string;
  readonly children: ReactNode;
}): JSX.Element {
  return (
    <div>
      <dt>{name}</dt>
      <dd>{children}</dd>
    </div>
  );
}

const ORIGIN_ICONS: Readonly<Record<Origin, IconName>> = {
  file: "document",
  format: "form",
  guessed: "help",
  chosen: "check",
};

function OriginMark({ origin }: { readonly origin: Origin }): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={classes.origin} data-origin={origin}>
      <Icon name={ORIGIN_ICONS[origin]} size={13} />
      {t(`conventions.origin.${origin}`)}
    </span>
  );
}

function SkeletonFact({ capture }: { readonly capture: Capture }): JSX.Element {
  const { t, language } = useTexts();
  const { skeleton } = capture.summary;
  if (skeleton === null) {
    return <Fact name={t("conventions.skeleton")}>{t("captures.skeleton.no")}</Fact>;
  }
  const count = skeleton.joints.length;
  return (
    <Fact name={t("conventions.skeleton")}>
      {skeleton.origin === "file"
        ? t("conventions.skeleton.file", { count })
        : t("conventions.skeleton.fitted", {
            count,
            millimetres: number(1000 * (skeleton.residual_m ?? 0), language, 1),
          })}
      {skeleton.unfitted.length > 0 && (
        <span className={classes.soft}>
          {t("conventions.skeleton.unfitted", {
            names: skeleton.unfitted.map((joint) => t(`joint.${joint}` as Key)).join(", "),
          })}
        </span>
      )}
    </Fact>
  );
}
