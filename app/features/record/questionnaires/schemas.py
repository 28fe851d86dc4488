"""Request and response models for forms, answers and scores."""

from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from app.platform.client_time import ClientTime

Whole = Annotated[int, Field(ge=-(2**53), le=2**53)]
ItemKey = Annotated[str, Field(max_length=80)]
AnswerValue = bool | Whole | FiniteFloat | str | None


class Administration(BaseModel):
    """A form to be filled in now: the exact instrument, and the order of its items."""

    key: str
    step_index: int
    instrument: dict[str, Any]
    item_order: list[str]
    seed: int
    language: str
    languages: list[str]


AnsweredAfter = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
"""Seconds from the opening of a form."""


class ItemTrace(BaseModel):
    """The timing of the answer to one item, and the number of its changes.

    `response_s`: seconds from when the item was the next to be answered (its page was shown, or
    another item of the page was answered) to its first answer, if one was given; for typed answers,
    to the end of the first typing. `changes`: how often the answer was changed afterwards; for
    typed answers, each return to the field counts once.
    """

    model_config = ConfigDict(extra="forbid")

    response_s: FiniteFloat = Field(ge=0.0, le=1e6)
    changes: int = Field(ge=0, le=100_000)


class SubmissionRequest(BaseModel):
    """A filled-in form. It can be resent any number of times with the same `idempotency_key`.

    `timings`: seconds from the opening of the form to the last change of each answer.
    """

    model_config = ConfigDict(extra="forbid")

    idempotency_key: str = Field(min_length=8, max_length=64)
    administration: str = Field(max_length=120)
    answers: dict[str, AnswerValue] = Field(max_length=200)
    shown_order: list[str] = Field(max_length=200)
    seed: int = Field(ge=0, lt=2**63)
    language: str = Field(max_length=8)
    started_at_utc: ClientTime | None = None
    timings: dict[str, AnsweredAfter] = Field(default_factory=dict, max_length=200)
    item_traces: dict[ItemKey, ItemTrace] | None = Field(default=None, max_length=200)


class Receipt(BaseModel):
    """Confirmation that a form is stored; `duplicate` if it was already stored before."""

    receipt_id: str
    stored_at: datetime
    duplicate: bool


class ScoreView(BaseModel):
    """A score with its label and the range that its instrument states."""

    key: str
    label: str
    value: float | None
    minimum: float | None
    maximum: float | None


class AnswerHint(BaseModel):
    """A hint about a form's answers for the operator; see the module `hints`.

    alike: all `items` ratings on one scale are `value`. fast: half of the `items` ratings took less
    than `seconds` each. left_out: `items` questions have no answer.
    """

    kind: Literal["alike", "fast", "left_out"]
    items: int
    value: float | None = None
    seconds: float | None = None


class StoredScores(BaseModel):
    """The scores of a stored form: as numbers by key, and with labels and ranges for display."""

    administration: str
    step_index: int
    instrument: str
    mode: Literal["tablet", "headset", "operator"]
    scores: dict[str, float | None]
    score_views: list[ScoreView]
    hints: list[AnswerHint] = []


class CorrectionView(BaseModel):
    """A correction of one answer. `previous` is the value before it; null means "left out"."""

    item: str
    previous: AnswerValue
    value: AnswerValue
    reason: str
    by: str
    at: datetime


class StoredAnswers(StoredScores):
    """A stored form with its current answers: as given, unless they were corrected later.

    `corrections`: oldest first; the first one's `previous` is the answer as given. `definition`:
    the exact instrument, for the wording.
    """

    submission_id: str
    language: str
    shown_order: list[str]
    submitted_at: datetime
    answers: dict[str, AnswerValue]
    corrections: list[CorrectionView]
    definition: dict[str, Any]
