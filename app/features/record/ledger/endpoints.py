"""HTTP endpoint for the counterbalancing ledger."""

from collections import Counter
from collections.abc import Sequence

from fastapi import APIRouter
from sqlalchemy.orm import Session

from app.features.design.studies import newest_version, protocol_of, study_by_key
from app.features.record.ledger.schemas import AttemptView, Kind, LedgerView, SequenceRow, SlotRow
from app.features.record.ledger.service import SlotView, end_reason, ledger_of, planned_slots
from app.models import SlotAttempt
from app.platform.access import hidden_sessions, is_blind
from app.platform.dependencies import Reading, SignedIn

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
    latency_ms = {condition.key: condition.latency_ms for condition in protocol.conditions}
    slots = ledger_of(db, version, kind)
    rows = [_row(db, view, latency_ms) for view in slots] or [
        SlotRow(
            index=index,
            block=index // max(1, len(planned_slots(protocol)) // protocol.orders.replicates),
            replicate=replicate,
            sequence=[latency_ms[condition] for condition in sequence],
            state="free",
            attempts=[],
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
            row.model_copy(update={"sequence": None})
            if (free and (row.state == "free" or caller.role == "operator"))
            or any(attempt.session_id in hidden for attempt in row.attempts)
            else row
            for row in rows
        ],
    )


def _row(db: Session, view: SlotView, latency_ms: dict[str, float]) -> SlotRow:
    return SlotRow(
        index=view.slot.position,
        block=view.slot.block,
        replicate=view.slot.replicate,
        sequence=[latency_ms[condition] for condition in view.slot.sequence],
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
    counts = Counter((tuple(row.sequence or ()), row.state) for row in rows)
    orders = sorted({order for order, _ in counts})
    return [
        SequenceRow(
            sequence=list(order),
            completed=counts[order, "completed"],
            open=counts[order, "open"],
            total=sum(counts[order, state] for state in ("completed", "open", "free")),
        )
        for order in orders
    ]
