"""Models of a consent: what is requested, what is given, and the printable record."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

SIGNATURE_WIDTH, SIGNATURE_HEIGHT = 600, 200
"""The size of the signing surface, whose coordinates a path uses; the origin is the top left."""
_STROKE = r"M\d{1,3}(\.\d)? \d{1,3}(\.\d)?(L\d{1,3}(\.\d)? \d{1,3}(\.\d)?)*"

SignaturePath = Annotated[
    str,
    StringConstraints(max_length=40_000, pattern=rf"^({_STROKE})+$"),
    Field(description="an SVG path of moves and lines on a surface of 600 by 200"),
]
Name = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=120)]
Mode = Literal["tablet", "operator", "paper"]


class ConsentGiven(BaseModel):
    """A consent given on the tablet; `ticked` lists the indices of the statements ticked."""

    model_config = ConfigDict(extra="forbid")

    step_index: int = Field(ge=0, lt=1000)
    ticked: list[Annotated[int, Field(ge=0, lt=20)]] = Field(default=[], max_length=20)
    name: Name | None = None
    signature: SignaturePath | None = None


class PaperConsent(BaseModel):
    """A consent signed on paper: where the sheet is stored, and why paper was used."""

    model_config = ConfigDict(extra="forbid", str_strip_whitespace=True)

    place: str = Field(min_length=1, max_length=200)
    reason: str = Field(min_length=1, max_length=1000)


class StatementForm(BaseModel):
    """A statement of a consent that can be ticked, in the participant's language."""

    text: str
    optional: bool


class ConsentForm(BaseModel):
    """The requirements of a consent besides its text: statements to tick, a kind of signature."""

    signature: Literal["none", "typed", "drawn"]
    statements: list[StatementForm]


class StatementRecord(StatementForm):
    """A statement of a consent, with whether it was ticked; null if that is only on paper."""

    ticked: bool | None


class ConsentRecord(BaseModel):
    """The printable record of a consent: who agreed to what, and when.

    `text` and `statements` are taken from the study version that was shown; `text_matches` says
    whether the text still has the hash stored with the consent. For an erased consent, only
    `erased` and the time remain.
    """

    session_id: str
    participant_code: str
    simulated: bool
    study_key: str
    study_title: str
    study_version: int
    content_hash: str
    language: str
    title: str
    text: str
    text_hash: str
    text_matches: bool
    statements: list[StatementRecord]
    signature_wanted: Literal["none", "typed", "drawn"]
    name: str | None
    signature: str | None
    mode: Mode
    paper: PaperConsent | None
    at: datetime
    by: str
    erased: bool
    records: int
