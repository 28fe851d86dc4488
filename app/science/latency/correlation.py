"""Coarse search for the lags at which the joints of two bodies turn most similarly.

The angular velocities of all joints (vectors in the parent's frame) are correlated over the grid
for all lags L simultaneously, over the times t that are active and at which both bodies are known:

    C(L) = sum a(t) . b(t - L) / sqrt( sum |a(t)|^2  sum |b(t - L)|^2 ).

Velocities are unaffected by constant differences between the two bodies, such as a sagging arm.

Source: Padfield (2012), "Masked object registration in the Fourier domain", IEEE Trans. Image
Processing 21:2706, here in one dimension and without subtracting the mean.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.latency.smoothing import BoolArray, Curves, smoothed
from app.science.latency.stretches import GRID_S, Stretch
from app.science.rotations import FloatArray, conjugate, multiply

COARSE_BANDWIDTH_S = 0.05
# Squared rad/s, summed over frames: rounding errors are below it, movement is far above.
_LEAST_ENERGY = 1e-6
# A lag at which little of the movement overlaps would give a high correlation on little evidence.
_LEAST_SHARE = 0.1


@dataclass(frozen=True, eq=False)
class Correlation:
    """The correlation `values` (k,) of two bodies' movement at the lags `lags_s` (k,).

    The lags are a grid; `movement_s` is the active time in which the target moves.
    """

    lags_s: FloatArray
    values: FloatArray
    movement_s: float

    def peaks(self, within: float, at_most: int) -> list[int]:
        """Return indices of the local maxima at most `within` below the highest value, best first.

        Empty if the highest value is at an end of the range: then the true peak lies outside it.
        """
        c = self.values
        if int(np.argmax(c)) in (0, len(c) - 1):
            return []
        inner = np.flatnonzero((c[1:-1] >= c[:-2]) & (c[1:-1] > c[2:])) + 1
        near = inner[c[inner] >= c.max() - within]
        best: list[int] = near[np.argsort(-c[near], kind="stable")].tolist()
        return best[:at_most]


def correlate(
    parts: Sequence[Stretch], lowest_s: float, highest_s: float, moving_rad_s: float
) -> Correlation:
    """Correlate all stretches together, and sum up the active time in which the target moves.

    The target counts as moving while its fastest joint turns faster than `moving_rad_s`.
    """
    lags = np.arange(round(lowest_s / GRID_S), round(highest_s / GRID_S) + 1)
    before, after = max(int(lags[-1]), 0), max(-int(lags[0]), 0)
    sums = np.zeros((3, len(lags)))
    movement_s = 0.0
    for part in parts:
        count = len(part.grid_s)
        history_s = part.grid_s[0] + GRID_S * np.arange(-before, count + after)
        actual, known = turning(smoothed(part.actual, part.grid_s, COARSE_BANDWIDTH_S))
        target, target_known = turning(smoothed(part.target, history_s, COARSE_BANDWIDTH_S))
        present = np.linalg.norm(target[before : before + count], axis=-1).max(axis=1)
        movement_s += GRID_S * int(((present > moving_rad_s) & part.active).sum())
        known = known & part.active[:, np.newaxis]
        actual *= known[..., np.newaxis]
        sums += _masked_sums(actual, known, target, target_known)[:, before - lags]
    # Rounding errors of the transforms may leave an energy of zero slightly negative.
    energy = np.sqrt(np.maximum(sums[1], 0.0) * np.maximum(sums[2], 0.0))
    enough = energy > max(_LEAST_ENERGY, _LEAST_SHARE * float(energy.max()))
    values = np.zeros(energy.shape)
    np.divide(sums[0], energy, out=values, where=enough)
    return Correlation(lags.astype(np.float64) * GRID_S, values, movement_s)


def turning(curves: Curves) -> tuple[FloatArray, BoolArray]:
    """Return angular velocities (k, joints, 3) in the parent's frame, and where they are known."""
    rate = 2.0 * multiply(curves.rates, conjugate(curves.values))[..., 1:]
    return rate, np.broadcast_to(curves.known, rate.shape[:2])


def _masked_sums(
    a: FloatArray, a_known: BoolArray, b: FloatArray, b_known: BoolArray
) -> FloatArray:
    """Return the three sums of C over t, with a at t and b at t + m, for each shift m.

    The result is (3, at least len(b)).
    """
    from scipy import fft  # slow to import, and rarely needed

    size = fft.next_fast_len(len(a) + len(b), real=True)

    def spectrum(values: FloatArray | BoolArray) -> npt.NDArray[np.complex128]:
        columns = np.asarray(values, dtype=np.float64).reshape(len(values), -1)
        return np.asarray(fft.rfft(columns, n=size, axis=0), dtype=np.complex128)

    pairs: tuple[tuple[FloatArray | BoolArray, FloatArray | BoolArray], ...] = (
        (a, b),
        (np.sum(a * a, axis=-1), b_known),
        (a_known, np.sum(b * b, axis=-1)),
    )
    return np.stack(
        [
            fft.irfft(np.sum(np.conj(spectrum(left)) * spectrum(right), axis=1), n=size)
            for left, right in pairs
        ]
    )
