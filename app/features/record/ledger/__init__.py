"""The counterbalancing ledger, and the participants whose sessions take its slots."""

from app.features.record.ledger.codes import find_or_add_participant, is_code
from app.features.record.ledger.schemas import Kind
from app.features.record.ledger.service import (
    close_attempt,
    open_attempt,
    planned_slots,
    settle_attempt,
    slot_of,
    take_slot,
)
from app.features.record.ledger.shortfalls import Shortfall, ShortfallCode, shortfalls_of

__all__ = [
    "Kind",
    "Shortfall",
    "ShortfallCode",
    "close_attempt",
    "find_or_add_participant",
    "is_code",
    "open_attempt",
    "planned_slots",
    "settle_attempt",
    "shortfalls_of",
    "slot_of",
    "take_slot",
]
