"""Request and response models of studies and of drafts, which are not stored."""

from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from app.plain_titles import plain
from app.platform.config_problems import ProblemView
from app.protocol import AvatarChanges, StepKind

MAX_YAML_CHARACTERS = 262_144
MAX_CHANGES = 200
Part = Annotated[str, Field(max_length=200)] | Annotated[int, Field(ge=0, lt=100_000)]


class StudyFile(BaseModel):
    """The text of a study file, in YAML."""

    model_config = ConfigDict(extra="forbid")

    yaml: str = Field(max_length=MAX_YAML_CHARACTERS)


class NewVersion(StudyFile):
    """A new version of a study; `based_on`: the newest version when its editing began.

    Without it nothing is checked, as for a file that no editor has opened.
    """

    based_on: int | None = Field(default=None, ge=1)


class VersionView(BaseModel):
    """One version of a study, without its content."""

    number: int
    content_hash: str
    created_at: datetime
    frozen_at: datetime | None


class StudySummary(BaseModel):
    """The summary of a study, for the list of studies.

    `title` and `description` are in English if the study has it; `titles` and `descriptions` in
    every language that it has.
    """

    key: str
    title: str
    titles: dict[str, str]
    description: str
    descriptions: dict[str, str]
    version: int
    content_hash: str
    frozen: bool
    session_counts: dict[str, int]
    created_at: datetime
    archived_at: datetime | None


class StudyView(StudySummary):
    """A study with its complete newest version; operators of a blinded one get no protocol.

    `phases`: how many timed phases a visit has: practice, free movement and tasks.
    `planned_minutes` is what the protocol sets for each visit; `minutes` adds an estimate for forms
    and texts.
    """

    languages: list[str]
    phases: int
    planned_minutes: float
    minutes: float
    versions: list[VersionView]
    protocol: dict[str, Any] | None
    yaml: str | None


class TemplateView(BaseModel):
    """A study to use as a template; `key` names the file, not the study in it.

    `needs_feet`: a task is done with the feet, which the headset has to measure.
    """

    key: str
    title: dict[str, str]
    description: dict[str, str]
    needs_feet: bool
    yaml: str


class ChangeRequest(BaseModel):
    """One change of a study file; see `app.protocol.editing.Change`."""

    model_config = ConfigDict(extra="forbid")

    path: list[Part] = Field(min_length=1, max_length=12)
    action: Literal["set", "remove", "insert", "move"] = "set"
    value: Any = None
    to: int = Field(default=0, ge=0, lt=100_000)


class EditRequest(BaseModel):
    """Changes of a file's text from the editor's form, applied one after the other."""

    model_config = ConfigDict(extra="forbid")

    yaml: str = Field(max_length=MAX_YAML_CHARACTERS)
    changes: list[ChangeRequest] = Field(min_length=1, max_length=MAX_CHANGES)


class EditedFile(BaseModel):
    """The text after the changes, with comments and layout kept."""

    yaml: str


class StudyFigures(BaseModel):
    """The summary of a study: the size of its design and the length of a visit.

    `slots`: participants until the initial ledger is full. `planned_minutes` is what the protocol
    sets for each visit; `minutes` adds an estimate for forms and texts.
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
    """The check of a file: whether it is valid, with every problem and its place.

    `tree`: the values of the file, whenever it can be parsed, so that a form can show them while
    there are problems. `lines`: the line of each value, by its path.
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
    """A dry run of one participant: by slot of the ledger, or by the index of the order."""

    model_config = ConfigDict(extra="forbid")

    yaml: str = Field(max_length=MAX_YAML_CHARACTERS)
    slot: int | None = Field(default=None, ge=0, lt=1_000_000)
    sequence_index: int | None = Field(default=None, ge=0, lt=100_000)
    language: str = Field(default="en", max_length=8)


class TimelineStep(BaseModel):
    """A step of the visit; times in seconds from its start, `estimated` if the study sets none.

    `text` and `title` are in the requested language. `condition_label` is that of the study.
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
    avatar_changes: AvatarChanges | None = None


class EstimateRule(BaseModel):
    """The rule by which the duration of steps is estimated if the study sets none, in seconds."""

    reading_words_per_s: float
    opening_s: float
    by_hand_s: dict[str, float]
    item_s: dict[str, float]


class TimelineView(BaseModel):
    """The dry run of one participant's visit; `replicate` counts from 1.

    `bodies`: the body worn at each of the latencies, null for that of the configuration; null
    instead of the list where latencies tell the conditions apart.
    """

    slot: int
    slots: int
    replicate: int
    sequence: list[str]
    latencies_ms: list[float]
    bodies: list[str | None] | None = None
    steps: list[TimelineStep]
    planned_s: float
    total_s: float
    language: str
    languages: list[str]
    rule: EstimateRule


class DifferenceView(BaseModel):
    """One difference between two study files; `before` or `after` is null if there is no value."""

    path: str
    kind: Literal["added", "removed", "changed"]
    before: Any = None
    after: Any = None


class InstrumentChange(BaseModel):
    """An instrument whose wording differs: content hashes, null if it is not used."""

    key: str
    before: str | None
    after: str | None


class StudyDiff(BaseModel):
    """The differences between two versions, or between one and a draft (`target` is then null).

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
    """The text of a draft, to compare with the newest version."""

    model_config = ConfigDict(extra="forbid")

    yaml: str = Field(max_length=MAX_YAML_CHARACTERS)


class DuplicateRequest(BaseModel):
    """The key of a copy of a study, and optionally its title by language."""

    model_config = ConfigDict(extra="forbid")

    key: str = Field(min_length=1, max_length=80)
    title: (
        dict[
            Annotated[str, Field(max_length=8)],
            Annotated[str, Field(max_length=200), AfterValidator(plain)],
        ]
        | None
    ) = Field(default=None, max_length=20)


class VersionDetail(BaseModel):
    """One version of a study in full."""

    number: int
    content_hash: str
    design_hash: str
    yaml: str
    protocol: dict[str, Any]
    instruments: dict[str, str]
