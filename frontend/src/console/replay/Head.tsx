/** The replay's header: participant, phase, and the phase to compare it with. */
import { Select } from "@mantine/core";
import type { SessionView } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import { sessionsQuery } from "../queries";
import { isOver, usePhaseName } from "../steps";
import { KindBadge } from "../ui/badges";
import type { ReplayParams, ReplayParamsWithPhase } from "./address";
import classes from "./Replay.module.css";

/** The link from the replay to its session. */
export function BackLink({ id }: { readonly id: string }): JSX.Element {
  const { t } = useTexts();
  return (
    <Link href={`/sessions/${id}`} className={classes.back ?? ""}>
      <Icon name="back" size={16} />
      {t("replay.back")}
    </Link>
  );
}

interface HeadProps {
  readonly session: SessionView;
  /** The session whose phases can be compared: this one, or another that was selected. */
  readonly comparedSession: SessionView;
  readonly params: ReplayParamsWithPhase;
  readonly onParams: (params: ReplayParams) => void;
}

export function Head({ session, comparedSession, params, onParams }: HeadProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.head}>
      <Link href={`/sessions/${session.id}`} className={classes.back ?? ""}>
        <Icon name="back" size={16} />
        <span className="visually-hidden">{t("replay.back")}: </span>
        {session.participant_code}
      </Link>
      <h1 className={classes.title}>{t("replay.title")}</h1>
      <KindBadge kind={session.kind} />
      <div className={classes.choices}>
        <PhaseSelect
          label={t("replay.phase")}
          session={session}
          phase={params.phase}
          onPhase={(phase) => {
            if (phase !== null) onParams({ ...params, phase, time: 0 });
          }}
        />
        <ComparisonSelect
          session={session}
          comparedSession={comparedSession}
          params={params}
          onParams={onParams}
        />
      </div>
    </div>
  );
}

function ComparisonSelect({ session, comparedSession, params, onParams }: HeadProps): JSX.Element {
  const { t } = useTexts();
  const others = useQuery(sessionsQuery(session.study_key));
  const finished = (others.data ?? []).filter(
    ({ ended_at, kind }) => ended_at !== null && kind === session.kind,
  );
  const chosen = params.comparedWith?.session ?? session.id;
  const choose = (id: string, phase: number | null) =>
    onParams({ ...params, comparedWith: phase === null ? null : { session: id, phase } });
  return (
    <>
      <PhaseSelect
        label={t("replay.beside")}
        none={t("replay.beside.none")}
        session={comparedSession}
        phase={params.comparedWith?.phase ?? null}
        without={comparedSession.id === session.id ? params.phase : null}
        onPhase={(phase) => choose(chosen, phase)}
      />
      {params.comparedWith !== null && finished.length > 1 && (
        <Select
          size="xs"
          styles={{ wrapper: { width: 110 } }}
          searchable
          allowDeselect={false}
          label={t("replay.beside.session")}
          classNames={{ root: classes.select ?? "", label: classes.selectLabel ?? "" }}
          value={chosen}
          data={finished.map(({ id, participant_code }) => ({
            value: id,
            label: participant_code,
          }))}
          onChange={(id) => choose(id ?? session.id, params.comparedWith?.phase ?? null)}
        />
      )}
    </>
  );
}

interface PhaseSelectProps {
  readonly label: string;
  readonly session: SessionView;
  readonly phase: number | null;
  readonly onPhase: (phase: number | null) => void;
  /** The label for no phase; if it is missing, a phase has to be selected. */
  readonly none?: string;
  readonly without?: number | null;
}

function PhaseSelect(props: PhaseSelectProps): JSX.Element {
  const { label, session, phase, onPhase, none, without = null } = props;
  const nameOf = usePhaseName();
  const phases = session.phases.filter(({ phase_id }) => phase_id !== without);
  return (
    <Select
      size="xs"
      styles={{ wrapper: { width: "min(232px, 100%)" } }}
      allowDeselect={false}
      label={label}
      classNames={{ root: classes.select ?? "", label: classes.selectLabel ?? "" }}
      value={String(phase ?? "")}
      data={[
        ...(none === undefined ? [] : [{ value: "", label: none }]),
        ...phases.map((one) => ({
          value: String(one.phase_id),
          label: nameOf(session, one),
          disabled: !isOver(one),
        })),
      ]}
      onChange={(value) => onPhase(value === null || value === "" ? null : Number(value))}
    />
  );
}
