"""Response models of the ledger endpoint."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

from app.features.record.ledger.shortfalls import Shortfall

Kind = Literal["people", "simulated", "test", "expert"]
"""The kind of sessions that a ledger is for; each kind has its own slots."""


class AttemptView(BaseModel):
    """A session that occupies, or once occupied, a slot.

    `reason`: why it was aborted or withdrawn. `shortfalls`: why it was completed but is not valid
    (`invalid`). If there are none, it is valid, but its slot had been taken by another session.
    """

    session_id: str
    participant_code: str
    outcome: Literal["open", "completed", "withdrawn", "aborted", "invalid"]
    opened_at: datetime
    closed_at: datetime | None
    reason: str | None
    shortfalls: list[Shortfall]


class SlotRow(BaseModel):
    """A slot of the ledger; `sequence` contains latencies in ms, and is null for blind readers.

    `bodies`: the body worn at each of them, null for that of the configuration; null instead of the
    list for blind readers, and where latencies tell the conditions apart.
    """

    index: int
    block: int
    replicate: int
    sequence: list[float] | None
    bodies: list[str | None] | None = None
    state: Literal["free", "open", "completed"]
    attempts: list[AttemptView]


class SequenceRow(BaseModel):
    """An order, with how many of its slots are completed, open, and available in total.

    `bodies` as in `SlotRow`.
    """

    sequence: list[float]
    bodies: list[str | None] | None = None
    completed: int
    open: int
    total: int


class LedgerView(BaseModel):
    """The counterbalancing ledger for one kind of session."""

    kind: str
    seed: int | None
    when_full: str
    started: bool
    sequences: list[SequenceRow] | None
    slots: list[SlotRow]
