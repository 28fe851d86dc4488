/** One figure with its caption, and the buttons that save it and its data. */
import { Figure } from "@charts/Figure";
import { savePicture } from "@charts/print";
import { Button, Title } from "@mantine/core";
import { analysis, type FigureEntry, type Filter } from "@shared/api/analysis";
import { Icon } from "@shared/ui/Icon";
import { type JSX, useId, useState } from "react";
import { Link } from "wouter";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import classes from "./DashboardTab.module.css";
import { MEASURE } from "./StatisticsTab";
import { useDownload } from "./useDownload";

interface FigureCardProps {
  readonly studyKey: string;
  readonly entry: FigureEntry;
  readonly filter: Filter;
  /** As high as the window allows for two rows, with the caption in one line until it is read. */
  readonly isCompact?: boolean;
  /** Drawn when it comes near the window; not where it may be printed at any time. */
  readonly isLazy?: boolean;
}

export function FigureCard({
  studyKey,
  entry,
  filter,
  isCompact = false,
  isLazy = true,
}: FigureCardProps): JSX.Element {
  const { t } = useTexts();
  const watermark = filter.kind === "simulated" ? t("simulated.watermark") : null;
  const { title, caption, figure } = entry;
  const [isRead, setIsRead] = useState(false);
  const captionId = useId();
  const look = [
    classes.figure,
    ...(entry.wide ? [classes.wide] : []),
    ...(isCompact ? [classes.compact] : []),
  ].join(" ");
  return (
    <figure className={look}>
      <Title order={3} title={isCompact ? title : undefined}>
        {title}
      </Title>
      {figure === null ? (
        <p className={classes.missing}>{entry.empty}</p>
      ) : (
        <div className={isCompact ? classes.plot : undefined}>
          <Figure
            figure={figure}
            label={title}
            watermark={watermark}
            loading={t("dashboard.loading")}
            failed={t("dashboard.failed")}
            fills={isCompact}
            lazy={isLazy}
          />
        </div>
      )}
      <figcaption
        id={captionId}
        className={classes.caption}
        data-collapsed={(isCompact && !isRead) || undefined}
      >
        {caption}
      </figcaption>
      {figure !== null && (
        <div className={classes.foot}>
          <SaveRow
            label={t("figures.save", { title })}
            name={`${studyKey}_${entry.key}_${filter.kind}`}
            rowsUrl={analysis.rowsUrl(studyKey, entry.key, filter)}
            onPicture={(format, name) =>
              savePicture(figure, { title, caption, watermark }, entry.wide, format, name)
            }
          />
          {isCompact && (
            <Button
              size="compact-xs"
              variant="subtle"
              ml="auto"
              aria-expanded={isRead}
              aria-controls={captionId}
              aria-label={t("figures.caption.of", { title })}
              onClick={() => setIsRead(!isRead)}
            >
              {t("figures.caption")}
            </Button>
          )}
          {entry.measure !== null && (
            <Button
              component={Link}
              href={testsOf(entry.measure, studyKey, filter)}
              size="compact-xs"
              variant="subtle"
              aria-label={t("figures.tests.of", { title })}
            >
              {t("figures.tests")}
            </Button>
          )}
        </div>
      )}
    </figure>
  );
}

/** The address of the tests of a measure, with the numbers behind its figure. */
function testsOf(measure: string, studyKey: string, { kind }: Filter): string {
  return `/studies/${studyKey}/statistics?${new URLSearchParams({ kind, [MEASURE]: measure })}`;
}

interface SaveRowProps {
  readonly label: string;
  readonly name: string;
  readonly rowsUrl: string;
  readonly onPicture: (format: "png" | "svg", name: string) => Promise<void>;
}

function SaveRow({ label, name, rowsUrl, onPicture }: SaveRowProps): JSX.Element {
  const { t } = useTexts();
  const rows = useDownload();
  return (
    // A group of buttons with a common label: each alone names only its format.
    <fieldset className={classes.save} aria-label={label}>
      <Icon name="download" size={16} />
      {(["png", "svg"] as const).map((format) => (
        <Button
          key={format}
          size="compact-xs"
          variant="subtle"
          onClick={() => void onPicture(format, name)}
        >
          {t(`figures.${format}`)}
        </Button>
      ))}
      <Button
        size="compact-xs"
        variant="subtle"
        loading={rows.state.phase === "running"}
        onClick={() => void rows.start(rowsUrl, `${name}.csv`)}
      >
        {t("figures.csv")}
      </Button>
      {rows.state.phase === "failed" && <Failure error={rows.state.error} />}
    </fieldset>
  );
}
