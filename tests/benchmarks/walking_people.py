"""Predict real walkers who were left out, one at a time: our model, the paper's, and baselines.

For `./run bench walking_evaluation --only real`. Five data sets: two tables of distances and
durations, and three sets of tracks. Each person is left out in turn, every model learns from the
others, and all walks of that person are predicted. Scores are CRPS and the shares of walks inside
the central 50 and 90 % of their predictions, with a bootstrap of whole people.

All travel-time models, ours and the baselines, have the same effects of people and the same
spread, so that only the curves differ. The paper's models need movements. The table of short walks
has only three numbers for a walk (distance, duration, peak speed): there they get the trapezoid of
speed that these numbers determine. The table of preferred speeds does not have the third, so they
are missing.

Known limits of the data, which no model can mend: heads in a corridor and in single file hold each
other up, so their durations depend on what others do; in single file 34 people have 71 numbers,
one for each time they pass the camera, so a person may be on both sides; where the recording cuts
walks off, the paper's models are told the speed at which the predicted walk begins, and the others
are not.
"""

import csv
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from app.adapters.captures import read_capture_file
from app.adapters.walks.track_table import TrackReading, read_tracks
from app.science.rotations import FloatArray
from app.science.walking.evaluation import over_people
from app.science.walking.maps import TIME_AWARE, MapMaker
from app.science.walking.models import FitOptions, covers, crps_s, fitted, predictor_for
from app.science.walking.planning import LazyThetaPlanner
from app.science.walking.recording import (
    LeftOut,
    Walker,
    dependencies_of,
    entry_of,
    track_of_motion,
    walks_of,
)
from app.science.walking.records import LENGTH, TURNING, PlannedWalk, Walk
from app.science.walking.scene import open_scene
from app.science.walking.synthetic import straight_path
from app.science.walking.travel_times import (
    BASELINES,
    Curve,
    StartingAndStopping,
    TimedWalks,
    posterior_of,
    resting_of,
    turning_of,
)
from tests.benchmarks.walking_cells import FOLLOWER, made
from tests.benchmarks.walking_real import captured_walks, foot_walks
from tests.support.short_walks import read_short_walk_table

OURS = "mixed"
BASELINE_NAMES = tuple(curve.name for curve in BASELINES)
PAPERS = ("prob", "adapt", "stat")
CAPTURES = ("02_01.amc", "05_06.bvh", "06_01.bvh", "12_02.bvh")
DRAWS, PAPER_DRAWS = 1000, 200
TABLE = "short walks, table"
_RATE_HZ = 60.0


@dataclass(frozen=True, eq=False)
class DataSet:
    """Real walks.

    Attributes:
        name: short name with the source.
        walks: what travel-time models see of them.
        entries: what the paper's models see; None if the data have no movement.
        ids_are_people: whether each subject is another person.
    """

    name: str
    walks: TimedWalks
    entries: tuple[PlannedWalk, ...] | None
    ids_are_people: bool = True


@dataclass(frozen=True, eq=False)
class Score:
    """One model on one data set, by leaving one subject out.

    Attributes:
        crps_s, inside_50, inside_90: (N,) for each walk.
    """

    method: str
    data: DataSet
    crps_s: FloatArray
    inside_50: FloatArray
    inside_90: FloatArray

    def as_json(self) -> dict[str, object]:
        """Return the figures of the benchmark's JSON; coverage in percent."""
        low_50, high_50 = self._over(100.0 * self.inside_50)
        low_90, high_90 = self._over(100.0 * self.inside_90)
        return {
            "method": self.method,
            "dataset": self.data.name,
            "crps_s": float(self.crps_s.mean()),
            "coverage_50": 100.0 * float(self.inside_50.mean()),
            "coverage_90": 100.0 * float(self.inside_90.mean()),
            "folds": len(self.data.walks.persons),
            "walks": len(self.crps_s),
            "crps_s_95": list(self._over(self.crps_s)),
            "coverage_50_95": [low_50, high_50],
            "coverage_90_95": [low_90, high_90],
            "ids_are_people": self.data.ids_are_people,
        }

    def _over(self, values: FloatArray) -> tuple[float, float]:
        return over_people(values, self.data.walks.subjects, np.random.default_rng(1))


def less(first: Score, second: Score) -> tuple[float, float, float]:
    """Return how much larger the first model's CRPS is, with a 95 % interval over people."""
    gap = first.crps_s - second.crps_s
    subjects = first.data.walks.subjects
    return float(gap.mean()), *over_people(gap, subjects, np.random.default_rng(1))


@cache
def scores(folder: Path) -> tuple[Score, ...]:
    """Return the scores of all models on all data sets; takes some minutes."""
    return tuple(one for data in data_sets(folder) for one in _scored(data))


def _scored(data: DataSet) -> Iterator[Score]:
    for curve in (StartingAndStopping(), *BASELINES):
        began = time.perf_counter()
        name = curve.name if curve.name in BASELINE_NAMES else OURS
        yield _told(_score(data, name, _drawn(data.walks, curve)), began)
    if data.entries is not None:
        began = time.perf_counter()
        for name, drawn in _papers(data.entries).items():
            yield _told(_score(data, name, drawn), began)


def _told(score: Score, began: float) -> Score:
    found = score.as_json()
    print(
        f"  {score.data.name}, {score.method}: CRPS {found['crps_s']:.3f} s, inside"
        f" {found['coverage_50']:.0f} / {found['coverage_90']:.0f} %,"
        f" {time.perf_counter() - began:.0f} s",
        file=sys.stderr,
    )
    return score


def _score(data: DataSet, method: str, drawn: Sequence[FloatArray]) -> Score:
    pairs = list(zip(drawn, data.walks.durations_s, strict=True))
    inside = [np.array([covers(d, truth, share) for d, truth in pairs], dtype=np.float64)
              for share in (0.5, 0.9)]  # fmt: skip
    return Score(method, data, np.array([crps_s(d, truth) for d, truth in pairs]), *inside)


def _drawn(walks: TimedWalks, curve: Curve) -> list[FloatArray]:
    rng, subjects = np.random.default_rng(1), np.array(walks.subjects)
    found: dict[int, FloatArray] = {}
    for person in walks.persons:
        left = subjects == person
        posterior = posterior_of(walks.select(~left), curve, rng)
        for at in np.flatnonzero(left):
            found[int(at)] = posterior.draw(walks.select(np.array([at])), DRAWS, rng)[0]
    return [found[at] for at in range(len(walks))]


def _papers(entries: Sequence[PlannedWalk]) -> dict[str, list[FloatArray]]:
    rng = np.random.default_rng(1)
    database = made(list(entries), MapMaker(), (LENGTH, TURNING))
    found: dict[str, dict[int, FloatArray]] = {name: {} for name in PAPERS}
    for person in database.persons:
        left = database.walked_by([person])
        fit = fitted(database.select(~left), FitOptions(seed=1, reading=TIME_AWARE))
        for model in fit.models:
            for at in np.flatnonzero(left):
                entry = entries[int(at)]
                predictor = predictor_for(entry.walk, model, FOLLOWER)
                drawn = predictor.predict(entry.path, entry.dependencies, PAPER_DRAWS, rng)
                found[model.name][int(at)] = drawn.durations_s
    return {name: [own[at] for at in range(len(entries))] for name, own in found.items()}


def data_sets(folder: Path) -> Iterator[DataSet]:
    """Return all real walks of the shared data."""
    walking = folder / "walking"
    yield _short_walks(walking / "short_walks" / "peak_speed_all_sub.mat")
    yield preferred_speeds(folder)
    bvh = read_capture_file(folder / "motion" / "bvh_toolbox" / "walk01.bvh")
    captured = [
        *captured_walks(folder, CAPTURES),
        *walks_of(track_of_motion(bvh.motion, Walker("walk01", "walk01.bvh"))),
        *foot_walks(folder, scaled=True),
    ]
    yield _tracked("captured bodies and feet, tracks", captured)
    pedestrian = walking / "pedestrian"
    yield _tracked("corridor, head tracks", _heads(pedestrian / "uo-050-180-180.txt", 16.0))
    single = _heads(pedestrian / "n34_cam2.csv", 25.0)
    yield _tracked("single file, head tracks", single, ids_are_people=False)


def _short_walks(path: Path) -> DataSet:
    table = read_short_walk_table(path.read_bytes())
    entries = [
        _trapezoid(distance, table.durations_s[who, at, trial],
                   table.peak_speeds_m_s[who, at, trial], f"{who + 1:02}")
        for who in range(len(table.durations_s))
        for at, distance in enumerate(table.distances_m)
        for trial in range(table.durations_s.shape[2])
        if np.isfinite(table.durations_s[who, at, trial])
    ]  # fmt: skip
    walks = _timed(entries, [entry.walk.duration_s for entry in entries])
    return DataSet(TABLE, walks, tuple(entries))


def _trapezoid(distance_m: float, duration_s: float, peak_m_s: float, subject: str) -> PlannedWalk:
    """Return a straight walk that speeds up, walks at its peak speed, and brakes as fast.

    Distance and duration determine the ramps. A peak below the mean speed, which sensors report for
    some of the shortest walks, or above twice the mean is moved just inside these limits.
    """
    mean = distance_m / duration_s
    peak = float(np.clip(peak_m_s, 1.05 * mean, 1.95 * mean))
    ramp_s = duration_s - distance_m / peak
    times_s = np.linspace(0.0, duration_s, max(3, round(duration_s * _RATE_HZ) + 1))
    rate = peak / ramp_s
    up = 0.5 * rate * np.minimum(times_s, ramp_s) ** 2
    level = peak * np.clip(times_s - ramp_s, 0.0, duration_s - 2.0 * ramp_s)
    braking_s = np.clip(times_s - (duration_s - ramp_s), 0.0, ramp_s)
    ahead = up + level + peak * braking_s - 0.5 * rate * braking_s**2
    path = straight_path(distance_m)
    start, goal = path.points_m[0], path.points_m[-1]
    places = start + (goal - start) * (ahead / ahead[-1])[:, None]
    walk = Walk(times_s, places, subject, "short walks")
    return PlannedWalk(walk, path, dependencies_of(path))


def preferred_speeds(folder: Path) -> DataSet:
    """Read Seethapathi and Srinivasan's (2015) first three people, .5 to 89 m, three times each."""
    path = folder / "walking" / "preferred_speed_vs_distance_seethapathi2015_excerpt.csv"
    rows = [
        (float(row["distance_m"]), float(row["distance_m"]) / float(row[key]), row["subject"])
        for row in csv.DictReader(path.read_text(encoding="utf-8").splitlines())
        for key in ("speed_trial1_mps", "speed_trial2_mps", "speed_trial3_mps")
        if row[key]
    ]
    lengths, durations, subjects = zip(*rows, strict=True)
    count = len(rows)
    walks = TimedWalks(
        np.array(lengths), np.zeros(count), np.ones(count), np.empty((count, 0)),
        np.array(durations), tuple(subjects),
    )  # fmt: skip
    return DataSet("preferred speeds, table", walks, None)


def _heads(path: Path, rate_hz: float) -> list[Walk]:
    tracks = read_tracks(path.read_bytes(), name=path.name, reading=TrackReading(rate_hz=rate_hz))
    return [walk for track in tracks for walk in walks_of(track)]


def _tracked(name: str, walks: Sequence[Walk], *, ids_are_people: bool = True) -> DataSet:
    found = [entry_of(walk, LazyThetaPlanner(open_scene(walk.start_m, walk.goal_m)))
             for walk in walks]  # fmt: skip
    entries = tuple(entry for entry in found if not isinstance(entry, LeftOut))
    timed = _timed(entries, [entry.walk.duration_s for entry in entries])
    return DataSet(name, timed, entries, ids_are_people)


def _timed(entries: Sequence[PlannedWalk], durations_s: Sequence[float]) -> TimedWalks:
    return TimedWalks(
        np.array([entry.path.length_m for entry in entries]),
        np.array([turning_of(entry.dependencies) for entry in entries]),
        np.array([resting_of(entry) for entry in entries]),
        np.empty((len(entries), 0)),
        np.array(durations_s),
        tuple(entry.walk.subject for entry in entries),
    )
