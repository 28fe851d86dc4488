"""Compute the receipt of a session from its record whenever it is requested."""

import json
from dataclasses import asdict, dataclass
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app import __version__
from app.database import referenced_row
from app.features.record.doubts import Doubt, doubts_of
from app.features.record.receipts.completions import CompletionReceipt, completion_receipts
from app.features.record.receipts.latencies import LatencyReceipt, latency_receipts
from app.features.record.receipts.streams import StreamReceipt, Tallies, stream_receipts
from app.features.record.sessions import ChainCheck, events_of, state_of, verify_chain
from app.features.record.telemetry import abilities_of
from app.models import ClientReport, Phase, Study, TelemetryBatch, TelemetryChunk, TelemetryStream
from app.platform.access import session_by_id
from app.wire import BODY_STREAMS, FINGER_STREAMS, REPORT_STREAM, StreamName

_WHAT = {
    StreamName.TARGET: "target body",
    StreamName.ACTUAL: "actual body",
    StreamName.TARGET_FINGERS: "target fingers, which the headset announced",
    StreamName.ACTUAL_FINGERS: "actual fingers, which the headset announced",
}


@dataclass(frozen=True)
class AvatarChangeReceipt:
    """A change of the avatar by the operator, which the protocol does not provide for.

    `event`: its number in the event log. `phase_id`: the phase in which it was made, which is a
    `deviation` from the protocol; None between phases. `applied`: whether the headset carried it
    out; None if it never answered.
    """

    event: int
    phase_id: int | None
    deviation: bool
    applied: bool | None


@dataclass(frozen=True)
class SessionReceipt:
    """The data that a session's record contains, and those that it lacks.

    `complete` is true if `problems` is empty: nothing that was made is missing or damaged, the
    event log's hash chain is intact, the stored completions follow from the stored contacts, and
    there are no `doubts`, that is, nothing in the record is known to be untrue. A session that is
    still running may lack what its headset has yet to send.
    """

    product_version: str
    study: str
    session_id: str
    status: str
    simulated: bool
    complete: bool
    problems: tuple[str, ...]
    streams: tuple[StreamReceipt, ...]
    chain_ok: bool
    chain: ChainCheck
    completions: tuple[CompletionReceipt, ...]
    doubts: tuple[Doubt, ...]
    achieved_latency: tuple[LatencyReceipt, ...]
    avatar_changes: tuple[AvatarChangeReceipt, ...] = ()

    def as_json(self) -> dict[str, Any]:
        """Return the receipt as a dictionary for JSON output."""
        return asdict(self)


def receipt_of(
    db: Session, session_id: str, *, blinded: bool = False, tallies: Tallies | None = None
) -> SessionReceipt:
    """Count, verify and derive everything from the record; raises NotFound for an unknown session.

    `blinded`: as readers may see it who must not know the condition. It has no latencies, neither
    hashes of the avatar's frames nor how many of them were flagged, and while a phase runs no
    stream of reports: a report follows every contact, which is late by the latency.

    This takes about a second per ten minutes of session. `tallies`: the streams that were counted
    in this transaction already.
    """
    session = session_by_id(db, session_id)
    streams = stream_receipts(db, session_id, tallies)
    if blinded:
        runs = state_of(session).phase is not None
        shown = (one for one in streams if not (runs and one.stream == REPORT_STREAM))
        streams = tuple(one.blinded() for one in shown)
    chain = verify_chain(events_of(db, session_id), version=session.version)
    completions = completion_receipts(db, session)
    doubts = doubts_of(db, session_id)
    problems = (
        *_stream_problems(streams),
        *_phase_problems(db, session_id),
        *_chain_problems(chain),
        *(f"phase {one.phase_id}: {one.reason}" for one in completions if not one.agree),
        *(_doubt_problem(one) for one in doubts),
    )
    return SessionReceipt(
        product_version=__version__,
        study=referenced_row(db, Study, session.study_id).key,
        session_id=session_id,
        status=session.status,
        simulated=session.kind == "simulated",
        complete=not problems,
        problems=problems,
        streams=streams,
        chain_ok=chain.ok,
        chain=chain,
        completions=completions,
        doubts=doubts,
        achieved_latency=() if blinded else latency_receipts(db, session_id),
        avatar_changes=_avatar_changes(db, session_id),
    )


def _avatar_changes(db: Session, session_id: str) -> tuple[AvatarChangeReceipt, ...]:
    """Return the operator's changes, each with the headset's first later report that covers it.

    A headset brings its body to the newest changes, so it may skip earlier revisions.
    """
    log = [(row.seq, row.type, json.loads(row.payload)) for row in events_of(db, session_id)]
    reports = [
        (seq, payload["revision"], payload["applied"])
        for seq, kind, payload in log
        if kind == "avatar_change_reported"
    ]
    return tuple(
        AvatarChangeReceipt(
            seq,
            payload["phase_id"],
            payload["deviation"],
            next((done for at, to, done in reports if at > seq and to >= seq), None),
        )
        for seq, kind, payload in log
        if kind == "avatar_changed" and payload["by"] == "operator"
    )


def _stream_problems(streams: tuple[StreamReceipt, ...]) -> list[str]:
    problems = []
    for one in streams:
        name = f"{one.stream}, epoch {one.epoch}"
        if one.missing > one.damaged:
            seqs = ", ".join(f"{first} to {end - 1}" for first, end in one.gaps)
            problems.append(f"{name}: {one.missing} of {one.sent} are missing (seq {seqs})")
        if one.damaged:
            problems.append(f"{name}: {one.damaged} frames can no longer be read")
        if one.backwards:
            problems.append(f"{name}: {one.backwards} frames are not later than the one before")
    return problems


def _doubt_problem(doubt: Doubt) -> str:
    where = "" if doubt.phase_id is None else f"phase {doubt.phase_id}: "
    return f"{where}cannot be true: {doubt.words}"


def _phase_problems(db: Session, session_id: str) -> list[str]:
    """Report finished phases without frames, in which nothing can have been recorded.

    Fingers must be there in those epochs of a phase that announced them.
    """
    phases = db.scalars(
        select(Phase)
        .where(Phase.session_id == session_id, Phase.status == "done")
        .order_by(Phase.phase_id)
    ).all()
    announced = _announced_fingers(db, session_id)
    silent = _silent_about_goals(db, session_id)
    problems = []
    for phase in phases:
        found = _streams_of(db, phase)
        streams, epochs = {stream for stream, _ in found}, {epoch for _, epoch in found}
        problems += [
            f"phase {phase.phase_id}: no frames of the {_WHAT[stream]}"
            for stream in BODY_STREAMS
            if stream not in streams
        ]
        problems += [
            f"phase {phase.phase_id}, epoch {epoch}: no frames of the {_WHAT[stream]}"
            for epoch in sorted(epochs)
            for stream in FINGER_STREAMS
            if (stream, epoch) in announced - found
        ]
        problems += [
            f"phase {phase.phase_id}, epoch {epoch}: no report of how the goals of the body are"
            " known, which the headset announced"
            for epoch in sorted(epochs & silent)
        ]
    return problems


def _silent_about_goals(db: Session, session_id: str) -> set[int]:
    """Return the epochs whose headset announced reports of the goals and never made one."""
    announced = {epoch for epoch, found in abilities_of(db, session_id).items() if "goals" in found}
    reported = db.scalars(
        select(ClientReport.epoch)
        .where(
            ClientReport.session_id == session_id,
            ClientReport.type == "goals",
            ClientReport.accepted,
        )
        .distinct()
    )
    return announced - set(reported)


def _announced_fingers(db: Session, session_id: str) -> set[tuple[str, int]]:
    """Return the streams of fingers, with their epochs, that a headset has announced."""
    query = select(TelemetryStream.stream, TelemetryStream.epoch).where(
        TelemetryStream.session_id == session_id, TelemetryStream.stream.in_(FINGER_STREAMS)
    )
    return {(stream, epoch) for stream, epoch in db.execute(query)}


def _streams_of(db: Session, phase: Phase) -> set[tuple[str, int]]:
    """Return the streams, with their epochs, that have frames in a phase."""
    return {
        (stream, epoch)
        for table in (TelemetryChunk, TelemetryBatch)
        for stream, epoch in db.execute(
            select(table.stream, table.epoch)
            .where(table.session_id == phase.session_id, table.phase_id == phase.phase_id)
            .distinct()
        )
    }


def _chain_problems(chain: ChainCheck) -> list[str]:
    if chain.ok:
        return []
    return [f"the event log was changed: its hash chain breaks at event {chain.broken_at}"]


def receipt_text(receipt: SessionReceipt) -> str:
    """Format a receipt as text: verdict, problems, streams, event log, completions, latencies."""
    verdict = "COMPLETE" if receipt.complete else "NOT COMPLETE"
    wide = max([8, *(len(one.stream) for one in receipt.streams)]) + 2
    simulated = ", simulated" if receipt.simulated else ""
    lines = [
        f"{verdict}  session {receipt.session_id} ({receipt.study}, {receipt.status}{simulated})",
        *(f"  ! {problem}" for problem in receipt.problems),
        "",
        f"{'stream':<{wide}}{'epoch':>6}{'sent':>10}{'stored':>10}{'missing':>9}{'flagged':>9}",
        *(
            f"{one.stream:<{wide}}{one.epoch:>6}{one.sent:>10}{one.stored:>10}{one.missing:>9}"
            f"{'-' if one.flagged is None else one.flagged:>9}"
            for one in receipt.streams
        ),
        "",
        f"event log  {receipt.chain.events} events, "
        + ("every hash follows from the one before" if receipt.chain_ok else "CHANGED"),
        _completions_line(receipt),
    ]
    lines += [_avatar_change_line(one) for one in receipt.avatar_changes]
    if receipt.achieved_latency:
        lines += ["", f"{'phase':<8}{'':<12}{'ordered':>10}{'achieved (95 %)':>28}"]
        lines += [_latency_line(one) for one in receipt.achieved_latency]
    return "\n".join(lines)


def _completions_line(receipt: SessionReceipt) -> str:
    stored = sum(one.stored for one in receipt.completions)
    rederived = sum(one.rederived for one in receipt.completions)
    return f"completions  {stored} stored, {rederived} follow from the contacts"


def _avatar_change_line(one: AvatarChangeReceipt) -> str:
    where = f"in phase {one.phase_id}, not in the protocol" if one.deviation else "between phases"
    done = {True: "carried out", False: "NOT carried out", None: "NOT confirmed"}[one.applied]
    return f"avatar changed by the operator  event {one.event}, {where}, {done} by the headset"


def _latency_line(one: LatencyReceipt) -> str:
    name = one.limb or one.kind.replace("_", " ")
    head = f"{one.phase_id:<8}{name:<12}{one.latency_ms:>7.0f} ms"
    if one.achieved_latency_ms is None:
        return f"{head}   {one.reason or 'unknown'}"
    interval = f"{one.achieved_latency_low_ms:.1f} to {one.achieved_latency_high_ms:.1f}"
    achieved = f"{one.achieved_latency_ms:.1f} ms ({interval})"
    return f"{head}{achieved:>28}{'  OFF' if one.off else ''}"
