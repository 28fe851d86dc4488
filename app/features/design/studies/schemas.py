"""Studies as pages see them."""

from datetime import datetime
from typing import Any

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
