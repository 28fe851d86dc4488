/** The library: every instrument with its source, its licence and the studies that use it. */
import { Button, Title } from "@mantine/core";
import type { InstrumentSummary } from "@shared/api/drafts";
import { number } from "@shared/format";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { instrumentsQuery } from "../queries";
import { EmptyState } from "../ui/EmptyState";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import classes from "./Instruments.module.css";

export function InstrumentsPage(): JSX.Element {
  const { t } = useTexts();
  const can = usePermissions();
  useTitle(t("instruments.title"));
  return (
    <>
      <div className={classes.head}>
        <div>
          <Title order={1}>{t("instruments.title")}</Title>
          <p className={classes.lead}>{t("instruments.lead")}</p>
        </div>
        {can("design") && (
          <Button
            component={Link}
            href="/instruments/new"
            leftSection={<Icon name="add" size={18} />}
          >
            {t("instruments.new")}
          </Button>
        )}
      </div>
      <Loaded query={useQuery(instrumentsQuery)}>
        {(all) =>
          all.length === 0 ? (
            <EmptyState icon="form" title={t("instruments.empty")}>
              {t("instruments.empty.body")}
            </EmptyState>
          ) : (
            <ul className={classes.rows}>
              {all.map((instrument) => (
                <Row key={instrument.key} instrument={instrument} />
              ))}
            </ul>
          )
        }
      </Loaded>
    </>
  );
}

function Row({ instrument }: { readonly instrument: InstrumentSummary }): JSX.Element {
  const { t, language } = useTexts();
  const { key, title, items, minutes, scores, provenance } = instrument;
  return (
    <li className={classes.row}>
      <div className={classes.what}>
        <Link href={`/instruments/${key}`} className={classes.name ?? ""}>
          {inLanguage(title, language)}
        </Link>
        <div className={`${classes.facts} numbers`}>
          <code>{key}</code>
          <span>{t("instruments.items", { count: items })}</span>
          <span>{t("instruments.minutes", { minutes: number(minutes, language, 1) })}</span>
          <span>{instrument.languages.join(", ")}</span>
        </div>
      </div>
      <div className={classes.source}>
        {provenance.source}
        <div className={classes.small}>
          {t("instruments.licence")}: {provenance.licence}
        </div>
      </div>
      <div className={classes.use}>
        <span className={classes.small}>{t("instruments.scores")}</span>
        <div>
          {scores.length === 0
            ? t("instruments.noScores")
            : scores.map(({ label }) => inLanguage(label, language)).join(", ")}
        </div>
        <UsedBy instrument={instrument} />
      </div>
    </li>
  );
}

export function UsedBy({ instrument }: { readonly instrument: InstrumentSummary }): JSX.Element {
  const { t } = useTexts();
  const { used_by, used_by_older } = instrument;
  return (
    <div className={classes.small}>
      {t("instruments.usedBy")}{" "}
      {used_by.length === 0 && used_by_older.length === 0
        ? t("instruments.usedByNone")
        : used_by.join(", ")}
      {used_by_older.length > 0 && (
        <>
          {used_by.length > 0 ? "; " : ""}
          {t("instruments.usedByOlder")} {used_by_older.join(", ")}
        </>
      )}
    </div>
  );
}
