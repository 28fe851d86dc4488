"""Request and response models of instruments."""

from datetime import datetime
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from app.platform.config_problems import ProblemView

MAX_YAML_CHARACTERS = 262_144
Whole = Annotated[int, Field(ge=-(2**53), le=2**53)]
TriedAnswer = bool | Whole | FiniteFloat | Annotated[str, Field(max_length=10_000)] | None


class InstrumentFile(BaseModel):
    """The text of an instrument file, in YAML."""

    model_config = ConfigDict(extra="forbid")

    yaml: str = Field(max_length=MAX_YAML_CHARACTERS)


class TryRequest(BaseModel):
    """Answers to score, by the instrument in `yaml` or by the newest stored one with `key`."""

    model_config = ConfigDict(extra="forbid")

    yaml: str | None = Field(default=None, max_length=MAX_YAML_CHARACTERS)
    key: str | None = Field(default=None, max_length=80)
    answers: dict[Annotated[str, Field(max_length=80)], TriedAnswer] = Field(max_length=500)


class FormulaView(BaseModel):
    """A score with its formula and the range that its author states."""

    key: str
    label: dict[str, str]
    formula: str
    minimum: float | None
    maximum: float | None
    note: str | None


class ProvenanceView(BaseModel):
    """The origin of an instrument, and how far it was verified."""

    source: str
    licence: str
    verified: str
    notes: list[str]


class InstrumentSummary(BaseModel):
    """The newest version of an instrument in the library.

    `version` is the number in the file; `stored_versions` counts the contents stored under the key.
    `minutes` is an estimate of how long filling it in takes. `used_by`: keys of studies whose
    newest version uses this wording; `used_by_older`: those that use an older one.
    """

    key: str
    title: dict[str, str]
    version: int
    languages: list[str]
    items: int
    scored_items: int
    scores: list[FormulaView]
    minutes: float
    provenance: ProvenanceView
    content_hash: str
    created_at: datetime
    stored_versions: int
    used_by: list[str]
    used_by_older: list[str]


class InstrumentVersionView(BaseModel):
    """One stored content of an instrument, with the studies that use it."""

    version: int
    content_hash: str
    created_at: datetime
    yaml: str
    used_by: list[str]


class InstrumentDetail(InstrumentSummary):
    """An instrument in full; `versions` are ordered from the oldest to the newest.

    `preview`: a form of it, in the format in which tablets get their forms.
    """

    yaml: str
    preview: "Preview"
    versions: list[InstrumentVersionView]


class Preview(BaseModel):
    """An instrument as a form: its content, and one possible order of its items."""

    instrument: dict[str, Any]
    item_order: list[str]
    seed: int
    languages: list[str]
    recode: str | None
    scores: list[FormulaView]
    minutes: float


class InstrumentCheck(BaseModel):
    """The check of a file: every problem with its place, or a preview if it is valid.

    `known`: the same content is stored already. `replaces`: other contents of this key are stored.
    """

    ok: bool
    key: str | None = None
    content_hash: str | None = None
    known: bool = False
    replaces: bool = False
    problems: list[ProblemView] = []
    preview: Preview | None = None


class ItemStep(BaseModel):
    """The value of an item in the scoring: as answered, and as the formulas use it."""

    item: str
    raw: float | None
    recoded: float | None
    scored: bool


class ScoreStep(BaseModel):
    """A score: its formula, the formula with the values inserted, and the result.

    `missing`: unanswered items because of which the score has no value.
    """

    key: str
    label: dict[str, str]
    formula: str
    filled_in: str
    value: float | None
    minimum: float | None
    maximum: float | None
    missing: list[str]


class TryResult(BaseModel):
    """The scoring of one completed form, step by step; `problems` are invalid answers."""

    recode: str | None
    items: list[ItemStep]
    scores: list[ScoreStep]
    problems: list["AnswerProblemView"]


class AnswerProblemView(BaseModel):
    """The reason why an answer is invalid."""

    item: str
    message: str
    remedy: str
