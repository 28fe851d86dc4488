"""HTTP endpoint for the counterbalancing ledger."""

from collections.abc import Sequence
from typing import TypedDict

from fastapi import APIRouter
from sqlalchemy.orm import Session

from app.features.design.studies import newest_version, protocol_of, study_by_key
from app.features.record.ledger.schemas import AttemptView, Kind, LedgerView, SequenceRow, SlotRow
from app.features.record.ledger.service import SlotView, end_reason, ledger_of, planned_slots
from app.models import SlotAttempt
from app.platform.access import hidden_sessions, is_blind
from app.platform.dependencies import Reading, SignedIn
from app.protocol import StudyProtocol

router = APIRouter(tags=["participants"])
ENDED_EARLY = ("aborted", "withdrawn")


@router.get("/studies/{key}/ledger")
def get_ledger(key: str, db: Reading, caller: SignedIn, kind: Kind = "people") -> LedgerView:
    """Return every slot with its attempts; before the first session, the slots as planned.

    In a blinded study, only those orders are shown that may be known by now, and none to operators.
    """
    study = study_by_key(db, key)
    version = newest_version(db, study)
    protocol = protocol_of(version)
    slots = ledger_of(db, version, kind)
    rows = [_row(db, view, protocol) for view in slots] or [
        SlotRow(
            index=index,
            block=index // max(1, len(planned_slots(protocol)) // protocol.orders.replicates),
            replicate=replicate,
            state="free",
            attempts=[],
            **_order(protocol, sequence),
        )
        for index, (sequence, replicate) in enumerate(planned_slots(protocol))
    ]
    hidden = hidden_sessions(db, study, caller)
    # A free slot will be taken by a session of the newest version.
    free = is_blind(db, caller, protocol, None)
    blinded = free or bool(hidden)
    return LedgerView(
        kind=kind,
        seed=None if blinded else protocol.orders.seed,
        when_full=protocol.orders.when_full,
        started=bool(slots),
        sequences=None if blinded else _sequences(rows),
        slots=[
            row.model_copy(update={"sequence": None, "bodies": None})
            if (free and (row.state == "free" or caller.role == "operator"))
            or any(attempt.session_id in hidden for attempt in row.attempts)
            else row
            for row in rows
        ],
    )


class _Order(TypedDict):
    """The fields of a row that describe an order of conditions."""

    sequence: list[float]
    bodies: list[str | None] | None


def _order(protocol: StudyProtocol, order: Sequence[str]) -> _Order:
    bodies = protocol.bodies_of(order)
    return _Order(
        sequence=[protocol.condition(key).latency_ms for key in order],
        bodies=None if bodies is None else list(bodies),
    )


def _row(db: Session, view: SlotView, protocol: StudyProtocol) -> SlotRow:
    return SlotRow(
        index=view.slot.position,
        block=view.slot.block,
        replicate=view.slot.replicate,
        **_order(protocol, view.slot.sequence),
        state=view.state,
        attempts=[
            AttemptView(
                session_id=one.attempt.session_id,
                participant_code=one.code,
                outcome=one.attempt.outcome,
                opened_at=one.attempt.opened_at,
                closed_at=one.attempt.closed_at,
                reason=_reason(db, one.attempt),
                shortfalls=list(one.shortfalls),
            )
            for one in view.attempts
        ],
    )


def _reason(db: Session, attempt: SlotAttempt) -> str | None:
    return end_reason(db, attempt.session_id) if attempt.outcome in ENDED_EARLY else None


def _sequences(rows: Sequence[SlotRow]) -> list[SequenceRow]:
    of_order: dict[tuple[tuple[float, str], ...], list[SlotRow]] = {}
    for row in rows:
        latencies_ms = row.sequence or []
        worn = [body or "" for body in row.bodies or [None] * len(latencies_ms)]
        of_order.setdefault(tuple(zip(latencies_ms, worn, strict=True)), []).append(row)
    return [
        SequenceRow(
            sequence=own[0].sequence or [],
            bodies=own[0].bodies,
            completed=sum(row.state == "completed" for row in own),
            open=sum(row.state == "open" for row in own),
            total=len(own),
        )
        for _, own in sorted(of_order.items())
    ]
