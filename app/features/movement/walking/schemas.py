"""Request and response models of scenes, sets of walks and models of walking, in SI units."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    StringConstraints,
    WithJsonSchema,
    field_validator,
)

from app.plain_titles import PlainTitle
from app.science.walking.records import MOST_FURTHER, NAME_PATTERN, check_name, check_names

Kind = Literal["human", "synthetic"]
State = Literal["fitting", "stopped", "ready", "failed"]
Stage = Literal["waiting", "walks", "maps", "blending"]
Title = PlainTitle
Name = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=80)]
SceneKey = Annotated[str, StringConstraints(pattern=r"^[a-z0-9][a-z0-9-]{0,63}$")]
RecordId = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{32}$")]
WalkedIn = Annotated[str, StringConstraints(pattern=r"^([a-z0-9][a-z0-9-]{0,63}|open floor)$")]
"""Where somebody walked: the key of a scene, or the open floor."""
Stature = Annotated[float, Field(ge=0.5, le=2.6, allow_inf_nan=False)]
Seed = Annotated[int, Field(ge=0, le=2**31 - 1)]


def _allowed(name: str) -> str:
    check_name(name)
    return name


NumberName = Annotated[str, StringConstraints(pattern=NAME_PATTERN), AfterValidator(_allowed)]
"""What a further number of walks may be called, such as `load_kg`."""
Number = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False)]


def _numbers(count: int) -> WithJsonSchema:
    """Return the JSON schema of an array of exactly `count` numbers."""
    numbers = {"type": "array", "items": {"type": "number"}}
    return WithJsonSchema(numbers | {"minItems": count, "maxItems": count})


Point = Annotated[tuple[float, float], _numbers(2)]
Bounds = Annotated[tuple[float, float, float, float], _numbers(4)]
Quartiles = Annotated[tuple[float, float, float], _numbers(3)]
MAX_SCENE_CHARACTERS = 200_000
MAX_CAPTURES = 200
MAX_NUMBERS = 10


class _Asked(BaseModel):
    model_config = ConfigDict(extra="forbid")


class ObstacleView(BaseModel):
    """An obstacle: a convex outline, in metres."""

    name: str
    corners_m: list[Point]


class ScenePathView(BaseModel):
    """A path between two places that people are asked to walk."""

    name: str
    start: str
    goal: str


class SceneListed(BaseModel):
    """A scene in a list; `by` and `at` are null for those that come with the product."""

    key: str
    title: str
    shipped: bool
    by: str | None
    at: datetime | None


class SceneView(SceneListed):
    """A scene in full; `bounds_m` is left, near, right, far, with x to the right and y ahead."""

    about: str
    content_hash: str
    bounds_m: Bounds
    clearance_m: float
    obstacles: list[ObstacleView]
    places: dict[str, Point]
    paths: list[ScenePathView]


class NewScene(_Asked):
    """The text of a scene file to store."""

    text: Annotated[str, StringConstraints(min_length=1, max_length=MAX_SCENE_CHARACTERS)]


class Range(BaseModel):
    """Minimum, median, maximum and mean of a quantity."""

    low: float
    median: float
    high: float
    mean: float


class CensusView(BaseModel):
    """The distribution of path lengths; a length on an edge belongs to the interval above it."""

    count: int
    edges_m: list[float]
    counts: list[int]
    share_up_to: list[float]
    quartiles_m: Quartiles
    cutoff_m: float
    total_m: float


class WalksInScene(BaseModel):
    """How many walks of a set are in a scene; `key` is null for walks that name none."""

    key: str | None
    walks: int


class NumberView(BaseModel):
    """A further number of walks, such as a load: how many walks of how many people have it."""

    walks: int
    people: int
    range: Range


class WalksSummary(BaseModel):
    """The summary of a set of walks.

    `cut_by_recording`: walks during which a recording begins or ends. `missing_dependencies`:
    stature, if only some walks have it, so that no model can depend on it. `assumed`: what a table
    did not say and was assumed. `doubts`: why its unit or its rate is doubtful. `numbers`: further
    numbers that a model can depend on, by name; `changing_numbers` change during every walk, so
    that none can; `spoilt_numbers` says which columns of numbers were passed over, and why.
    """

    walks: int
    people: int
    cut_by_recording: int
    duration_s: Range
    speed_m_s: Range
    dependencies: dict[str, Range]
    missing_dependencies: list[str]
    census: CensusView
    assumed: list[str] = []
    doubts: list[str] = []
    scenes: list[WalksInScene] = []
    numbers: dict[str, NumberView] = {}
    changing_numbers: list[str] = []
    spoilt_numbers: list[str] = []


class PopulationView(BaseModel):
    """A documented population of synthetic walkers."""

    name: str
    about: str


class PopulationOrigin(_Asked):
    """Synthetic walkers: the population, how often each walks each path, and the scene.

    `scene` null: the paper's laboratory of sixteen straight and curved walks.
    """

    kind: Literal["population"] = "population"
    population: Name
    people: Annotated[int, Field(ge=2, le=60)] = 12
    repetitions: Annotated[int, Field(ge=1, le=10)] = 2
    seed: Seed = 1
    scene: SceneKey | None = None


class CapturedPerson(_Asked):
    """A capture with the person who walks in it.

    `body`: which tracked body is followed, if the capture has several. `scene`: where it was
    walked; null for the scene of the model. `numbers`: further numbers of these walks by name.
    """

    capture_id: RecordId
    subject: Name
    stature_m: Stature | None = None
    body: Name | None = None
    scene: WalkedIn | None = None
    numbers: Annotated[dict[NumberName, Number], Field(max_length=MAX_NUMBERS)] = Field(
        default_factory=dict
    )


class CapturesOrigin(_Asked):
    """Walks cut from stored captures."""

    kind: Literal["captures"] = "captures"
    captures: Annotated[list[CapturedPerson], Field(min_length=1, max_length=MAX_CAPTURES)]


class TracksOrigin(BaseModel):
    """Walks cut from an uploaded table of tracks.

    `reads_columns`: whether its columns of scenes and further numbers count; not in tables that
    were stored before they did.
    """

    kind: Literal["tracks"] = "tracks"
    file_name: str
    rate_hz: float | None = None
    metres_per_unit: float | None = None
    statures_m: dict[str, float] = Field(default_factory=dict)
    reads_columns: bool = False


class NewWalkSet(_Asked):
    """A set of walks to synthesise or to cut from captures; tables of tracks are uploaded."""

    title: Title
    origin: Annotated[PopulationOrigin | CapturesOrigin, Field(discriminator="kind")]


class WalkSetView(BaseModel):
    """A set of walks; `kind` says whether they are of people or synthetic."""

    id: str
    title: str
    kind: Kind
    origin: Annotated[PopulationOrigin | CapturesOrigin | TracksOrigin, Field(discriminator="kind")]
    content_hash: str | None
    summary: WalksSummary
    by: str
    at: datetime


class FitChoice(_Asked):
    """Options of a fit; the defaults are the paper's, except that the reading is chosen.

    `steps`: values of each steering parameter; a map has their cube as its size. `k`: neighbours.
    `entries`: of the blending space, blends included. `reading`: how deviations are converted to
    suitability; "chosen" selects it by predicting people who were left out. `depends_on`: further
    numbers of the set on which the model depends, besides length, turning and stature.
    """

    steps: Annotated[int, Field(ge=3, le=12)] = 10
    k: Annotated[int, Field(ge=1, le=1000)] = 100
    entries: Annotated[int, Field(ge=10, le=20_000)] = 5000
    reading: Literal["chosen", "paper", "time-aware"] = "chosen"
    seed: Seed = 1
    depends_on: Annotated[list[NumberName], Field(max_length=MOST_FURTHER)] = Field(
        default_factory=list
    )


class NewModel(_Asked):
    """A model to fit; `scene` is that of walks that name none, null for the open floor."""

    title: Title
    walk_set_id: RecordId
    scene: SceneKey | None = None
    options: FitChoice = Field(default_factory=FitChoice)

    @field_validator("options")
    @classmethod
    def _each_once(cls, options: FitChoice) -> FitChoice:
        """Orders are checked, and not all choices: an earlier one may be stored that failed."""
        check_names(options.depends_on)
        return options
