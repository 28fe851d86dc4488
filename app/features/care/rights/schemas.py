"""Request and response models of participants' rights."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

ReasonCode = Literal["withdrawn", "requested", "retention", "mistake"]
Answered = Annotated[str, Field(max_length=20_000)] | bool | float | None


class NewCorrection(BaseModel):
    """A corrected value of one answer with its reason; null removes the answer."""

    model_config = ConfigDict(extra="forbid")

    item: str = Field(min_length=1, max_length=80)
    value: Answered
    reason: str = Field(max_length=2000)


class ErasureRequest(BaseModel):
    """A request to erase everything about a participant; `confirm` is their code, typed again."""

    model_config = ConfigDict(extra="forbid")

    confirm: str = Field(max_length=40)
    reason_code: ReasonCode


class CopyLeft(BaseModel):
    """A copy outside the database that may contain erased data."""

    id: str
    kind: Literal["export", "access", "backup"]
    place: str
    at: datetime
    destroyed_at: datetime | None
    destroyed_by: str | None


class ErasureView(BaseModel):
    """A tombstone; `removed` is the number of deleted rows by table.

    `overwritten`: no byte of them is left in the database; otherwise the next start overwrites
    them.
    """

    id: str
    at: datetime
    by: str
    reason_code: str
    removed: dict[str, int]
    remaining: list[CopyLeft]
    overwritten: bool


class ParticipantSession(BaseModel):
    """One session of a participant."""

    id: str
    status: str
    created_at: datetime
    started_at: datetime | None
    ended_at: datetime | None


class ParticipantView(BaseModel):
    """A participant by pseudonym; `copies` are those that may contain their data."""

    id: str
    code: str
    kind: str
    created_at: datetime
    sessions: list[ParticipantSession]
    copies: list[CopyLeft]
    erasure: ErasureView | None


class CopyView(CopyLeft):
    """A copy that left the database: an export, an access copy or a backup.

    `place`: a file, or who downloaded it. `bytes` is null if the size is unknown.
    """

    study_key: str | None
    session_kind: str | None
    sessions: int | None
    bytes: int | None
    by: str
