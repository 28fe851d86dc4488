/** Any phase of a session in 3-D, in step with everything that was recorded of it. */
import type { SessionView } from "@shared/api/types";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useEffect, useState } from "react";
import { useTexts } from "../i18n";
import { sessionQuery } from "../queries";
import { isCounted, isOver } from "../steps";
import { EmptyState } from "../ui/EmptyState";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import { addressOf, paramsFrom, type ReplayParams } from "./address";
import { BackLink } from "./Head";
import { Player } from "./Player";
import classes from "./Replay.module.css";

export function ReplayPage({ id }: { readonly id: string }): JSX.Element {
  return (
    <Loaded query={useQuery(sessionQuery(id))}>
      {(session) => <SessionReplay session={session} />}
    </Loaded>
  );
}

function SessionReplay({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  const { params, arrival, setParams } = useParams(session.id);
  useTitle(t("replay.page", { code: session.participant_code }));
  const first = session.phases.find((phase) => phase.status === "done" && isCounted(phase));
  const phase = params.phase ?? (first ?? session.phases.find(isOver))?.phase_id ?? null;
  if (phase === null) {
    return (
      <div className={classes.alone}>
        <EmptyState icon="walk" title={t("replay.empty")} action={<BackLink id={session.id} />}>
          {t("replay.empty.body")}
        </EmptyState>
      </div>
    );
  }
  return (
    <Player
      // Another phase starts at its beginning, and a link at its moment.
      key={`${phase} ${arrival}`}
      session={session}
      params={{ ...params, phase }}
      onParams={setParams}
    />
  );
}

/** The parameters in the address; changes on the page are written back to it. */
function useParams(session: string) {
  const [{ params, arrival }, setState] = useState(() => ({
    params: paramsFrom(window.location.hash, session),
    arrival: 0,
  }));
  useEffect(() => {
    // A link to another moment was followed in the same window.
    const onHash = () =>
      setState((before) => ({
        params: paramsFrom(window.location.hash, session),
        arrival: before.arrival + 1,
      }));
    window.addEventListener("hashchange", onHash);
    return () => window.removeEventListener("hashchange", onHash);
  }, [session]);
  return {
    params,
    /** How many links to this page were followed. */
    arrival,
    setParams: (next: ReplayParams) => {
      window.history.replaceState(null, "", addressOf(session, next));
      setState({ params: next, arrival });
    },
  };
}
