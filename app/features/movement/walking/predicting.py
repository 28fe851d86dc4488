"""Predict walks on a path with a fitted model; runs in the worker process.

The last models used stay open, since computing the blending space of one takes a second.
"""

import tempfile
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from app.adapters.walks.model_file import read_model
from app.features.movement.walking.reading import content_of, scene_of
from app.features.movement.walking.sources import Cannot, Question, Store
from app.science.walking.following import SteeringFollower
from app.science.walking.models import (
    FittedWalking,
    NobodyWalks,
    Prediction,
    Predictor,
    TooFewArriveError,
)
from app.science.walking.planning import LazyThetaPlanner
from app.science.walking.recording import dependencies_of
from app.science.walking.records import STATURE, PlannedPath, WalkingError, further_of
from app.science.walking.scene import Scene, outlines_of

Json = dict[str, Any]
QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
SHOWN_STEP_S = 0.05
"""Time between two points of a path that is shown."""
MAX_SHOWN_POINTS = 400
"""Maximum number of points of a shown path; slower walkers get longer time steps."""


@lru_cache(maxsize=2)
def opened(store: Store, content_hash: str) -> tuple[FittedWalking, SteeringFollower]:
    """Return a stored model with the follower of its steering rules; raise Cannot."""
    with tempfile.TemporaryDirectory(prefix="reembody-walking-") as folder:
        path = Path(folder) / "model.npz"
        path.write_bytes(content_of(store, content_hash))
        try:
            fit, rules, _ = read_model(path)
        except WalkingError as error:
            raise Cannot(str(error), "Fit the model again.") from None
    return fit, SteeringFollower(rules)


@lru_cache(maxsize=4)
def _planner(text: str) -> LazyThetaPlanner:
    return LazyThetaPlanner(scene_of(text))


def path_of(question: Question) -> PlannedPath:
    """Return the path of a question: as drawn, or the shortest path between its ends.

    Raises:
        Cannot: A point is outside the scene or inside an obstacle, the path crosses one, or there
            is no path.
    """
    points = question.points_m
    try:
        if question.scene is None:
            return PlannedPath(np.array(points, dtype=np.float64))
        planner = _planner(question.scene)
        if question.planned:
            return planner.plan(points[0], points[-1])
        _check_drawn(planner.scene, points)
        return PlannedPath(np.array(points, dtype=np.float64))
    except WalkingError as error:
        raise Cannot(str(error), "Move the path's points.") from None


def _check_drawn(scene: Scene, points: tuple[tuple[float, float], ...]) -> None:
    from app.science.walking.planning import sees

    for number, point in enumerate(points, start=1):
        scene.check_point(point, f"Point {number} of the path")
    for number, (a, b) in enumerate(pairwise(points), start=1):
        for obstacle in scene.obstacles:
            if not sees(*a, *b, outlines_of([obstacle.corners_m])):
                raise Cannot(
                    f"between its points {number} and {number + 1} the path leads through obstacle"
                    f" {obstacle.name!r}",
                    "Add a point that leads around it, or have the path planned.",
                )


def predict(store: Store, content_hash: str, question: Question) -> Json:
    """Predict how long people take on a path, as a `PredictionView`; raise Cannot."""
    fit, follower = opened(store, content_hash)
    path = path_of(question)
    try:
        dependencies, assumed = _dependencies(fit, path, question)
        fit.check_walkable(dependencies)
        rng = np.random.default_rng(question.seed)
        usual = Predictor(fit.usual, follower)
        drawn = usual.predict(path, dependencies, question.count, rng)
        fixed = {
            model.name: _fixed(Predictor(model, follower), path, dependencies, rng)
            for model in (fit.stat, fit.adapt)
        }
        shown = drawn.vectors[: question.shown]
        walkers = _walkers(usual, path, shown, drawn.durations_s[: question.shown])
    except NobodyWalks as error:
        raise Cannot(str(error), "Give numbers that are nearer to those.") from None
    except WalkingError as error:
        raise Cannot(str(error), "Draw a path that is more like the model's walks.") from None
    return {
        "points_m": path.points_m.tolist(),
        "model": fit.usual.name,
        "dependencies": dependencies,
        "assumed": assumed,
        "outside": fit.outside(dependencies),
        "durations_s": np.sort(drawn.durations_s).round(4).tolist(),
        "quantiles_s": dict(
            zip(
                ("p05", "p25", "p50", "p75", "p95"),
                np.quantile(drawn.durations_s, QUANTILES).tolist(),
                strict=True,
            )
        ),
        "mean_s": float(drawn.durations_s.mean()),
        "lost": drawn.lost,
        "count": question.count,
        "seed": question.seed,
        "kinds": sorted(set(fit.database.kinds)),
        "walkers": walkers,
        **fixed,
    }


def _dependencies(
    fit: FittedWalking, path: PlannedPath, question: Question
) -> tuple[dict[str, float], list[str]]:
    """Return the dependencies of the walk, and the names of those that were assumed.

    A stature or a further number that is not known is assumed to be the mean of the model's walks.

    Raises:
        Cannot: the model does not depend on one of the further numbers.
    """
    base, given = fit.database, dict(question.others)
    further = further_of(base.names)
    for name in given:
        if name not in further:
            raise Cannot(
                f"this model does not depend on {name!r}",
                f"Besides its path and stature it knows {', '.join(further) or 'nothing'}.",
            )
    if question.stature_m is not None:
        given[STATURE] = question.stature_m
    assumed = [name for name in (STATURE, *further) if name in base.names and name not in given]
    for name in assumed:
        given[name] = float(base.vectors[:, base.names.index(name)].mean())
    stature_m = given.pop(STATURE, None)
    found = dependencies_of(path, stature_m, given)
    return {name: found[name] for name in base.names}, assumed


def _fixed(
    predictor: Predictor,
    path: PlannedPath,
    dependencies: dict[str, float],
    rng: np.random.Generator,
) -> Json | None:
    """Return the one walk of a model that does not draw; None if none of its agents arrives."""
    try:
        found: Prediction = predictor.predict(path, dependencies, 1, rng)
    except TooFewArriveError:
        return None
    return {"duration_s": float(found.durations_s[0]), "vector": found.vectors[0].tolist()}


def _walkers(
    predictor: Predictor,
    path: PlannedPath,
    vectors: np.ndarray[Any, np.dtype[np.float64]],
    durations_s: np.ndarray[Any, np.dtype[np.float64]],
) -> list[Json]:
    """Return walks along the path, each up to its arrival, at time steps that a page can draw."""
    if not len(vectors):
        return []
    dt_s = predictor.follower.dt_s
    samples = int(np.ceil(durations_s.max() / dt_s)) + 1
    places = predictor.walked(path, vectors, samples).xy_m
    found = []
    for vector, duration_s, xy_m in zip(vectors, durations_s, places, strict=True):
        last = int(np.ceil(duration_s / dt_s))
        every = max(round(SHOWN_STEP_S / dt_s), -(-last // MAX_SHOWN_POINTS))
        kept = np.unique(np.append(np.arange(0, last, every), last))
        found.append(
            {
                "vector": vector.tolist(),
                "duration_s": float(duration_s),
                "step_s": every * dt_s,
                "xy_m": xy_m[kept].round(3).tolist(),
            }
        )
    return found
