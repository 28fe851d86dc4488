"""The counterbalancing ledger as pages see it."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

Kind = Literal["people", "simulated", "test", "expert"]
"""Whose sessions a ledger orders; each kind has slots of its own."""


class AttemptView(BaseModel):
    """A session that holds or held a slot."""

    session_id: str
    participant_code: str
    outcome: Literal["open", "completed", "withdrawn", "aborted"]
    opened_at: datetime
    closed_at: datetime | None
    reason: str | None


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
