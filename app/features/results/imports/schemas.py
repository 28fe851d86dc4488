"""Request and response models of imported answers, with the mapping of a file."""

from datetime import date, datetime
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, model_validator

MAX_TEXT = 1_500_000
MAX_SETS = 24
Name = Annotated[str, StringConstraints(min_length=1, max_length=200)]
Word = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=200)]
Short = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=80)]
Reason = Annotated[str, StringConstraints(strip_whitespace=True, min_length=3, max_length=2000)]
DateOrder = Literal["iso", "day_first", "month_first"]


class _Body(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class ColumnSet(_Body):
    """The columns of one form, item -> column; `condition`: that of all forms in these columns."""

    items: Annotated[dict[Short, Name], Field(min_length=1, max_length=200)]
    condition: Short | None = None


class Mapping(_Body):
    """The meaning of the columns and words of a file.

    A tidy file has one set of columns and a column of conditions; a wide one has a set of columns
    for each condition. `conditions`: word of the file -> key of a condition of the study. `words`:
    answer in words -> number. Numbers x become multiply * x + add, for scales that start at another
    number. `turned`: items that the file has already reverse-scored; they are reversed back,
    because the instrument's formulas reverse them.
    """

    instrument: Short
    participant: Name
    condition: Name | None = None
    date: Name | None = None
    date_order: DateOrder = "iso"
    sets: Annotated[list[ColumnSet], Field(min_length=1, max_length=MAX_SETS)]
    conditions: Annotated[dict[Short, Short], Field(max_length=100)] = {}
    words: Annotated[dict[Word, float], Field(max_length=200)] = {}
    multiply: float = 1.0
    add: float = 0.0
    turned: Annotated[list[Short], Field(max_length=200)] = []
    header_rows: Annotated[int, Field(ge=1, le=5)] = 1

    @model_validator(mode="after")
    def _require_one_source_of_conditions(self) -> Self:
        conditions = [one.condition for one in self.sets]
        if self.condition is not None and any(conditions):
            raise ValueError(
                "choose a column with the conditions, or a condition for each set of columns"
            )
        if len(self.sets) > 1 and (None in conditions or len(set(conditions)) < len(conditions)):
            raise ValueError("each of several sets of columns needs a condition of its own")
        if self.multiply == 0.0:
            raise ValueError("multiply cannot be 0")
        return self


class LookRequest(_Body):
    """A file to preview."""

    text: Annotated[str, StringConstraints(min_length=1, max_length=MAX_TEXT)]
    instrument: Short | None = None
    header_rows: Annotated[int | None, Field(ge=1, le=5)] = None


class CheckRequest(_Body):
    """A file and its mapping, to be checked."""

    text: Annotated[str, StringConstraints(min_length=1, max_length=MAX_TEXT)]
    mapping: Mapping


class ImportRequest(CheckRequest):
    """A file and its mapping, to be imported."""

    file_name: Name


class UndoRequest(_Body):
    """The reason for undoing an import."""

    reason: Reason


class EraseImportedRequest(_Body):
    """The participant whose imported answers are erased; `confirm` is the code, typed again."""

    participant_code: Short
    confirm: Short


class ErasedImported(BaseModel):
    """The number of imported forms that were erased."""

    forms: int


class FileColumn(BaseModel):
    """A column of the file: its name, the question below the name, and examples of its values."""

    name: str
    label: str
    filled: int
    distinct: int
    examples: list[str]


class ImportView(BaseModel):
    """An import; one that was undone has no forms."""

    id: str
    file_name: str
    content_hash: str
    instrument: str
    instrument_version: int
    forms: int
    participants: int
    imported_at: datetime
    imported_by: str
    undone_at: datetime | None
    undone_by: str | None
    undone_reason: str | None
    mapping: Mapping


class OfferedItem(_Body):
    """An item of an offered instrument: the column it was made from, and its words."""

    key: Short
    column: Name
    text: Annotated[str, StringConstraints(min_length=1, max_length=1000)]


class OfferedInstrument(_Body):
    """An instrument of the lab's own for columns of no known one; a person checks and edits it.

    `guessed_minimum`, `guessed_maximum`: the end of the scale that was guessed from the answers;
    None once a person has confirmed it. An end that differs from its guess was set by a person.
    `seen`: the answers in the file. `doubts`: what speaks against the guess. `labels`: the words of
    the scale, from lowest to highest, if the answers are words.
    """

    key: Short
    title: Short
    minimum: Annotated[int, Field(ge=-1000, le=1000)]
    maximum: Annotated[int, Field(ge=-1000, le=1000)]
    guessed_minimum: int | None = None
    guessed_maximum: int | None = None
    seen: Annotated[str, StringConstraints(max_length=2000)] = ""
    doubts: Annotated[list[Word], Field(max_length=10)] = []
    labels: Annotated[list[Short], Field(max_length=101)] = []
    items: Annotated[list[OfferedItem], Field(min_length=1, max_length=200)]


class LookedInstrument(BaseModel):
    """The key of the instrument that was made from an offer."""

    instrument: str


class LeftOutColumn(BaseModel):
    """A column that would not be imported, and how many of its cells have a value.

    `reason`: why it is not offered as an item, if it looks like one; absent otherwise.
    """

    name: str
    filled: int
    reason: Annotated[str | None, Field(exclude_if=lambda value: value is None)] = None


class LookView(BaseModel):
    """The preview of a file, and a proposed mapping.

    `remembered`: the proposal is the mapping of an earlier import. `proposal` is None if no column
    was identified for the participants or for any item. `offer`: an instrument for columns that
    look like answers and that the proposal does not read. `left_out`: all other columns that it
    does not read.
    """

    separator: str
    header_rows: int
    rows: int
    columns: list[FileColumn]
    first_rows: list[list[str]]
    instrument: str
    proposal: Mapping | None
    remembered: bool
    words: list[str]
    condition_words: list[str]
    same_file: ImportView | None
    offer: OfferedInstrument | None
    left_out: list[LeftOutColumn]


class CellProblem(BaseModel):
    """A problem that prevents a cell of the file from being imported."""

    line: int
    column: str
    value: str
    message: str
    remedy: str


class Shift(BaseModel):
    """A conversion, multiply * x + add, by which the numbers x of the file would fit the scale."""

    multiply: float
    add: float
    why: str


class FormPreview(BaseModel):
    """One form of the previewed file, as it would be stored."""

    line: int
    participant_code: str
    condition: str
    in_study: bool
    answered_on: date | None
    answers: dict[str, float | str | None]
    scores: dict[str, float | None]


class ConditionCount(BaseModel):
    """The number of forms in a condition of the file; `in_study`: the study has this condition."""

    condition: str
    in_study: bool
    forms: int


class CheckView(BaseModel):
    """A preview of an import's result; nothing was stored. An import with problems is rejected.

    `reversed_items`: those that the instrument's formulas reverse. `notes`: points to check.
    `left_out`: columns that look like answers and are not imported.
    """

    forms: int
    participants: int
    skipped_rows: int
    missing_answers: int
    conditions: list[ConditionCount]
    problems: list[CellProblem]
    n_problems: int
    unknown_words: list[str]
    shift: Shift | None
    reversed_items: list[str]
    notes: list[str]
    left_out: list[LeftOutColumn]
    first_forms: list[FormPreview]


class ConditionMean(BaseModel):
    """A score in one condition, over participants; `low` and `high`: 95 % interval of the mean."""

    condition: str
    n: int
    mean: float
    sd: float | None
    low: float | None
    high: float | None


class PairView(BaseModel):
    """The comparison of two conditions.

    `degenerate`: why the test says nothing about them; it then has no figures.
    """

    a: str
    b: str
    n: int
    w: float | None
    p: float | None
    p_holm: float | None
    rank_biserial: float | None
    degenerate: str | None


class ScoreResult(BaseModel):
    """The results of a score; `test` is a sentence for a paper, or `why_not` is the reason."""

    score: str
    title: str
    means: list[ConditionMean]
    n: int
    left_out: list[str]
    test: str | None
    why_not: str | None
    pairs: list[PairView]


class ImportDetail(BaseModel):
    """An import with the results of its scores."""

    view: ImportView
    results: list[ScoreResult]
