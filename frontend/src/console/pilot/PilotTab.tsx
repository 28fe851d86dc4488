/**
 * Pilots of a study: order them, watch, stop and resume them, and read what they found. All of it
 * is simulated and says so; the pilot that is shown is in the address.
 */
import { Button, Table } from "@mantine/core";
import { isApiError } from "@shared/api/request";
import type { StudyDetail } from "@shared/api/types";
import { dateTime } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import { useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useEffect, useRef } from "react";
import { useLocation, useSearch } from "wouter";
import { nameOf } from "../account";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { EmptyState } from "../ui/EmptyState";
import { Loaded } from "../ui/Loaded";
import { ListTable } from "../ui/tables";
import classes from "./Pilot.module.css";
import { PilotCourse } from "./PilotCourse";
import { PilotOrder } from "./PilotOrder";
import { PilotReport } from "./PilotReport";
import {
  type Pilot,
  type PilotListed,
  pilotDefaultsQuery,
  pilotQuery,
  pilotsQuery,
} from "./pilots";
import { stateOf, whatOf } from "./words";

/** What names the pilot that is shown in the address. */
const SHOWN = "pilot";

export function PilotTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const can = usePermissions();
  const queries = useQueryClient();
  const [, go] = useLocation();
  const asked = new URLSearchParams(useSearch()).get(SHOWN);
  const listed = useQuery(pilotsQuery(study.key));
  const defaults = useQuery(pilotDefaultsQuery(study.key));
  const id = asked ?? listed.data?.[0]?.id ?? "";
  const query = useQuery({
    ...pilotQuery(study.key, id),
    enabled: id !== "",
    retry: false,
  });
  const show = (next: string) =>
    go(`/studies/${encodeURIComponent(study.key)}/pilot${next === "" ? "" : `?${SHOWN}=${next}`}`);
  const { queryKey } = pilotsQuery(study.key);
  // Only the list: its key is the beginning of the key of each, one of which may be gone.
  const refresh = () => queries.invalidateQueries({ queryKey, exact: true });
  const forget = (gone: string) => {
    queries.setQueryData(queryKey, (known) => known?.filter((one) => one.id !== gone));
    show("");
    return refresh();
  };
  const put = (pilot: Pilot) => {
    queries.setQueryData(pilotQuery(study.key, pilot.id).queryKey, pilot);
    show(pilot.id);
    return refresh();
  };
  const section = useRef<HTMLElement>(null);
  const begun = useRef("");
  // The pilot that was just started stands below the list, and often below the window.
  useEffect(() => {
    if (section.current === null || begun.current !== id || id === "") return;
    begun.current = "";
    section.current.scrollIntoView({ block: "start" });
  });
  const isGone = isApiError(query.error, "not_found");
  const canOrder = can("design") && study.archived_at === null;
  // What comes below the form waits for it: nothing moves when it arrives.
  const isLaidOut = !canOrder || !defaults.isPending;
  return (
    <div className={classes.page}>
      <p className={classes.lead}>{t("pilot.lead")}</p>
      <Notice tone="sim" title={t("simulated.watermark")}>
        {t("pilot.simulated")}
      </Notice>
      {canOrder && (
        <Loaded query={defaults} isShort>
          {(given) => (
            <PilotOrder
              studyKey={study.key}
              defaults={given}
              onStarted={(pilot) => {
                begun.current = pilot.id;
                return put(pilot);
              }}
              onShow={(same) => {
                begun.current = same;
                show(same);
              }}
            />
          )}
        </Loaded>
      )}
      {isLaidOut && (
        <Loaded query={listed} isShort>
          {(known) =>
            known.length === 0 ? (
              <EmptyState icon="body" title={t("pilot.none")}>
                {t("pilot.none.body")}
              </EmptyState>
            ) : (
              <Known known={known} shown={id} onShow={show} />
            )
          }
        </Loaded>
      )}
      {isLaidOut && id !== "" && !isGone && (
        <Loaded query={query}>
          {(pilot) => (
            <section ref={section} className={classes.shown} aria-label={t("pilot.course")}>
              <PilotCourse
                key={pilot.id}
                studyKey={study.key}
                pilot={pilot}
                onChanged={put}
                onDeleted={() => forget(pilot.id)}
              />
              <PilotReport pilot={pilot} />
            </section>
          )}
        </Loaded>
      )}
    </div>
  );
}

interface KnownProps {
  readonly known: readonly PilotListed[];
  readonly shown: string;
  readonly onShow: (id: string) => void;
}

function Known({ known, shown, onShow }: KnownProps): JSX.Element {
  const { t, language } = useTexts();
  return (
    <section aria-label={t("pilot.list")}>
      <ListTable
        columns={[
          t("pilot.col.what"),
          t("pilot.col.version"),
          t("pilot.col.by"),
          t("pilot.col.state"),
        ]}
        hasActions
      >
        {known.map((one) => (
          <Table.Tr key={one.id} aria-current={one.id === shown || undefined}>
            <Table.Td>
              <strong className={classes.mark}>{t("simulated.watermark")}</strong> {whatOf(t, one)}
            </Table.Td>
            <Table.Td className="numbers">{one.version}</Table.Td>
            <Table.Td>
              {t("pilot.by", { who: nameOf(one.by), when: dateTime(one.at, language) })}
            </Table.Td>
            <Table.Td>{stateOf(t, one)}</Table.Td>
            <Table.Td>
              <Button
                size="compact-xs"
                variant={one.id === shown ? "light" : "default"}
                aria-pressed={one.id === shown}
                onClick={() => onShow(one.id)}
              >
                {t(one.id === shown ? "pilot.shown" : "pilot.show")}
              </Button>
            </Table.Td>
          </Table.Tr>
        ))}
      </ListTable>
    </section>
  );
}
