"""HTTP endpoint for the counterbalancing ledger."""

from collections.abc import Sequence
from typing import TypedDict

from fastapi import APIRouter

from app.features.design.studies import newest_version, protocol_of, study_by_key
from app.features.record.ledger.schemas import AttemptView, Kind, LedgerView, SequenceRow, SlotRow
from app.features.record.ledger.service import SlotView, ledger_of, planned_slots
from app.platform.access import hidden_sessions, is_blind
from app.platform.dependencies import Reading, SignedIn
from app.protocol import StudyProtocol

router = APIRouter(tags=["participants"])


@router.get("/studies/{key}/ledger")
def get_ledger(key: str, db: Reading, caller: SignedIn, kind: Kind = "people") -> LedgerView:
    """Return every slot with its attempts; before the first session, the slots as planned.

    In a blinded study, only those orders are shown that may be known by now, and none to operators.
    """
    study = study_by_key(db, key)
    version = newest_version(db, study)
    protocol = protocol_of(version)
    slots = ledger_of(db, version, kind)
    orders = {order: _order(protocol, order) for order in {tuple(one.sequence) for one in slots}}
    rows = [_row(view, orders[tuple(view.sequence)]) for view in slots] or [
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


def _row(view: SlotView, order: _Order) -> SlotRow:
    return SlotRow(
        index=view.position,
        block=view.block,
        replicate=view.replicate,
        **order,
        state=view.state,
        attempts=[
            AttemptView(
                session_id=one.session_id,
                participant_code=one.code,
                outcome=one.outcome,
                opened_at=one.opened_at,
                closed_at=one.closed_at,
                reason=one.reason,
                shortfalls=list(one.shortfalls),
            )
            for one in view.attempts
        ],
    )


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
