/** The replay's address: which phase, which moment, and which phase it is compared with. */

/** A phase of any session. */
export interface PhaseRef {
  readonly session: string;
  readonly phase: number;
}

export interface ReplayParams {
  readonly phase: number | null;
  readonly time: number;
  readonly comparedWith: PhaseRef | null;
}

/** What is shown: the address's parameters, with the phase always given. */
export interface ReplayParamsWithPhase extends ReplayParams {
  readonly phase: number;
}

/** Parse `?phase=2&t=12.5&with=5`; `with=SESSION:5` is a phase of another session. */
export function paramsFrom(address: string, session: string): ReplayParams {
  const query = new URLSearchParams(address.split("?")[1] ?? "");
  const time = Number(query.get("t"));
  return {
    phase: phaseNumber(query.get("phase")),
    time: Number.isFinite(time) ? Math.max(0, time) : 0,
    comparedWith: phaseRefFrom(query.get("with"), session),
  };
}

export function addressOf(session: string, { phase, time, comparedWith }: ReplayParams): string {
  const parts = [
    ...(phase === null ? [] : [`phase=${phase}`]),
    ...(time > 0 ? [`t=${Number(time.toFixed(3))}`] : []),
    ...(comparedWith === null ? [] : [`with=${named(comparedWith, session)}`]),
  ];
  const query = parts.length > 0 ? `?${parts.join("&")}` : "";
  return `#/sessions/${encodeURIComponent(session)}/replay${query}`;
}

const named = ({ session, phase }: PhaseRef, own: string): string =>
  session === own ? String(phase) : `${encodeURIComponent(session)}:${phase}`;

function phaseRefFrom(text: string | null, own: string): PhaseRef | null {
  const [first = "", second] = (text ?? "").split(":");
  const phase = phaseNumber(second ?? first);
  if (phase === null) return null;
  return { session: second === undefined ? own : first, phase };
}

const phaseNumber = (text: string | null): number | null =>
  text !== null && /^\d{1,9}$/.test(text) ? Number(text) : null;
