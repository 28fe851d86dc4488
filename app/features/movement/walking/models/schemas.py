"""Request and response models of fitted models and their predictions, in SI units."""

from datetime import datetime
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from app.features.movement.walking.schemas import (
    CensusView,
    FitChoice,
    Kind,
    Number,
    NumberName,
    Point,
    Range,
    SceneKey,
    Seed,
    Stage,
    State,
    Stature,
    WalksInScene,
)
from app.science.walking.evaluation import reason_for_no_interval
from app.science.walking.records import MOST_FURTHER

Coordinate = Annotated[float, Field(ge=-1000.0, le=1000.0, allow_inf_nan=False)]
Value = Number


class ProgressView(BaseModel):
    """The progress of a fit; `maps_total` is 0 while it is unknown."""

    stage: Stage
    maps: int
    maps_total: int


class ReadingView(BaseModel):
    """The options by which deviations are converted to suitability."""

    normalisation: Literal["max", "min-max"]
    power: float
    threshold: float
    time_constant_s: float | None


class ReadingScoreView(BaseModel):
    """A reading with its mean error (CRPS in seconds) in predicting people who were left out."""

    reading: ReadingView
    crps_s: float


class ParameterView(BaseModel):
    """A steering parameter, its bounds, and its values on the grid."""

    name: str
    unit: str
    low: float
    high: float
    values: list[float]


class LeftOutView(BaseModel):
    """Errors of predicted suitability in percent of its range, over entries that were left out."""

    mean_percent: float
    sd_percent: float
    entries: int


class LeftOutFigures(BaseModel):
    """Errors of predicting left-out entries, by what was left out.

    `neighbours`: an entry, predicted from its neighbours. `nodes`: a node, interpolated by radial
    basis functions. `people`: a person, predicted from other people.
    """

    neighbours: LeftOutView
    nodes: LeftOutView
    people: LeftOutView


class PredictedView(BaseModel):
    """How well travel times of people who were left out are predicted, by one method.

    `method`: mixed, the model of this product, or a baseline that learnt from the same walks:
    constant speed, line, log-log, and mixed without each further number. `crps_less_s`: by how
    much the error of mixed is smaller, and the 95 % interval of that over people; its ends are null
    if `no_interval` says why there is none, as in `walk evaluate`. Coverages are shares: .5 and .9
    if intervals are right.
    """

    method: str
    crps_s: float
    crps_less_s: tuple[float, float | None, float | None]
    coverage_50: float
    coverage_90: float
    walks: int
    people: int
    no_interval: str | None = None

    @model_validator(mode="after")
    def _hide_interval_of_too_few(self) -> Self:
        """Models that were fitted earlier have an interval stored, however few their people."""
        self.no_interval = reason_for_no_interval(self.people)
        if self.no_interval is not None:
            self.crps_less_s = (self.crps_less_s[0], None, None)
        return self


class LeftOutWalk(BaseModel):
    """A walk that a model does not use, and why."""

    walk: str
    reason: str


class ModelSummary(BaseModel):
    """The summary of a fitted model; `model_hash` is the hash in its file.

    `predicted` is null for models fitted before it was computed, and empty for fewer than three
    people. `left_out_walks`: walks that lack one of the numbers on which the model depends; the
    others are counted in `scenes`.
    """

    model_hash: str
    walks: int
    people: int
    duration_s: Range
    dependencies: dict[str, Range]
    parameters: list[ParameterView]
    reading: ReadingView
    readings: list[ReadingScoreView]
    entries: int
    k: int
    static_vector: list[float]
    left_out: LeftOutFigures
    predicted: list[PredictedView] | None = None
    census: CensusView
    left_out_walks: list[LeftOutWalk] = []
    scenes: list[WalksInScene] = []


class WalkedScene(BaseModel):
    """A scene in which walks of a model took place, and the hash of its file at the order.

    `key` is null for walks that name none, which were planned in the model's scene; for these and
    for the open floor `content_hash` is null.
    """

    key: str | None
    title: str
    content_hash: str | None
    walks: int


class FittedOn(BaseModel):
    """The set of walks that a model was fitted to, with its title at the time of the order.

    `id` is null if the set was deleted. `scenes` is empty for models ordered before walks named
    theirs.
    """

    id: str | None
    title: str
    origin: Literal["population", "captures", "tracks"]
    scenes: list[WalkedScene] = []


class SceneNamed(BaseModel):
    """The scene in which walks that name none were planned, and the hash of its file then."""

    key: str
    title: str
    content_hash: str


class ModelListed(BaseModel):
    """A walking model in a list; `progress` while it is fitted, `trouble` if that failed."""

    id: str
    title: str
    kind: Kind
    state: State
    progress: ProgressView | None
    trouble: str | None
    walk_set: FittedOn
    walks: int | None
    people: int | None
    by: str
    at: datetime
    ended_at: datetime | None


class ModelView(ModelListed):
    """A walking model in full; `content_hash` and `size_bytes` are those of its file."""

    scene: SceneNamed | None
    options: FitChoice
    content_hash: str | None
    size_bytes: int | None
    summary: ModelSummary | None


class PathAsked(BaseModel):
    """A path: drawn, or planned between its first and its last point.

    `scene` null: the open floor. `points_m`: x to the right, y ahead.
    """

    model_config = ConfigDict(extra="forbid")

    scene: SceneKey | None = None
    points_m: Annotated[list[tuple[Coordinate, Coordinate]], Field(min_length=2, max_length=200)]
    planned: bool = False

    @model_validator(mode="after")
    def _two_ends(self) -> "PathAsked":
        if self.planned and self.scene is None:
            raise ValueError("a path can only be planned in a scene: name one, or draw the path")
        return self


class PathView(BaseModel):
    """A path on the floor and its length in metres."""

    points_m: list[Point]
    length_m: float


class PredictionAsked(PathAsked):
    """A path for which durations are predicted.

    `stature_m` null: the mean of the model's people. `others`: the further numbers on which the
    model depends, by name; the mean of its walks for one that is not given. `count` walks are drawn
    with `seed`, and the same seed gives the same walks; `shown` of them are followed along the
    path.
    """

    stature_m: Stature | None = None
    others: Annotated[dict[NumberName, Number], Field(max_length=MOST_FURTHER)] = Field(
        default_factory=dict
    )
    count: Annotated[int, Field(ge=20, le=5000)] = 500
    seed: Seed = 1
    shown: Annotated[int, Field(ge=0, le=60)] = 20


class Quantiles(BaseModel):
    """Quantiles of durations in seconds: 50 % of walks take p25 to p75, 90 % take p05 to p95."""

    p05: float
    p25: float
    p50: float
    p75: float
    p95: float


class FixedView(BaseModel):
    """The prediction of a deterministic model: the duration of one steering vector."""

    duration_s: float
    vector: list[float]


class SampledWalk(BaseModel):
    """One drawn walk; `xy_m` from 0 in steps of `step_s`, the last point at arrival."""

    vector: list[float]
    duration_s: float
    step_s: float
    xy_m: list[Point]


class PredictionView(BaseModel):
    """The distribution of durations on a path, with P_stat and P_adapt for comparison.

    `model`: mixed, the travel times with effects of people; prob, the paper's P_prob, for models
    fitted before there was mixed.
    `assumed`: dependencies that were not given. `outside`: those beyond the walks that the model
    was fitted to, where it extrapolates. `lost`: draws that did not arrive and were drawn again.
    `durations_s` are sorted. `kinds`: includes synthetic if the model's people include synthetic
    ones. `stat`, `adapt`: null if no agent of this model arrives on the path.
    """

    points_m: list[Point]
    model: Literal["mixed", "prob"]
    dependencies: dict[str, float]
    assumed: list[str]
    outside: list[str]
    durations_s: list[float]
    quantiles_s: Quantiles
    mean_s: float
    lost: int
    count: int
    seed: int
    kinds: list[Kind]
    stat: FixedView | None
    adapt: FixedView | None
    walkers: list[SampledWalk]


class SliceAsked(BaseModel):
    """The slice of the map for these dependencies, with one parameter (`held`) fixed at `value`."""

    model_config = ConfigDict(extra="forbid")

    dependencies: Annotated[
        dict[Annotated[str, Field(min_length=1, max_length=80)], Value], Field(max_length=20)
    ]
    held: Annotated[str, Field(min_length=1, max_length=80)]
    value: Value


class SliceView(BaseModel):
    """Suitability over two parameters; rows of `suitability` are values of y.

    `order`: the parameters in the order of a vector's numbers. `largest`: the maximum of the whole
    map, so that slices share a scale.
    """

    x: ParameterView
    y: ParameterView
    held: ParameterView
    order: list[str]
    held_at: float
    suitability: list[list[float]]
    largest: float
