"""How well the times of reaches are predicted of people who were left out.

Each person is left out in turn, everything is learnt from the others, and each of their reaches is
predicted as that of somebody new. With fewer than three people, recordings take the place of
people, which says little about others. Compared are

    maps      the fitted maps and levels
    assumed   the simulation's constants: MacKenzie and Ware's pace with the assumed spreads
    line      Fitts' line T = a + b ID with effects of people and heavy tails
              (`app.science.walking.travel_times`), learnt from the same reaches

by the CRPS of the movement time, cut at the speed that cuts the recordings.
"""

from dataclasses import dataclass, replace

import numpy as np

from app.science.reaching.agent import cut_agents
from app.science.reaching.model import LEAST_PEOPLE, FittedReaching, fitted_reaching, groups_of
from app.science.reaching.records import DIFFICULTY, DISTANCE, USUAL_NEAR_M, ReachingError
from app.science.rotations import FloatArray
from app.science.simulation import (
    difficulty_bits,
    draw_traits,
    shortest_time_s,
)
from app.science.walking.evaluation import over_people, reason_for_no_interval
from app.science.walking.maps import IntArray, WalkDatabase
from app.science.walking.models import covers, crps_s
from app.science.walking.travel_times import Line, TimedWalks, posterior_of

MAPS, ASSUMED, LINE = "maps", "assumed", "line"
METHODS = (MAPS, ASSUMED, LINE)
DRAWS = 400


@dataclass(frozen=True)
class ReachScore:
    """How well a method predicts the times of reaches.

    Attributes:
        method: its name.
        crps_s: mean CRPS over the reaches.
        coverage_50, coverage_90: shares of reaches inside the central 50 and 90 % of predictions.
        maps_better_s: how much smaller the CRPS of the maps is, 0 for the maps themselves.
        interval_s: its 95 % interval over those left out, None if they are too few.
    """

    method: str
    crps_s: float
    coverage_50: float
    coverage_90: float
    maps_better_s: float
    interval_s: tuple[float, float] | None


@dataclass(frozen=True)
class ReachEvaluation:
    """The scores of all methods on the same reaches.

    Attributes:
        scores: of each method.
        left_out: what was left out in turn, people or recordings.
        groups: how many of them.
        reaches: how many reaches were predicted.
        no_interval: why there are no intervals, None if there are.
    """

    scores: tuple[ReachScore, ...]
    left_out: str
    groups: int
    reaches: int
    no_interval: str | None

    def score(self, method: str) -> ReachScore:
        """Return the score of a method."""
        return next(one for one in self.scores if one.method == method)

    @property
    def verdict(self) -> str:
        """Say what the scores mean, in a sentence or two."""
        said = [_compared(self.score(method)) for method in (ASSUMED, LINE)]
        few = " Recordings were left out, not people: it says little about others."
        about = "" if self.left_out == "people" else few
        return f"{'; '.join(said)}.{about}"


def evaluate_reaching(fit: FittedReaching, seed: int = 1, draws: int = DRAWS) -> ReachEvaluation:
    """Predict each reach of a model from those of other people, or of other recordings.

    Raises:
        ReachingError: there are fewer than three people, and fewer than three recordings.
    """
    database = fit.database
    groups = np.array(groups_of(database))
    names = sorted(set(groups.tolist()))
    if len(names) < LEAST_PEOPLE:
        raise ReachingError(
            f"The {len(database)} reaches are of {len(database.persons)} people in"
            f" {len(names)} recordings: to leave one out, at least {LEAST_PEOPLE} people, or"
            " recordings of fewer people, are needed. Fit a model on more."
        )
    split = replace(database, subjects=tuple(groups.tolist()))
    scored: dict[str, FloatArray] = {name: np.empty((len(database), 3)) for name in METHODS}
    rngs = np.random.default_rng(seed).spawn(len(names))
    for name, rng in zip(names, rngs, strict=True):
        out = np.flatnonzero(groups == name)
        learnt = fitted_reaching(split.select(groups != name), fit.rules, fit.options)
        for method, drawn in _predicted(learnt, split, out, draws, rng).items():
            for at, own_s in zip(out, drawn, strict=True):
                truth_s = float(database.durations_s[at])
                scored[method][at] = (
                    crps_s(own_s, truth_s),
                    covers(own_s, truth_s, 0.5),
                    covers(own_s, truth_s, 0.9),
                )
    none = reason_for_no_interval(len(names))
    left_out = "people" if len(database.persons) >= LEAST_PEOPLE else "recordings"
    scores = tuple(_score(name, scored, split.subjects, none) for name in METHODS)
    return ReachEvaluation(scores, left_out, len(names), len(database), none)


def _predicted(
    learnt: FittedReaching, split: WalkDatabase, out: IntArray, draws: int, rng: np.random.Generator
) -> dict[str, list[FloatArray]]:
    """Return draws (S,) of the cut time of each reach that is left out, by each method."""
    ours, assumed, line = rng.spawn(3)
    posterior = posterior_of(_timed(learnt.database), Line(), line)
    found: dict[str, list[FloatArray]] = {name: [] for name in METHODS}
    for at in out:
        one = split.select(np.array([at]))
        distance_m, near_m = float(one.lengths_m[0]), near_of(one)
        still_m_s = learnt.rules.still_m_s
        times_s, skews = learnt.movements(distance_m, near_m, draws, ours)
        times_s = np.maximum(times_s, shortest_time_s(distance_m))
        found[MAPS].append(_cut(distance_m, times_s, skews, still_m_s))
        times_s = _assumed_times(distance_m, near_m, draws, assumed)
        found[ASSUMED].append(_cut(distance_m, times_s, np.ones(draws), still_m_s))
        found[LINE].append(posterior.draw(_timed(one), draws, line)[0])
    return found


def _assumed_times(
    distance_m: float, near_m: float, count: int, rng: np.random.Generator
) -> FloatArray:
    drawn = [draw_traits(rng).movement_time(distance_m, near_m, rng) for _ in range(count)]
    return np.array(drawn)


def _cut(distance_m: float, times_s: FloatArray, skews: FloatArray, still_m_s: float) -> FloatArray:
    """Return how long movements are seen to take; those that are always slow, their whole time."""
    arrival_s = cut_agents(distance_m, times_s, skews, still_m_s).arrival_s
    return np.where(np.isfinite(arrival_s), arrival_s, times_s)


def _timed(database: WalkDatabase) -> TimedWalks:
    """Return the reaches as a line through the index of difficulty takes them."""
    bits = np.array([_bits(database, at) for at in range(len(database))])
    none = np.zeros(len(database))
    return TimedWalks(
        bits, none, none + 1.0, np.empty((len(database), 0)), database.durations_s,
        database.subjects,
    )  # fmt: skip


def _bits(database: WalkDatabase, at: int) -> float:
    if DIFFICULTY in database.names:
        return float(database.vectors[at, database.names.index(DIFFICULTY)])
    return difficulty_bits(float(database.lengths_m[at]), USUAL_NEAR_M)


def near_of(one: WalkDatabase) -> float:
    """Return the half width of the target of a database's first reach."""
    distance_m = float(one.vectors[0, one.names.index(DISTANCE)])
    return distance_m / float(2.0 * (2.0 ** _bits(one, 0) - 1.0))


def _score(
    method: str, scored: dict[str, FloatArray], subjects: tuple[str, ...], none: str | None
) -> ReachScore:
    better_s = scored[method][:, 0] - scored[MAPS][:, 0]
    interval_s = None
    if none is None and method != MAPS:
        interval_s = over_people(better_s, subjects, np.random.default_rng(1))
    score_s, half, most = (float(value) for value in scored[method].mean(axis=0))
    return ReachScore(method, score_s, half, most, float(better_s.mean()), interval_s)


def _compared(one: ReachScore) -> str:
    share = 100.0 * one.maps_better_s / one.crps_s if one.crps_s else 0.0
    other = {ASSUMED: "the assumed constants", LINE: "Fitts' line"}[one.method]
    way = "better" if one.maps_better_s >= 0.0 else "worse"
    text = f"the maps predict {abs(share):.0f} % {way} than {other}"
    if one.interval_s is None:
        return f"{text} (too few to say whether by chance)"
    low_s, high_s = one.interval_s
    sure = "not by chance" if low_s > 0.0 or high_s < 0.0 else "which may be chance"
    return f"{text}, {sure}"
