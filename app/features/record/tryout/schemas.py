"""A tryout as it travels to a page."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, StringConstraints

TryoutState = Literal["starting", "running", "done", "stopped", "failed"]


class TryoutWish(BaseModel):
    """In which language the scripted participant answers."""

    model_config = ConfigDict(extra="forbid")

    language: Annotated[str, StringConstraints(min_length=2, max_length=8)]


class TryoutTrouble(BaseModel):
    """Why it ended early, and what to do about it."""

    message: str
    remedy: str


class TryoutView(BaseModel):
    """The newest tryout. `session_id` is there once the session is; `step` says where it is.

    `speed`: how many times faster than a person. `mine`: whether the reader began it.
    """

    state: TryoutState
    study_key: str
    session_id: str | None
    step: str | None
    speed: float
    started_at: datetime
    started_by: str
    mine: bool
    trouble: TryoutTrouble | None
