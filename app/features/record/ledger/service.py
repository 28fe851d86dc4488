"""The counterbalancing ledger: each new session takes the next slot, in one transaction.

The ledger is an immutable list of slots (every order in every replicate), with the slots permuted
within each block by a stored seed. A session occupies a slot by an attempt. When the session is
withdrawn or aborted, or is completed but not valid by the study's rules, the attempt closes with
its data and the same slot is the next to be taken. So balance counts valid completed sessions.
People, simulated, test and expert sessions have separate ledgers.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import NamedTuple

from sqlalchemy import Select, func, select
from sqlalchemy.orm import Session

from app.database import referenced_row
from app.errors import Conflict
from app.features.record.ledger.shortfalls import Shortfall, shortfalls_of
from app.models import (
    Ledger,
    LedgerSlot,
    Participant,
    SessionContent,
    SessionEvent,
    SlotAttempt,
    Study,
    StudySession,
    StudyVersion,
)
from app.protocol import StudyProtocol, ledger_block

OCCUPYING = ("open", "completed")
ENDED = ("completed", "invalid")
"""Outcomes of completed sessions: valid, and not valid."""
ENDED_EARLY = ("aborted", "withdrawn")


class SlotAttemptDetails(NamedTuple):
    """An attempt with its participant's code.

    `reason`: why its session was aborted or withdrawn; None if it was not, or was erased.
    `shortfalls`: why its session is not valid.
    """

    session_id: str
    code: str
    outcome: str
    opened_at: datetime
    closed_at: datetime | None
    reason: str | None
    shortfalls: tuple[Shortfall, ...]


@dataclass(frozen=True)
class SlotView:
    """A slot with its order (condition keys) and all attempts on it, oldest first."""

    position: int
    block: int
    replicate: int
    sequence: Sequence[str]
    attempts: Sequence[SlotAttemptDetails]

    @property
    def state(self) -> str:
        """Return the state of the slot: free, open or completed."""
        outcomes = {one.outcome for one in self.attempts}
        if "completed" in outcomes:
            return "completed"
        return "open" if "open" in outcomes else "free"


def take_slot(
    db: Session, version: StudyVersion, protocol: StudyProtocol, kind: str, now: datetime
) -> LedgerSlot:
    """Return the next free slot; the caller opens its attempt in the same transaction.

    Raises Conflict if every slot is occupied and the study is `closed`.
    """
    ledger = _locked_ledger(db, version, protocol, kind, now)
    while True:
        slot = db.scalar(_free_slots(ledger.id).limit(1))
        if slot is not None:
            return slot
        if ledger.blocks >= protocol.orders.replicates and protocol.orders.when_full == "closed":
            total = db.scalar(
                select(func.count())
                .select_from(LedgerSlot)
                .where(LedgerSlot.ledger_id == ledger.id)
            )
            raise Conflict(
                "every slot of the ledger is taken and the study is closed",
                value=total,
                remedy="Abort or withdraw a session that will not be finished, or set "
                "orders.when_full to grow in a new version.",
            )
        _grow(db, ledger, protocol)


def _free_slots(ledger_id: str) -> Select[LedgerSlot]:
    occupied = (
        select(SlotAttempt.id)
        .where(SlotAttempt.slot_id == LedgerSlot.id, SlotAttempt.outcome.in_(OCCUPYING))
        .exists()
    )
    return (
        select(LedgerSlot)
        .where(LedgerSlot.ledger_id == ledger_id, ~occupied)
        .order_by(LedgerSlot.position)
    )


def _locked_ledger(
    db: Session, version: StudyVersion, protocol: StudyProtocol, kind: str, now: datetime
) -> Ledger:
    """Return the ledger row, locked so that simultaneous joins queue here."""
    query = (
        select(Ledger)
        .where(
            Ledger.study_id == version.study_id,
            Ledger.kind == kind,
            Ledger.design_hash == version.design_hash,
        )
        .with_for_update()
    )
    ledger = db.scalar(query)
    if ledger is None:
        # Two first joins may both find no ledger: queue on the study, then query again. The lock
        # leaves the study's key shareable: otherwise a transaction that already holds the ledger
        # could not insert rows that refer to the study, which would be a deadlock.
        study = select(Study.id).where(Study.id == version.study_id)
        db.execute(study.with_for_update(key_share=True))
        ledger = db.scalar(query)
    if ledger is None:
        ledger = Ledger(
            study_id=version.study_id,
            kind=kind,
            design_hash=version.design_hash,
            seed=protocol.orders.seed,
            blocks=0,
            created_at=now,
        )
        db.add(ledger)
        db.flush()
    while ledger.blocks < protocol.orders.replicates:
        _grow(db, ledger, protocol)
    return ledger


def _grow(db: Session, ledger: Ledger, protocol: StudyProtocol) -> None:
    """Add a whole seeded block to the ledger: every order once."""
    block = ledger_block(protocol, ledger.blocks)
    first = ledger.blocks * len(block)
    db.add_all(
        LedgerSlot(
            ledger_id=ledger.id,
            position=first + offset,
            block=ledger.blocks,
            replicate=replicate,
            sequence=list(sequence),
        )
        for offset, (sequence, replicate) in enumerate(block)
    )
    ledger.blocks += 1
    db.flush()


def open_attempt(db: Session, slot: LedgerSlot, session: StudySession, now: datetime) -> None:
    """Open an attempt, by which a session occupies its slot."""
    db.add(SlotAttempt(slot_id=slot.id, session_id=session.id, outcome="open", opened_at=now))
    db.flush()


def close_attempt(db: Session, session: StudySession, outcome: str, now: datetime) -> None:
    """Close the attempt of a session that has ended.

    A completed session keeps its slot for now; a withdrawn or aborted one frees it.
    """
    attempt = db.scalar(select(SlotAttempt).where(SlotAttempt.session_id == session.id))
    if attempt is not None and attempt.outcome == "open":
        attempt.outcome = outcome
        attempt.closed_at = now


def settle_attempt(db: Session, session: StudySession, *, counts: bool) -> None:
    """Keep the slot of a completed session that is valid, and free that of one that is not.

    A session that becomes valid later takes its slot back, unless another session has taken it.
    """
    attempt = db.scalar(select(SlotAttempt).where(SlotAttempt.session_id == session.id))
    if attempt is None or attempt.outcome not in ENDED:
        return
    if not counts:
        attempt.outcome = "invalid"
    elif attempt.outcome == "invalid":
        slot = referenced_row(db, LedgerSlot, attempt.slot_id)
        # Simultaneous joins queue on the same lock of the ledger.
        db.scalar(select(Ledger.id).where(Ledger.id == slot.ledger_id).with_for_update())
        occupied = select(SlotAttempt.id).where(
            SlotAttempt.slot_id == attempt.slot_id, SlotAttempt.outcome.in_(OCCUPYING)
        )
        if db.scalar(occupied) is None:
            attempt.outcome = "completed"


def slot_of(db: Session, session: StudySession) -> LedgerSlot:
    """Return the slot that a session occupies or once occupied."""
    return db.scalars(
        select(LedgerSlot)
        .join(SlotAttempt, SlotAttempt.slot_id == LedgerSlot.id)
        .where(SlotAttempt.session_id == session.id)
    ).one()


def ledger_of(db: Session, version: StudyVersion, kind: str) -> tuple[SlotView, ...]:
    """Return a ledger's slots in order, with their attempts; empty before the first session."""
    ledger = db.scalar(
        select(Ledger).where(
            Ledger.study_id == version.study_id,
            Ledger.kind == kind,
            Ledger.design_hash == version.design_hash,
        )
    )
    if ledger is None:
        return ()
    # Only the columns needed: a thousand complete rows of each table would be most of the work.
    slots = db.execute(
        select(
            LedgerSlot.id,
            LedgerSlot.position,
            LedgerSlot.block,
            LedgerSlot.replicate,
            LedgerSlot.sequence,
        )
        .where(LedgerSlot.ledger_id == ledger.id)
        .order_by(LedgerSlot.position)
    ).all()
    attempts = _attempts(db, ledger.id)
    return tuple(
        SlotView(
            slot.position, slot.block, slot.replicate, slot.sequence, attempts.get(slot.id, ())
        )
        for slot in slots
    )


def _attempts(db: Session, ledger_id: str) -> dict[str, list[SlotAttemptDetails]]:
    """Return the attempts on the slots of a ledger by slot, oldest first."""
    rows = db.execute(
        select(
            SlotAttempt.slot_id,
            SlotAttempt.session_id,
            Participant.code,
            SlotAttempt.outcome,
            SlotAttempt.opened_at,
            SlotAttempt.closed_at,
            StudySession.shortfalls,
        )
        .join(LedgerSlot, LedgerSlot.id == SlotAttempt.slot_id)
        .join(StudySession, StudySession.id == SlotAttempt.session_id)
        .join(Participant, Participant.id == StudySession.participant_id)
        .where(LedgerSlot.ledger_id == ledger_id)
        .order_by(SlotAttempt.opened_at)
    )
    reasons = _end_reasons(db, ledger_id)
    attempts: dict[str, list[SlotAttemptDetails]] = {}
    for slot_id, session_id, code, outcome, opened_at, closed_at, stored in rows:
        one = SlotAttemptDetails(
            session_id,
            code,
            outcome,
            opened_at,
            closed_at,
            reasons.get(session_id),
            shortfalls_of(stored) if stored else (),
        )
        attempts.setdefault(slot_id, []).append(one)
    return attempts


def planned_slots(protocol: StudyProtocol) -> Sequence[tuple[tuple[str, ...], int]]:
    """Return the slots a ledger will have at first, as (order, replicate) in slot order."""
    return [
        row for block in range(protocol.orders.replicates) for row in ledger_block(protocol, block)
    ]


def _end_reasons(db: Session, ledger_id: str) -> dict[str, str]:
    """Return the lab's reason for each aborted or withdrawn session of a ledger, unless erased."""
    of_ended = (
        select(SlotAttempt.session_id)
        .join(LedgerSlot, LedgerSlot.id == SlotAttempt.slot_id)
        .where(LedgerSlot.ledger_id == ledger_id, SlotAttempt.outcome.in_(ENDED_EARLY))
    )
    ends = select(SessionEvent.session_id, SessionEvent.payload).where(
        SessionEvent.session_id.in_(of_ended), SessionEvent.type == "session_ended"
    )
    named = {session_id: json.loads(text)["content_id"] for session_id, text in db.execute(ends)}
    if not named:
        return {}
    contents = select(SessionContent.id, SessionContent.body).where(
        SessionContent.session_id.in_(of_ended), SessionContent.kind == "reason"
    )
    bodies = {id_: body for id_, body in db.execute(contents) if body is not None}
    return {
        session_id: str(json.loads(bodies[content_id]))
        for session_id, content_id in named.items()
        if content_id in bodies
    }
