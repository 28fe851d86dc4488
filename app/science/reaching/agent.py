"""The agent: the simulated person's own reach, with every combination of tempo and skew.

A reach of the simulation is determined by its distance, its time and its skew
(`app.science.simulation`): the hand is at s(t / T; skew) of the straight way. Two parameters are
fitted. `tempo` is its time T over the time that the simulation assumes for the distance and the
target; `skew` says whether it is fastest early or late. Intercept and slope of the pace are not
parameters: a single reach tells its time, not how that divides into the two. How pace depends on
distance is what the blending of maps learns.

Recordings are cut where the hand is slower than a threshold, so the agent is cut there, too. Its
full way is a little longer than the recorded one, by what it covers while it is slow.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from app.science.reaching.records import Reach
from app.science.rotations import FloatArray
from app.science.simulation import usual_time_s
from app.science.walking.maps import DeviationMap, IntArray
from app.science.walking.records import ParameterGrid, SteeringParameter

LOG_TEMPO: Final = SteeringParameter("log tempo", "log of a share", -3.0, 3.0)
"""Logarithm of the time of a movement over the time that the simulation assumes."""
LOG_SKEW: Final = SteeringParameter("log skew", "log of an exponent", -0.9, 1.4)
"""Logarithm of the skew: 0 for minimum jerk, more if the hand is fastest early."""
_TEMPO_STEP, _SKEW_STEP = float(np.log(1.08)), float(np.log(2.0)) / 3.0
_PROGRESS = np.linspace(0.0, 1.0, 601)
_ROUNDS = 8


def tempo_grid(steps: int) -> ParameterGrid:
    """Return tempos of 1.08^-steps to 1.08^steps, each with skews of 0.5 to 2.52.

    Both are logarithms, equally spaced, so that a map favours neither slow nor fast movements; no
    skew at the usual tempo, (0, 0), is a node.
    """
    tempos = _TEMPO_STEP * np.arange(-steps, steps + 1, dtype=np.float64)
    skews = _SKEW_STEP * np.arange(-3.0, 5.0)
    return ParameterGrid((LOG_TEMPO, LOG_SKEW), (tuple(tempos.tolist()), tuple(skews.tolist())))


REACH_GRID: Final = tempo_grid(20)
"""Tempos 0.21 to 4.7 of the assumed time, for the maps of single reaches."""
PERSON_GRID: Final = tempo_grid(15)
"""Tempos 0.32 to 3.2 of a person's own time, for the maps that are blended."""


@dataclass(frozen=True, eq=False)
class CutAgents:
    """K agents on one way, cut where they are slower than a threshold.

    Attributes:
        durations_s: (K,) whole times.
        skews: (K,) their skews.
        began: (K,) share of the time after which each exceeds the threshold.
        ended: (K,) share of the time after which it falls below it again.
        whole_m: (K,) the full way, of which the cut leaves the recorded distance.
        arrival_s: (K,) time between the cuts, NaN for an agent that is never faster.
    """

    durations_s: FloatArray
    skews: FloatArray
    began: FloatArray
    ended: FloatArray
    whole_m: FloatArray
    arrival_s: FloatArray

    def covered_m(self, times_s: FloatArray) -> FloatArray:
        """Return how far each is (K, N) at times after it exceeded the threshold.

        An agent that has arrived stays; one that never exceeds the threshold does not leave.
        """
        progress = self.began[:, None] + times_s / self.durations_s[:, None]
        progress = np.minimum(progress, self.ended[:, None])
        skews = self.skews[:, None]
        way = _covered(progress, skews) - _covered(self.began[:, None], skews)
        return np.asarray(self.whole_m[:, None] * way, dtype=np.float64)


def cut_agents(
    distance_m: float, durations_s: FloatArray, skews: FloatArray, still_m_s: float
) -> CutAgents:
    """Let K agents reach over a distance, and cut them at a speed.

    Args:
        distance_m: the way that the cut is to leave.
        durations_s, skews: (K,) whole times and skews.
        still_m_s: speed of the cuts.
    """
    speed = _speed(_PROGRESS[None], skews[:, None])
    rows = np.arange(len(skews))
    whole_m = np.full(len(skews), distance_m)
    began, ended = np.zeros(len(skews)), np.zeros(len(skews))
    moves = np.zeros(len(skews), dtype=np.bool_)
    for _ in range(_ROUNDS):
        least = still_m_s * durations_s / whole_m
        fast = speed >= least[:, None]
        moves = fast.any(axis=1)
        first = np.maximum(np.argmax(fast, axis=1), 1)
        last = np.minimum(fast.shape[1] - 1 - np.argmax(fast[:, ::-1], axis=1), fast.shape[1] - 2)
        began = _between(speed, rows, first - 1, first, least)
        ended = _between(speed, rows, last + 1, last, least)
        left = _covered(ended, skews) - _covered(began, skews)
        whole_m = np.where(moves & (left > 0.0), distance_m / np.maximum(left, 1e-9), distance_m)
    began, ended = np.where(moves, began, 0.0), np.where(moves, ended, 0.0)
    arrival_s = np.where(moves, (ended - began) * durations_s, np.nan)
    return CutAgents(durations_s, skews, began, ended, whole_m, arrival_s)


def map_of(reach: Reach, still_m_s: float, grid: ParameterGrid = REACH_GRID) -> DeviationMap:
    """Re-simulate one reach with every combination of tempo and skew.

    The deviation is the mean distance between agent and hand over the samples of the reach, as a
    share of its distance (equation 5 of Agethen et al. 2018, with the mean instead of the sum).
    """
    usual_s = usual_time_s(reach.distance_m, reach.near_m)
    tempos, skews = np.exp(grid.nodes).T
    agents = cut_agents(reach.distance_m, tempos * usual_s, skews, still_m_s)
    start = reach.positions_m[0]
    ahead = (reach.positions_m[-1] - start) / reach.distance_m
    along = (reach.positions_m - start) @ ahead
    aside_2 = ((reach.positions_m - start) ** 2).sum(axis=1) - along**2
    apart = np.sqrt(
        np.maximum((agents.covered_m(reach.times_s) - along) ** 2 + np.maximum(aside_2, 0.0), 0.0)
    )
    steps = np.diff(reach.times_s)
    weights = np.concatenate([steps, [0.0]]) + np.concatenate([[0.0], steps])
    deviations = apart @ (weights / weights.sum()) / reach.distance_m
    return DeviationMap(
        grid,
        "mean distance",
        deviations.reshape(grid.shape),
        agents.arrival_s.reshape(grid.shape),
        reach.duration_s,
    )


def _covered(progress: FloatArray, skews: FloatArray) -> FloatArray:
    """Return the share of the way; `app.science.simulation.skewed_jerk` for arrays."""
    w = 1.0 - (1.0 - np.clip(progress, 0.0, 1.0)) ** skews
    return np.asarray(w**3 * (10.0 + w * (6.0 * w - 15.0)), dtype=np.float64)


def _speed(progress: FloatArray, skews: FloatArray) -> FloatArray:
    """Return the derivative of the share of the way by the share of the time."""
    rest = np.maximum(1.0 - progress, 1e-12)
    w = 1.0 - rest**skews
    return np.asarray(30.0 * (w * (1.0 - w)) ** 2 * skews * rest ** (skews - 1.0), dtype=np.float64)


def _between(
    speed: FloatArray, rows: IntArray, slow: IntArray, fast: IntArray, least: FloatArray
) -> FloatArray:
    """Return the progress at which the speed is `least`, between a slow and a fast place."""
    low, high = speed[rows, slow], speed[rows, fast]
    share = np.clip((least - low) / np.where(high == low, 1.0, high - low), 0.0, 1.0)
    found: FloatArray = _PROGRESS[slow] + share * (_PROGRESS[fast] - _PROGRESS[slow])
    return found
