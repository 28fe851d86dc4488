"""Studies as pages see them, and those that are being written, of which nothing is stored."""

from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from app.platform.config_problems import ProblemView
from app.protocol import StepKind

MAX_YAML_CHARACTERS = 262_144
MAX_CHANGES = 200
Part = Annotated[str, Field(max_length=200)] | Annotated[int, Field(ge=0, lt=100_000)]


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
    """A study with its newest version in full; an operator of a blinded one gets no protocol.

    `phases`: how many timed phases a visit has: practice, free movement and tasks.
    `planned_minutes` is what the protocol sets for each visit; `minutes` adds our rough estimate of
    forms and texts.
    """

    languages: list[str]
    phases: int
    planned_minutes: float
    minutes: float
    versions: list[VersionView]
    protocol: dict[str, Any] | None
    yaml: str | None


class TemplateView(BaseModel):
    """A study to begin with. `key` names the file, not the study in it."""

    key: str
    title: dict[str, str]
    description: dict[str, str]
    yaml: str


class ChangeRequest(BaseModel):
    """One change; see `app.protocol.editing.Change`."""

    model_config = ConfigDict(extra="forbid")

    path: list[Part] = Field(min_length=1, max_length=12)
    action: Literal["set", "remove", "insert", "move"] = "set"
    value: Any = None
    to: int = Field(default=0, ge=0, lt=100_000)


class EditRequest(BaseModel):
    """Changes of a form to a file's text, done one after the other."""

    model_config = ConfigDict(extra="forbid")

    yaml: str = Field(max_length=MAX_YAML_CHARACTERS)
    changes: list[ChangeRequest] = Field(min_length=1, max_length=MAX_CHANGES)


class EditedFile(BaseModel):
    """The text after the changes, comments and layout kept."""

    yaml: str


class StudyFigures(BaseModel):
    """What a study asks for: the size of its design and the length of a visit.

    `slots`: participants until the initial ledger is full. `planned_minutes` is what the protocol
    sets for each visit; `minutes` adds our rough estimate of forms and texts.
    """

    conditions: int
    orders: int
    replicates: int
    slots: int
    blocks: int
    administrations: int
    instruments: list[str]
    planned_minutes: float
    minutes: float


class CheckResult(BaseModel):
    """Whether a file can be used, with every problem and its place.

    `tree`: the values of the file as they stand, whenever it can be read at all, so that a form can
    show them while there are problems. `lines`: where each value stands, by its path.
    """

    ok: bool
    key: str | None = None
    content_hash: str | None = None
    design_hash: str | None = None
    summary: StudyFigures | None = None
    problems: list[ProblemView] = []
    tree: dict[str, Any] | None = None
    lines: dict[str, int] = {}


class TimelineRequest(BaseModel):
    """A dry run of one participant: by slot of the ledger, or by the order's place in the list."""

    model_config = ConfigDict(extra="forbid")

    yaml: str = Field(max_length=MAX_YAML_CHARACTERS)
    slot: int | None = Field(default=None, ge=0, lt=1_000_000)
    sequence_index: int | None = Field(default=None, ge=0, lt=100_000)
    language: str = Field(default="en", max_length=8)


class TimelineStep(BaseModel):
    """A step of the visit; times in seconds from its begin. `estimated`: by a rule of ours.

    `text` and `title` are in the language asked for. `condition_label` is that of the study.
    """

    index: int
    key: str
    kind: StepKind
    title: str
    block: int | None
    condition: str | None
    condition_label: str | None
    latency_ms: float | None
    limb: str | None
    instrument: str | None
    preparation_s: float | None
    duration_s: float | None
    freeze_s: float | None
    start_s: float
    length_s: float
    estimated: bool
    text: str | None


class EstimateRule(BaseModel):
    """The rule by which steps without a set duration are estimated; all in seconds."""

    reading_words_per_s: float
    opening_s: float
    by_hand_s: dict[str, float]
    item_s: dict[str, float]


class TimelineView(BaseModel):
    """One participant's visit. `replicate` counts from 1."""

    slot: int
    slots: int
    replicate: int
    sequence: list[str]
    latencies_ms: list[float]
    steps: list[TimelineStep]
    planned_s: float
    total_s: float
    language: str
    languages: list[str]
    rule: EstimateRule


class DifferenceView(BaseModel):
    """One place that differs; `before` or `after` is null where it was not there."""

    path: str
    kind: Literal["added", "removed", "changed"]
    before: Any = None
    after: Any = None


class InstrumentChange(BaseModel):
    """An instrument whose wording differs: content hashes, null where it is not asked."""

    key: str
    before: str | None
    after: str | None


class StudyDiff(BaseModel):
    """What differs between two versions, or between one and a draft (`to` is then null).

    `same`: the content is the same, whatever the layout. `new_ledger`: conditions or orders differ,
    so that new sessions begin a ledger of their own. `under_way`: sessions that are planned or
    running and keep the version they began with. `text`: the files in unified format.
    """

    source: int
    target: int | None
    same: bool
    new_ledger: bool
    under_way: int
    changes: list[DifferenceView]
    instruments: list[InstrumentChange]
    text: str


class DraftFile(BaseModel):
    """A draft to compare with the newest version."""

    model_config = ConfigDict(extra="forbid")

    yaml: str = Field(max_length=MAX_YAML_CHARACTERS)


class DuplicateRequest(BaseModel):
    """A copy of a study under another key, with another title if wished, by language."""

    model_config = ConfigDict(extra="forbid")

    key: str = Field(min_length=1, max_length=80)
    title: (
        dict[Annotated[str, Field(max_length=8)], Annotated[str, Field(max_length=200)]] | None
    ) = Field(default=None, max_length=20)


class VersionDetail(BaseModel):
    """One version in full."""

    number: int
    content_hash: str
    design_hash: str
    yaml: str
    protocol: dict[str, Any]
    instruments: dict[str, str]
