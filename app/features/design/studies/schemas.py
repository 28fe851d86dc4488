"""Studies as pages see them."""

from datetime import datetime
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

MAX_YAML_CHARACTERS = 262_144


class StudyFile(BaseModel):
    """A study as YAML text."""

    model_config = ConfigDict(extra="forbid")

    yaml: str = Field(max_length=MAX_YAML_CHARACTERS)


class VersionView(BaseModel):
    """One version of a study."""

    number: int
    content_hash: str
    created_at: datetime
    frozen_at: datetime | None


class StudySummary(BaseModel):
    """A study in the list."""

    key: str
    title: str
    description: str
    version: int
    content_hash: str
    frozen: bool
    session_counts: dict[str, int]
    created_at: datetime
    archived_at: datetime | None


class StudyView(StudySummary):
    """A study with its newest version in full; an operator of a blinded one gets no protocol."""

    languages: list[str]
    versions: list[VersionView]
    protocol: dict[str, Any] | None
    yaml: str | None


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
