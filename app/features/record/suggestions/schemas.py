"""Suggestions as they travel to a page."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

Status = Literal["open", "adopted", "declined"]


class NewSuggestion(BaseModel):
    """Advice about a version of a study; `about` is a step's key, or empty for the whole.

    With a `session_id` the version is that session's, so `version` may be left out.
    """

    model_config = ConfigDict(extra="forbid")

    version: int | None = Field(default=None, ge=1, lt=2**31)
    session_id: str | None = Field(default=None, max_length=36)
    about: str = Field(default="", max_length=80)
    body: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=4000)]


class Decision(BaseModel):
    """What becomes of a suggestion; `adopted_in` is the number of the version that has it."""

    model_config = ConfigDict(extra="forbid")

    status: Literal["adopted", "declined"]
    adopted_in: int | None = Field(default=None, ge=1, lt=2**31)


class SuggestionView(BaseModel):
    """A suggestion with its fate. `about_title`: the name of the step in the study's words."""

    id: str
    version: int
    session_id: str | None
    participant_code: str | None
    about: str
    about_title: str | None
    body: str
    status: Status
    adopted_in: int | None
    by: str
    at: datetime
    decided_by: str | None
    decided_at: datetime | None
