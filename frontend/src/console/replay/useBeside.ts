/** The phase that stands beside, of this session or of another one of the study. */
import type { SessionView } from "@shared/api/types";
import { useQuery } from "@tanstack/react-query";
import { sessionQuery } from "../queries";
import type { PhaseRef } from "./address";
import { isOver, usePhaseName } from "./phaseNames";

export function useBeside(session: SessionView, wanted: PhaseRef | null) {
  const nameOf = usePhaseName();
  const isOther = wanted !== null && wanted.session !== session.id;
  const other = useQuery({ ...sessionQuery(wanted?.session ?? ""), enabled: isOther });
  const source = isOther ? (other.data ?? null) : session;
  const phase = source?.phases.find(({ phase_id }) => phase_id === wanted?.phase);
  const there = phase !== undefined && isOver(phase);
  const ref = there ? wanted : null;
  const name = source === null || phase === undefined ? "" : nameOf(source, phase);
  return {
    ref,
    session: source ?? session,
    label: isOther && source !== null ? `${source.participant_code} · ${name}` : name,
  };
}
