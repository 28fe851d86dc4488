"""The counterbalancing ledger as pages see it."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

from app.features.record.ledger.shortfalls import Shortfall

Kind = Literal["people", "simulated", "test", "expert"]
"""Whose sessions a ledger orders; each kind has slots of its own."""


class AttemptView(BaseModel):
    """A session that holds or held a slot.

    `reason`: why it was aborted or withdrawn. `shortfalls`: why it was completed and does not count
    (`invalid`); without any it counts, and its slot had been given to somebody else by then.
    """

    session_id: str
    participant_code: str
    outcome: Literal["open", "completed", "withdrawn", "aborted", "invalid"]
    opened_at: datetime
    closed_at: datetime | None
    reason: str | None
    shortfalls: list[Shortfall]


class SlotRow(BaseModel):
    """A slot of the ledger; `sequence` holds latencies in ms, null for who must not know."""

    index: int
    block: int
    replicate: int
    sequence: list[float] | None
    state: Literal["free", "open", "completed"]
    attempts: list[AttemptView]


class SequenceRow(BaseModel):
    """How far one order is filled."""

    sequence: list[float]
    completed: int
    open: int
    total: int


class LedgerView(BaseModel):
    """The counterbalancing ledger of one kind of sessions."""

    kind: str
    seed: int | None
    when_full: str
    started: bool
    sequences: list[SequenceRow] | None
    slots: list[SlotRow]
