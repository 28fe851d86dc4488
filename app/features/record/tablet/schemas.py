"""The tablet's screens."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from app.features.record.questionnaires import Administration
from app.features.record.sessions import ConsentForm

Screen = Literal["waiting", "held", "consent", "instructions", "form", "finished"]


class TabletState(BaseModel):
    """What the tablet shows now; `next` says what comes next, in the participant's language.

    `held`: the participant waits for the experimenter, and nothing on the tablet goes on.
    `help_asked`: the experimenter was called and has not come yet.
    """

    session_id: str
    version: int
    language: str
    languages: list[str]
    simulated: bool
    screen: Screen
    step_index: int | None
    title: str | None
    text: str | None
    next: str | None
    administration: Administration | None
    consent: ConsentForm | None = None
    help_asked: bool = False


class Acknowledgement(BaseModel):
    """Consent given or instructions read."""

    model_config = ConfigDict(extra="forbid")

    step_index: int = Field(ge=0)


class LanguageChoice(BaseModel):
    """The language to go on in."""

    model_config = ConfigDict(extra="forbid")

    language: str = Field(max_length=8)


class HelpWish(BaseModel):
    """Whether the experimenter is wanted."""

    model_config = ConfigDict(extra="forbid")

    asked: bool
