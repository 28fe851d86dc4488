/** The audit trail, newest first, in words; and whether the chain is intact. */
import { Button, Select } from "@mantine/core";
import { type AuditEntry, type AuditFilter, audit } from "@shared/api/people";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useInfiniteQuery, useMutation, useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { auditQuery, peopleQuery } from "../../queries";
import { EmptyState } from "../../ui/EmptyState";
import { Loaded } from "../../ui/Loaded";
import { ScrollBox } from "../../ui/tables";
import { actorName, KINDS, sentences } from "./auditWords";
import classes from "./People.module.css";

export function AuditTab(): JSX.Element {
  const { t } = useTexts();
  const [filter, setFilter] = useState<AuditFilter>({ actor: null, action: null });
  const query = useInfiniteQuery(auditQuery(filter));
  const check = useMutation({ mutationFn: audit.check });
  return (
    <>
      <p className={classes.lead}>{t("audit.lead")}</p>
      <div className={classes.filters}>
        <Filters filter={filter} onChange={setFilter} />
        <Button
          className={classes.spacer ?? ""}
          variant="default"
          leftSection={<Icon name="link" size={17} />}
          loading={check.isPending}
          onClick={() => check.mutate()}
        >
          {t("audit.check")}
        </Button>
      </div>
      {check.isError && <Failure error={check.error} />}
      {check.data !== undefined && (
        <div style={{ marginBottom: 16 }}>
          {check.data.ok ? (
            <Notice
              tone="info"
              icon="check"
              title={t("audit.check.ok", { count: check.data.entries })}
            >
              {t("audit.check.head")}{" "}
              <code style={{ overflowWrap: "anywhere" }}>{check.data.head}</code>
            </Notice>
          ) : (
            <Notice
              tone="bad"
              title={t("audit.check.broken", { number: check.data.broken_at ?? 0 })}
            >
              {t("audit.check.brokenBody")}
            </Notice>
          )}
        </div>
      )}
      <Loaded query={query}>
        {({ pages }) => (
          <Entries
            entries={pages.flatMap(({ entries }) => entries)}
            more={query.hasNextPage}
            loading={query.isFetchingNextPage}
            onMore={() => void query.fetchNextPage()}
          />
        )}
      </Loaded>
    </>
  );
}

interface FiltersProps {
  readonly filter: AuditFilter;
  readonly onChange: (filter: AuditFilter) => void;
}

function Filters({ filter, onChange }: FiltersProps): JSX.Element {
  const { t } = useTexts();
  const people = useQuery(peopleQuery).data ?? [];
  return (
    <>
      <Select
        label={t("audit.person")}
        placeholder={t("audit.person.all")}
        clearable
        value={filter.actor}
        onChange={(actor) => onChange({ ...filter, actor })}
        data={[
          ...people.map(({ username }) => ({ value: `account:${username}`, label: username })),
          { value: "nobody", label: t("audit.person.nobody") },
        ]}
      />
      <Select
        label={t("audit.kind")}
        placeholder={t("audit.kind.all")}
        clearable
        value={filter.action}
        onChange={(action) => onChange({ ...filter, action })}
        data={KINDS.map((kind) => ({ value: `${kind}.`, label: t(`audit.kind.${kind}`) }))}
      />
    </>
  );
}

interface EntriesProps {
  readonly entries: readonly AuditEntry[];
  readonly more: boolean;
  readonly loading: boolean;
  readonly onMore: () => void;
}

function Entries({ entries, more, loading, onMore }: EntriesProps): JSX.Element {
  const { t } = useTexts();
  if (entries.length === 0) {
    return (
      <EmptyState icon="list" title={t("audit.empty.title")}>
        {t("audit.empty.body")}
      </EmptyState>
    );
  }
  return (
    <>
      <ScrollBox label={t("audit.kind")} className={classes.frame}>
        <table className={classes.trail}>
          <thead>
            <tr>
              {(["number", "when", "who", "what"] as const).map((column) => (
                <th key={column} scope="col">
                  {t(`audit.${column}`)}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {entries.map((entry) => (
              <Row key={entry.seq} entry={entry} />
            ))}
          </tbody>
        </table>
      </ScrollBox>
      <div className={classes.more}>
        {more ? (
          <Button variant="default" loading={loading} onClick={onMore}>
            {t("audit.more")}
          </Button>
        ) : (
          t("audit.end")
        )}
      </div>
    </>
  );
}

function who(actor: string, t: ReturnType<typeof useTexts>["t"]): string {
  if (actor === "nobody") return "–";
  const script = /^script:(.*)$/.exec(actor)?.[1];
  return script === undefined ? actorName(actor) : t("actor.script", { name: script });
}

function Row({ entry }: { readonly entry: AuditEntry }): JSX.Element {
  const { t, language } = useTexts();
  return (
    <tr>
      <td className="numbers" title={`sha256 ${entry.hash}`}>
        {entry.seq}
      </td>
      <td className={`${classes.nowrap} numbers`}>{dateTime(entry.at, language)}</td>
      <td className={classes.name}>{who(entry.actor, t)}</td>
      <td>
        {sentences(entry, t).map((sentence) => (
          <div key={sentence}>{sentence}</div>
        ))}
      </td>
    </tr>
  );
}
