"""Run `reembody walk`: fit a model, draw walks from it, compare it with recorded walks."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from app.adapters.captures import number_of
from app.adapters.walks.model_file import is_model, read_model, write_model
from app.cli.outputs import require_output, require_replaceable
from app.cli.walk.inputs import Entries, read_entries, tables_of
from app.cli.walk.people import read_people
from app.cli.walk.scenes import NamedScenes, read_scene
from app.science.walking.evaluation import Evaluation, evaluate
from app.science.walking.following import SteeringFollower
from app.science.walking.maps import (
    PAPER,
    TIME_AWARE,
    MapMaker,
    SuitabilityOptions,
    check_persons,
    database_of,
    maps_of,
)
from app.science.walking.models import (
    FitOptions,
    FittedWalking,
    Prediction,
    Predictor,
    SteeringModel,
    baseline_models,
    fitted,
    models_without_each,
)
from app.science.walking.planning import LazyThetaPlanner
from app.science.walking.recording import dependencies_of
from app.science.walking.records import (
    LENGTH,
    STATURE,
    TURNING,
    PlannedPath,
    PlannedWalk,
    Point,
    Walk,
    WalkingError,
    check_names,
    check_varies,
    further_of,
)
from app.science.walking.scene import Scene
from app.science.walking.synthetic import straight_path

READINGS: dict[str, SuitabilityOptions | None] = {
    "chosen": None,
    "paper": PAPER,
    "time-aware": TIME_AWARE,
}
MODELS = ("mixed", "prob", "adapt", "stat")

MOST_METRES = 1000.0
"""Longest path that is predicted: every draw walks all of it."""


@dataclass(frozen=True)
class WalksOrder:
    """The files of recorded walks, with their people, and the scene of those that name none.

    `synthetic`: a program made them.
    """

    files: tuple[Path, ...]
    scene: str | None = None
    people: Path | None = None
    rate_hz: float | None = None
    unit: str | None = None
    synthetic: bool = False


@dataclass(frozen=True)
class FitOrder:
    """The options of the command `walk fit`."""

    walks: WalksOrder
    out: Path
    seed: int = 1
    k: int = 100
    entries: int = 5000
    reading: str = "chosen"
    depends_on: tuple[str, ...] = ()


@dataclass(frozen=True)
class SampleOrder:
    """The options of the command `walk sample`."""

    model: Path
    length_m: float | None = None
    points: str | None = None
    scene: str | None = None
    start: str | None = None
    goal: str | None = None
    stature_m: float | None = None
    count: int = 100
    which: str | None = None
    seed: int = 1
    given: tuple[str, ...] = ()
    """Further dependencies, each as `name=number`."""


@dataclass(frozen=True, eq=False)
class Fitted:
    """A model that was fitted and written.

    Attributes:
        content_hash: of the file's content.
        walks: the walks that were fitted, and those that were left out with the reason.
        left_out: the paper's dependencies that are not known for all walks.
        cut: number of walks that the recording cuts off at their start or end.
    """

    order: FitOrder
    fit: FittedWalking
    content_hash: str
    walks: Entries
    left_out: tuple[str, ...]
    cut: int


@dataclass(frozen=True, eq=False)
class Sampled:
    """The result of drawing from a model: the draws, with the path and the options.

    Attributes:
        which: the name of the model that was used.
    """

    order: SampleOrder
    which: str
    fit: FittedWalking
    path: PlannedPath
    dependencies: dict[str, float]
    prediction: Prediction

    @property
    def synthetic(self) -> bool:
        """Whether a program made any of the walks that the model was fitted to."""
        return "synthetic" in self.fit.database.kinds

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be known before these draws are believed."""
        base, found = self.fit.database, []
        if self.order.stature_m is not None and STATURE not in base.names:
            found.append(
                f"the model was fitted without statures, so --stature {self.order.stature_m:g}"
                " changes nothing; fit it again with --people to learn from them"
            )
        found.extend(
            f"{name} {self.dependencies[name]:.2f} is outside what the model has seen,"
            f" {self.fit.seen(name)}: this is a guess"
            for name in self.fit.outside(self.dependencies)
        )
        return (*found, *self.fit.caveats)


@dataclass(frozen=True, eq=False)
class Evaluated:
    """A model compared with recorded walks.

    Attributes:
        walks: the walks of the files, with those that could not be read as walks.
        left_out: name and reason of each walk that is in no figure.
    """

    fit: FittedWalking
    result: Evaluation
    walks: Entries
    left_out: tuple[tuple[str, str], ...]


def carry_out_fit(order: FitOrder, now: Callable[[str], None] = lambda _step: None) -> Fitted:
    """Fit a model and write it; raise ValueError or OSError, with nothing written.

    `now` is told what is being done, in words.
    """
    if order.reading not in READINGS:
        raise ValueError(f"--reading {order.reading!r}: {', '.join(READINGS)} are valid")
    recorded = order.walks
    require_output(order.out, *recorded.files, recorded.people, recorded.scene)
    require_replaceable(order.out, "a walking model", is_model)
    read = _read(order.walks, order.depends_on)
    entries = read.entries
    check_varies(entries, order.depends_on)
    names, left_out = _names(entries, order.depends_on)
    people = {entry.walk.subject for entry in entries}
    if len(people) < 2:
        # Reported before the maps are made, which takes most of the time.
        _one_person(entries[0].walk, len(entries))
    follower = SteeringFollower()
    maker = MapMaker(follower=follower)
    now(f"making the maps of {len(entries)} walks")
    maps = [
        one
        for _, one in maps_of(
            entries, maker, progress=lambda done, total: now(f"maps: {done} of {total}")
        )
    ]
    database = database_of(entries, maps, names)
    check_persons(database)
    options = FitOptions(order.seed, order.k, order.entries, READINGS[order.reading])
    now("comparing readings of the maps" if READINGS[order.reading] is None else "fitting")
    cut = sum(not (one.walk.begins_still and one.walk.ends_still) for one in entries)
    fit = replace(fitted(database, options), caveats=_caveats(read, cut))
    now("learning how people differ, and writing the model")
    digest = write_model(order.out, fit, follower.rules)
    return Fitted(order, fit, digest, read, left_out, cut)


def carry_out_sample(order: SampleOrder) -> Sampled:
    """Draw from a model; raise ValueError or OSError."""
    if order.which is not None and order.which not in MODELS:
        raise ValueError(f"--model {order.which!r}: {', '.join(MODELS)} are valid")
    if not 1 <= order.count <= 100_000:
        raise ValueError(f"--count {order.count}: 1 to 100000 are valid")
    path = _path_of(order)
    fit, rules, _ = read_model(order.model)
    further = further_of(fit.database.names)
    dependencies = dependencies_of(path, order.stature_m, _given(order, further))
    missing = {name: f"--with {name}=NUMBER" for name in further if name not in dependencies}
    if STATURE in fit.database.names and order.stature_m is None:
        missing = {STATURE: "--stature METRES", **missing}
    if missing:
        names = " and ".join("stature" if name == STATURE else name for name in missing)
        asked = ", ".join(f"{how} ({fit.seen(name)} in its walks)" for name, how in missing.items())
        raise ValueError(f"{order.model} depends on {names}: give {asked}")
    fit.check_walkable(dependencies)
    model = fit.usual if order.which is None else fit.named(order.which)
    predictor = Predictor(model, SteeringFollower(rules))
    rng = np.random.default_rng(order.seed)
    prediction = predictor.predict(path, dependencies, order.count, rng)
    return Sampled(order, model.name, fit, path, dependencies, prediction)


def carry_out_evaluation(
    model: Path, walks: WalksOrder, *, draws: int, seed: int, even_fitted: bool
) -> Evaluated:
    """Compare a model with recorded walks; raise ValueError or OSError."""
    if not 1 <= draws <= 10_000:
        raise ValueError(f"--draws {draws}: 1 to 10000 are valid")
    fit, rules, _ = read_model(model)
    read = _read(walks, further_of(fit.database.names))
    entries = read.entries
    fitted_on = {entry.walk.subject for entry in entries} & set(fit.database.subjects)
    if fitted_on and not even_fitted:
        raise ValueError(
            f"the model was fitted on {', '.join(sorted(fitted_on))}: its errors there say nothing"
            " about others. Give other people's walks, or --even-fitted"
        )
    rng = np.random.default_rng(seed)
    follower = SteeringFollower(rules)
    models: list[SteeringModel] = [*fit.models]
    if fit.mixed is not None:
        models = [fit.mixed, *models, *baseline_models(fit.database, rng)]
        models += models_without_each(fit.database, rng)
    result = evaluate(models, follower, entries, rng, draws=draws, course_of=_course)
    unpredicted = [(read.names[at], reason) for at, reason in sorted(result.left_out.items())]
    return Evaluated(fit, result, read, (*read.left_out, *unpredicted))


def _course(entry: PlannedWalk) -> str:
    """Return the walk's length, rounded: walks of the same rounded length are repetitions."""
    return f"{round(4.0 * entry.path.length_m) / 4.0:g} m"


def _read(order: WalksOrder, numbers: tuple[str, ...]) -> Entries:
    check_names(numbers)
    tables = tables_of(order.rate_hz, order.unit, synthetic=order.synthetic)
    scenes = NamedScenes(order.scene)
    people = read_people(order.people, numbers)
    return read_entries(order.files, people, scenes, tables, numbers)


def _given(order: SampleOrder, further: tuple[str, ...]) -> dict[str, float]:
    """Return the further dependencies that were given; raise ValueError for others, or twice."""
    found: dict[str, float] = {}
    for text in order.given:
        name, _, number = (part.strip() for part in text.partition("="))
        if name in (STATURE, "stature"):
            raise ValueError(f"--with {text!r}: give --stature in metres")
        if name not in further or name in found:
            valid = f"only on {', '.join(further)}, each given once" if further else "on no others"
            raise ValueError(
                f"--with {text!r}: besides length, turning and stature, {order.model} depends"
                f" {valid}"
            )
        found[name] = number_of(number)
        if not np.isfinite(found[name]):
            raise ValueError(f"--with {text!r}: {number!r} is not a number; write {name}=8, say")
    return found


def _caveats(read: Entries, cut: int) -> tuple[str, ...]:
    """Return what is to be known of the walks wherever the model is used."""
    found = []
    if cut:
        found.append(
            f"{cut} walk(s) begin or end with the recording, amid walking; they say little about"
            " how people start and stop"
        )
    if len(read.named_by_file) > 1:
        found.append(
            f"{len(read.named_by_file)} people are only known by the names of their files: if one"
            " person walks in several, say so with --people, or predictions are too certain"
        )
    return tuple(found)


def _names(
    entries: list[PlannedWalk], further: tuple[str, ...]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the model's dependencies, and those of the paper that some of the walks lack."""
    usual = (LENGTH, TURNING, STATURE)
    everywhere = tuple(n for n in usual if all(n in entry.dependencies for entry in entries))
    return (*everywhere, *further), tuple(name for name in usual if name not in everywhere)


def _one_person(walk: Walk, count: int) -> None:
    raise WalkingError(
        f"all {count} walks are of one subject, {walk.subject!r}. How people differ cannot be"
        " learnt from one: give walks of two or more, and say who walks (a column `subject`, a"
        " file for each person, or --people)"
    )


def _path_of(order: SampleOrder) -> PlannedPath:
    ways = [order.length_m is not None, order.points is not None, order.scene is not None]
    if sum(ways) != 1:
        raise ValueError("give one of --length, --path and --scene with --from and --to")
    if order.length_m is not None:
        _check_length(order.length_m, f"--length {order.length_m:g}")
        return straight_path(order.length_m)
    if order.points is not None:
        path = PlannedPath(np.array([_point(text, "--path") for text in order.points.split()]))
        _check_length(path.length_m, f"--path of {path.length_m:g} m")
        return path
    scene = read_scene(order.scene)
    if scene is None or order.start is None or order.goal is None:
        raise ValueError("--scene needs --from and --to: a place of the scene, or x,y in metres")
    start, goal = (_place(scene, order.start, "--from"), _place(scene, order.goal, "--to"))
    return LazyThetaPlanner(scene).plan(start, goal)


def _check_length(length_m: float, asked: str) -> None:
    if not 0.0 < length_m <= MOST_METRES:
        raise ValueError(
            f"{asked}: more than 0 and at most {MOST_METRES:g} m are valid. Give metres, and ask"
            " for a longer way in parts: no walk that a model learns from is nearly as long"
        )


def _place(scene: Scene, text: str, option: str) -> Point:
    if text in scene.places:
        return scene.places[text]
    try:
        return _point(text, option)
    except ValueError as error:
        places = ", ".join(scene.places) or "none"
        raise ValueError(f"{error}; places of scene {scene.name!r} are {places}") from None


def _point(text: str, option: str) -> Point:
    try:
        x, y = (float(part) for part in text.split(","))
    except ValueError:
        raise ValueError(f"{option} {text!r}: a point is two numbers, x,y in metres") from None
    return x, y
