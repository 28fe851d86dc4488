"""Joining a study: one transaction takes the next slot of the ledger.

The ledger is an immutable list of slots, every order in every replicate, with the slots permuted
within each block by a stored seed. A session holds a slot by an attempt. When it is withdrawn or
aborted, or is completed and does not count by the study's rules, the attempt closes with its data
and the same slot is the next to be taken, so balance counts completed sessions that are valid.
People, simulated, test and expert sessions have ledgers of their own.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import Select, func, select
from sqlalchemy.orm import Session

from app.database import kept_row
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

HOLDING = ("open", "completed")
ENDED = ("completed", "invalid")
"""Outcomes of completed sessions: that count, and that do not."""


@dataclass(frozen=True)
class Held:
    """An attempt with the participant's code, and what its session lacks in order to count."""

    attempt: SlotAttempt
    code: str
    shortfalls: tuple[Shortfall, ...]


@dataclass(frozen=True)
class SlotView:
    """A slot with everybody who ever held it, oldest first."""

    slot: LedgerSlot
    attempts: tuple[Held, ...]

    @property
    def state(self) -> str:
        """free, open or completed."""
        outcomes = {held.attempt.outcome for held in self.attempts}
        if "completed" in outcomes:
            return "completed"
        return "open" if "open" in outcomes else "free"


def take_slot(
    db: Session, version: StudyVersion, protocol: StudyProtocol, kind: str, now: datetime
) -> LedgerSlot:
    """The next free slot; the caller attaches its attempt in the same transaction.

    Raises Conflict when every slot is held and the study is `closed`.
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
                remedy="Withdraw a session that will not be finished, or set "
                "orders.when_full to grow in a new version.",
            )
        _grow(db, ledger, protocol)


def _free_slots(ledger_id: str) -> Select[LedgerSlot]:
    held = (
        select(SlotAttempt.id)
        .where(SlotAttempt.slot_id == LedgerSlot.id, SlotAttempt.outcome.in_(HOLDING))
        .exists()
    )
    return (
        select(LedgerSlot)
        .where(LedgerSlot.ledger_id == ledger_id, ~held)
        .order_by(LedgerSlot.position)
    )


def _locked_ledger(
    db: Session, version: StudyVersion, protocol: StudyProtocol, kind: str, now: datetime
) -> Ledger:
    """The ledger row, locked so that simultaneous joins queue here."""
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
        # Two first joins may both find nothing: queue on the study, then look again. Sharing its
        # key, or whoever holds the ledger already could not refer to the study: a deadlock.
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
    """Add one whole seeded block: every order once."""
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


def hold_slot(db: Session, slot: LedgerSlot, session: StudySession, now: datetime) -> None:
    """Attach a session to its slot."""
    db.add(SlotAttempt(slot_id=slot.id, session_id=session.id, outcome="open", opened_at=now))
    db.flush()


def close_attempt(db: Session, session: StudySession, outcome: str, now: datetime) -> None:
    """The session has ended: completed keeps the slot for now, withdrawn and aborted free it."""
    attempt = db.scalar(select(SlotAttempt).where(SlotAttempt.session_id == session.id))
    if attempt is not None and attempt.outcome == "open":
        attempt.outcome = outcome
        attempt.closed_at = now


def settle_attempt(db: Session, session: StudySession, *, counts: bool) -> None:
    """A completed session keeps its slot if it counts, and frees it if not.

    One that turns out to count after all takes its slot back, unless somebody else has it by then.
    """
    attempt = db.scalar(select(SlotAttempt).where(SlotAttempt.session_id == session.id))
    if attempt is None or attempt.outcome not in ENDED:
        return
    if not counts:
        attempt.outcome = "invalid"
    elif attempt.outcome == "invalid":
        slot = kept_row(db, LedgerSlot, attempt.slot_id)
        # Simultaneous joins queue on the ledger, too.
        db.scalar(select(Ledger.id).where(Ledger.id == slot.ledger_id).with_for_update())
        held = select(SlotAttempt.id).where(
            SlotAttempt.slot_id == attempt.slot_id, SlotAttempt.outcome.in_(HOLDING)
        )
        if db.scalar(held) is None:
            attempt.outcome = "completed"


def slot_of(db: Session, session: StudySession) -> LedgerSlot:
    """The slot a session holds or held."""
    return db.scalars(
        select(LedgerSlot)
        .join(SlotAttempt, SlotAttempt.slot_id == LedgerSlot.id)
        .where(SlotAttempt.session_id == session.id)
    ).one()


def ledger_of(db: Session, version: StudyVersion, kind: str) -> tuple[SlotView, ...]:
    """Every slot of a ledger in order, with its attempts; empty before the first join."""
    ledger = db.scalar(
        select(Ledger).where(
            Ledger.study_id == version.study_id,
            Ledger.kind == kind,
            Ledger.design_hash == version.design_hash,
        )
    )
    if ledger is None:
        return ()
    slots = db.scalars(
        select(LedgerSlot).where(LedgerSlot.ledger_id == ledger.id).order_by(LedgerSlot.position)
    ).all()
    rows = db.execute(
        select(SlotAttempt, Participant.code, StudySession.shortfalls)
        .join(LedgerSlot, LedgerSlot.id == SlotAttempt.slot_id)
        .join(StudySession, StudySession.id == SlotAttempt.session_id)
        .join(Participant, Participant.id == StudySession.participant_id)
        .where(LedgerSlot.ledger_id == ledger.id)
        .order_by(SlotAttempt.opened_at)
    )
    held: dict[str, list[Held]] = {}
    for attempt, code, stored in rows:
        one = Held(attempt, code, shortfalls_of(stored))
        held.setdefault(attempt.slot_id, []).append(one)
    return tuple(SlotView(slot, tuple(held.get(slot.id, ()))) for slot in slots)


def planned_slots(protocol: StudyProtocol) -> Sequence[tuple[tuple[str, ...], int]]:
    """The slots a ledger will have before anybody joined: (order, replicate) in slot order."""
    return [
        row for block in range(protocol.orders.replicates) for row in ledger_block(protocol, block)
    ]


def end_reason(db: Session, session_id: str) -> str | None:
    """Why a session was aborted or withdrawn, in the words of the lab; None once erased."""
    ended = db.scalar(
        select(SessionEvent).where(
            SessionEvent.session_id == session_id, SessionEvent.type == "session_ended"
        )
    )
    content_id = None if ended is None else json.loads(ended.payload)["content_id"]
    content = db.get(SessionContent, content_id) if content_id else None
    return None if content is None or content.body is None else str(json.loads(content.body))
