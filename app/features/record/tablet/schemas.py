"""The tablet's screens."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from app.features.record.questionnaires import Administration
from app.features.record.sessions import ConsentForm

Screen = Literal["waiting", "held", "refused", "consent", "instructions", "form", "finished"]


class TabletState(BaseModel):
    """What the tablet shows now; `next` says what comes next, in the participant's language.

    `held`: the participant waits for the experimenter, and nothing on the tablet goes on.
    `refused`: the participant does not want to take part and the experimenter knows; `is_refused`
    says so also where the session has ended since.
    `is_own_text`: `text` belongs to the step, so its title stands above it; else it is the study's
    waiting text.
    `help_asked`, `question_asked`: the experimenter was called and has not come yet.
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
    is_own_text: bool = False
    next: str | None
    administration: Administration | None
    consent: ConsentForm | None = None
    help_asked: bool = False
    question_asked: bool = False
    is_refused: bool = False


class Acknowledgement(BaseModel):
    """Consent given or instructions read."""

    model_config = ConfigDict(extra="forbid")

    step_index: int = Field(ge=0)


class LanguageChoice(BaseModel):
    """The language to go on in."""

    model_config = ConfigDict(extra="forbid")

    language: str = Field(max_length=8)


class HelpWish(BaseModel):
    """Whether the experimenter is wanted, for any reason or to answer a question."""

    model_config = ConfigDict(extra="forbid")

    asked: bool


class RefusalWish(BaseModel):
    """Whether the participant refuses the consent of a step, or takes the refusal back.

    `wish_id` is made at the press: the same wish may come any number of times, also late.
    """

    model_config = ConfigDict(extra="forbid")

    wish_id: str = Field(min_length=8, max_length=36)
    step_index: int = Field(ge=0, lt=1000)
    refused: bool


class TabletPaired(BaseModel):
    """What the tablet that asks is to show; null where it is not paired."""

    state: TabletState | None
