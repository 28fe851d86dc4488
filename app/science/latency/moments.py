"""Find a delay that changes for moments only, which the mean over a phase or a piece of it hides.

A delay that alternates every second between 100 and 200 ms fits best at 150, in every piece of the
phase. Therefore each second is also correlated on its own (`correlation`, the same formula): its
lag is the one at which its correlation is highest, to a step of the grid. A second counts if the
target moves in it and its correlation is above 0.9. It deviates if its lag differs from the median
second's by more than given, and fits better there by at least 0.05: a movement that repeats itself
fits nearly as well a repetition later.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.latency.correlation import COARSE_BANDWIDTH_S, turning
from app.science.latency.smoothing import BoolArray, smoothed
from app.science.latency.stretches import GRID_S, Stretch
from app.science.rotations import FloatArray

_WINDOW = round(1.0 / GRID_S)
_EVERY = 2  # Every second frame of the grid is enough, and takes half the time.
_CLEAR = 0.9
_BETTER = 0.05
_FEWEST = 3
_FEWEST_SHARE = 0.05


@dataclass(frozen=True)
class Moments:
    """The seconds of a phase whose delay is another than usual.

    Attributes:
        usual_s: the delay of the median second.
        deviating_s: the delays of the seconds that deviate, in order of time.
        clear: the number of seconds that count.
    """

    usual_s: float
    deviating_s: tuple[float, ...]
    clear: int

    @property
    def changed(self) -> bool:
        """Whether enough seconds deviate: three, and a twentieth of those that count."""
        return len(self.deviating_s) >= max(_FEWEST, _FEWEST_SHARE * self.clear)


def moments_of(
    parts: Sequence[Stretch],
    lowest_s: float,
    highest_s: float,
    *,
    moving_rad_s: float,
    least_s: float,
) -> Moments | None:
    """Return the seconds whose delay differs from the usual by more than `least_s`.

    Args:
        parts: the stretches of a phase.
        lowest_s, highest_s: the range of lags to search.
        moving_rad_s: a second counts if the target's fastest joint turns faster in it.
        least_s: the smallest difference that is no accident.

    Returns:
        None without a second that counts.
    """
    lags = np.arange(round(lowest_s / GRID_S), round(highest_s / GRID_S) + 1)
    clear = [
        values[(values.max(axis=1) > _CLEAR) & moves]
        for part in parts
        for values, moves in [_correlations(part, lags, moving_rad_s)]
    ]
    values = np.concatenate([*clear, np.empty((0, len(lags)))])
    if len(values) == 0:
        return None
    best = values.argmax(axis=1)
    usual = int(np.median(best))
    better = values.max(axis=1) - values[:, usual] >= _BETTER
    # A lag is known to a step of the grid.
    far = np.abs(best - usual) * GRID_S > least_s + GRID_S
    deviating = lags[best[far & better]] * GRID_S
    return Moments(float(lags[usual] * GRID_S), tuple(deviating.tolist()), len(values))


def _correlations(
    part: Stretch, lags: npt.NDArray[np.intp], moving_rad_s: float
) -> tuple[FloatArray, BoolArray]:
    """Return the correlation of each second at each lag, and in which seconds the target moves."""
    before, after = max(int(lags[-1]), 0), max(-int(lags[0]), 0)
    count = len(part.grid_s) // _WINDOW
    history_s = part.grid_s[0] + GRID_S * np.arange(-before, len(part.grid_s) + after)
    actual, known = turning(smoothed(part.actual, part.grid_s, COARSE_BANDWIDTH_S))
    target, target_known = turning(smoothed(part.target, history_s, COARSE_BANDWIDTH_S))
    actual *= (known & part.active[:, np.newaxis])[..., np.newaxis]
    target *= target_known[..., np.newaxis]

    def by_second(turns: FloatArray, first: int) -> FloatArray:
        stretch = turns[first : first + count * _WINDOW]
        return np.asarray(stretch.reshape(count, _WINDOW, -1)[:, ::_EVERY])

    a = by_second(actual, 0)
    a_energy = np.einsum("wtk,wtk->w", a, a)
    values = np.zeros((count, len(lags)))
    for column, lag in enumerate(lags.tolist()):
        b = by_second(target, before - lag)
        energy = np.sqrt(a_energy * np.einsum("wtk,wtk->w", b, b))
        np.divide(np.einsum("wtk,wtk->w", a, b), energy, out=values[:, column], where=energy > 0.0)
    fastest = np.linalg.norm(target[before : before + count * _WINDOW], axis=-1).max(axis=1)
    moves = fastest.reshape(count, _WINDOW).max(axis=1) > moving_rad_s
    return values, np.asarray(moves)
