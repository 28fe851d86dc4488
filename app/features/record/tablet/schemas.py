"""Request and response models of the tablet endpoints."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from app.features.record.questionnaires import Administration, Receipt
from app.features.record.sessions import ConsentForm

Screen = Literal[
    "waiting",
    "held",
    "refused",
    "consent",
    "instructions",
    "form",
    "in_headset",
    "oral",
    "finished",
]


class TabletState(BaseModel):
    """The tablet's current screen; `next` is the title of the next step in the chosen language.

    `in_headset`, `oral`: the form that is due is answered inside the headset, or aloud. `held`: the
    participant waits for the experimenter, and the tablet cannot continue. `refused`:
    the participant refuses to take part and the experimenter knows; `is_refused` is also true if
    the session has ended since. `is_own_text`: `text` belongs to the step, so the step's title is
    shown above it; otherwise it is the study's waiting text. `help_asked`, `question_asked`: the
    experimenter was called and has not come yet.
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


class FormStored(Receipt):
    """The receipt of a form that the tablet sent, with the screen that it should show next."""

    state: TabletState


class Acknowledgement(BaseModel):
    """A request to complete a step that was read on the tablet."""

    model_config = ConfigDict(extra="forbid")

    step_index: int = Field(ge=0)


class LanguageChoice(BaseModel):
    """A request to switch to another language."""

    model_config = ConfigDict(extra="forbid")

    language: str = Field(max_length=8)


class HelpWish(BaseModel):
    """A request to call the experimenter, or to cancel the call.

    The call is for any reason or with a question.
    """

    model_config = ConfigDict(extra="forbid")

    asked: bool


class RefusalWish(BaseModel):
    """A request to refuse the consent of a step, or to take the refusal back.

    `wish_id` is generated when the button is pressed, so the request can be resent any number of
    times, even late.
    """

    model_config = ConfigDict(extra="forbid")

    wish_id: str = Field(min_length=8, max_length=36)
    step_index: int = Field(ge=0, lt=1000)
    refused: bool


class TabletPaired(BaseModel):
    """The screen of the requesting tablet; null if the tablet is not paired."""

    state: TabletState | None
