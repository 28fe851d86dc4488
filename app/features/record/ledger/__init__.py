"""Joining: participants and the counterbalancing ledger."""

from app.features.record.ledger.codes import find_or_add_participant
from app.features.record.ledger.schemas import Kind
from app.features.record.ledger.service import (
    close_attempt,
    hold_slot,
    planned_slots,
    slot_of,
    take_slot,
)

__all__ = [
    "Kind",
    "close_attempt",
    "find_or_add_participant",
    "hold_slot",
    "planned_slots",
    "slot_of",
    "take_slot",
]
