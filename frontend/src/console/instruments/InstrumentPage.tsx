/** One instrument in full: its items in every language, its formulas, a form to try, its files. */
import { Button, Tabs, Title } from "@mantine/core";
import type { InstrumentDetail } from "@shared/api/types";
import { dateTime } from "@shared/format";
import { inLanguage } from "@shared/text";
import { Icon, type IconName } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link, useLocation } from "wouter";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { instrumentQuery } from "../queries";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import classes from "./Instruments.module.css";
import { UsedBy } from "./InstrumentsPage";
import { Items } from "./Items";
import { Scoring } from "./Scoring";
import { TryIt } from "./TryIt";

const TABS = ["items", "scoring", "try", "file"] as const;
type Tab = (typeof TABS)[number];
const ICONS: Readonly<Record<Tab, IconName>> = {
  items: "list",
  scoring: "chart",
  try: "form",
  file: "document",
};

interface InstrumentPageProps {
  readonly name: string;
  readonly tab: string | undefined;
}

export function InstrumentPage({ name, tab }: InstrumentPageProps): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <Link href="/instruments" className={classes.crumbs ?? ""}>
        <Icon name="back" size={16} />
        {t("instruments.title")}
      </Link>
      <Loaded query={useQuery(instrumentQuery(name))}>
        {(instrument) => (
          <Instrument instrument={instrument} tab={TABS.find((name) => name === tab) ?? "items"} />
        )}
      </Loaded>
    </>
  );
}

interface InstrumentProps {
  readonly instrument: InstrumentDetail;
  readonly tab: Tab;
}

function Instrument({ instrument, tab }: InstrumentProps): JSX.Element {
  const { t, language } = useTexts();
  const [, navigate] = useLocation();
  const can = usePermissions();
  const title = inLanguage(instrument.title, language);
  useTitle(title);
  return (
    <>
      <div className={classes.head}>
        <div>
          <Title order={1}>{title}</Title>
          <div className={`${classes.facts} numbers`}>
            <code>{instrument.key}</code>
            <span>{t("instrument.version", { version: instrument.version })}</span>
            <span>{t("instruments.items", { count: instrument.items })}</span>
            <UsedBy instrument={instrument} />
          </div>
        </div>
        {can("design") && (
          <Button
            component={Link}
            href={`/instruments/${instrument.key}/edit`}
            leftSection={<Icon name="document" size={17} />}
          >
            {t("instrument.edit")}
          </Button>
        )}
      </div>
      <Tabs
        value={tab}
        onChange={(value) => navigate(`/instruments/${instrument.key}/${value ?? "items"}`)}
        keepMounted={false}
      >
        <Tabs.List>
          {TABS.map((name) => (
            <Tabs.Tab key={name} value={name} leftSection={<Icon name={ICONS[name]} size={17} />}>
              {t(`instrument.tab.${name}`)}
            </Tabs.Tab>
          ))}
        </Tabs.List>
        <Tabs.Panel value={tab} className={classes.panel ?? ""}>
          {tab === "items" && (
            <>
              <Provenance instrument={instrument} />
              <Items preview={instrument.preview} />
            </>
          )}
          {tab === "scoring" && <Scoring preview={instrument.preview} />}
          {tab === "try" && <TryIt preview={instrument.preview} yaml={instrument.yaml} />}
          {tab === "file" && <Files instrument={instrument} />}
        </Tabs.Panel>
      </Tabs>
    </>
  );
}

function Provenance({ instrument }: { readonly instrument: InstrumentDetail }): JSX.Element {
  const { t } = useTexts();
  const { source, licence, verified, notes } = instrument.provenance;
  return (
    <dl className={classes.provenance}>
      <dt>{t("instrument.source")}</dt>
      <dd>{source}</dd>
      <dt>{t("instruments.licence")}</dt>
      <dd>{licence}</dd>
      <dt>{t("instrument.verified")}</dt>
      <dd>{verified}</dd>
      {notes.length > 0 && (
        <>
          <dt>{t("instrument.notes")}</dt>
          <dd>
            {notes.map((note) => (
              <div key={note}>{note}</div>
            ))}
          </dd>
        </>
      )}
    </dl>
  );
}

function Files({ instrument }: { readonly instrument: InstrumentDetail }): JSX.Element {
  const { t, language } = useTexts();
  return (
    <>
      <ul className={classes.versions}>
        {[...instrument.versions].reverse().map((version, index) => (
          <li key={version.content_hash}>
            <strong>{t("instrument.version", { version: version.version })}</strong>
            {index === 0 && ` (${t("instrument.newest")})`},{" "}
            {t("instrument.stored", { time: dateTime(version.created_at, language) })},{" "}
            {t("instruments.usedBy")}{" "}
            {version.used_by.length === 0
              ? t("instruments.usedByNone")
              : version.used_by.join(", ")}
            <div className={classes.hash}>sha256 {version.content_hash}</div>
          </li>
        ))}
      </ul>
      <Yaml text={instrument.yaml} />
    </>
  );
}

function Yaml({ text }: { readonly text: string }): JSX.Element {
  const { t } = useTexts();
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: a scrollable region has to be focusable
    // biome-ignore lint/a11y/useSemanticElements: a section may not be preformatted
    <pre className={classes.yaml} tabIndex={0} role="region" aria-label={t("instrument.tab.file")}>
      {text}
    </pre>
  );
}
