"""Poses that no body could take so quickly after the one before."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.science.stream_quality.limits import QualityLimits

Bools = NDArray[np.bool_]
Floats = NDArray[np.floating[Any]]


def jumps(
    times_s: NDArray[np.float64],
    rotations: Floats,
    positions_m: Floats,
    usual_s: float,
    limits: QualityLimits,
) -> tuple[Bools, Bools]:
    """Which frames jump against the one before: joints (n - 1, 22), and the hips' place (n - 1,).

    Times (n,), rotations (n, 22, 4) and places (n, 3) must be usable. Frames that are told to be
    closer together than usual are a stutter of the clock rather than of the body, so an interval
    counts as `usual_s` at least.
    """
    passed_s = np.fmax(times_s[1:] - times_s[:-1], usual_s)
    cosine = np.einsum("njk,njk->nj", rotations[1:], rotations[:-1])
    # Beyond half a turn every rotation is within reach.
    half_turn = np.minimum(0.5 * limits.turn_rad_per_s * passed_s, 0.5 * np.pi)
    turned = np.abs(cosine) < np.cos(half_turn)[:, np.newaxis]
    with np.errstate(over="ignore", invalid="ignore"):  # a place may be any number
        step_m = positions_m[1:] - positions_m[:-1]
        moved_m = np.sqrt(np.einsum("nk,nk->n", step_m, step_m))
        return turned, moved_m > limits.root_m_per_s * passed_s
