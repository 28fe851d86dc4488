"""The likelihood of ordinal answers with random participant effects, and its gradient.

Participant i's effect is u = sigma v with v ~ N(0, 1); the observation j has the predictor t = x_j
beta + sigma v. The likelihood of a participant,

    L_i = integral of exp(g(v)) dv / sqrt(2 pi),    g(v) = sum_j log p_j(v) - v^2 / 2,

has no closed form. Around the mode v0 with H = -g''(v0), Gauss-Hermite quadrature with nodes z_k
and weights w_k approximates it by

    L_i = sum_k w_k exp(z_k^2) exp(g(v0 + z_k sqrt(2 / H))) / sqrt(pi H),

which with one node is Laplace's approximation and with ten is accurate enough for publication. Mode
and width depend on the parameters; the gradient includes this (dv0 = g_vp / H, and dH by the third
derivatives), so it is exact for the approximation.

Source: Pinheiro and Bates 1995, J Comput Graph Stat 4, 12; Christensen 2019, `ordinal` for R.
"""

from dataclasses import dataclass
from functools import cache, cached_property
from typing import NamedTuple

import numpy as np
from numpy.polynomial.hermite import hermgauss

from app.science.statistics.arrays import FloatArray, IntArray
from app.science.statistics.mixed.cumulative_links import Link, Slopes, log_chance, slopes

_MODE_STEPS = 60
_MODE_TOLERANCE = 1e-11


@dataclass(frozen=True, eq=False)
class Answers:
    """Ordinal observations, grouped by participant.

    Attributes:
        categories: (N,) categories from 0 to K - 1, each of them observed.
        x: (N, p) predictors without an intercept, whose role the thresholds have.
        codes: (N,) participant of each, from 0 and never decreasing, so that the observations of a
            participant are contiguous.
        count: K, the number of categories.
    """

    categories: IntArray
    x: FloatArray
    codes: IntArray
    count: int

    @cached_property
    def participants(self) -> int:
        """The number of participants."""
        return int(self.codes[-1]) + 1

    @cached_property
    def starts(self) -> IntArray:
        """Index of each participant's first observation, (participants,)."""
        return np.searchsorted(self.codes, np.arange(self.participants)).astype(np.int64)


class Parameters(NamedTuple):
    """The parameters: (K - 1,) increasing thresholds, (p,) effects, and the participants' SD."""

    thresholds: FloatArray
    beta: FloatArray
    sd: float


def log_likelihood(
    answers: Answers, at: Parameters, link: Link, nodes: int
) -> tuple[float, FloatArray]:
    """Return the log-likelihood and its gradient by (thresholds, beta, sd).

    Args:
        answers: the observations.
        at: the parameters at which to evaluate; an sd of 0 is the model without participants.
        link: distribution of the latent variable.
        nodes: 1 for Laplace, more for adaptive Gauss-Hermite quadrature.
    """
    edges = np.concatenate(([-np.inf], at.thresholds, [np.inf]))
    base = answers.x @ at.beta
    upper, lower = edges[answers.categories + 1] - base, edges[answers.categories] - base
    mode = _mode(answers, at.sd, upper, lower, link)
    spread = at.sd * mode[answers.codes]
    here = slopes(link, upper - spread, lower - spread)
    curve = 1.0 - at.sd**2 * _sum(answers, here.tt)
    width = 1.0 / np.sqrt(curve)
    mode_by, width_by = _mode_derivatives(answers, at.sd, mode, width, here)
    z, log_weights = _quadrature(nodes)
    # Participants by nodes: where the integrand is evaluated, and its value there.
    v = mode[:, np.newaxis] + np.sqrt(2.0) * width[:, np.newaxis] * z
    shift = at.sd * v[answers.codes]
    there = slopes(link, upper[:, np.newaxis] - shift, lower[:, np.newaxis] - shift)
    heights = _sum(answers, there.log_p) - 0.5 * v**2 + z**2 + log_weights
    top = heights.max(axis=1, keepdims=True)
    shares = np.exp(heights - top)
    totals = shares.sum(axis=1, keepdims=True)
    value = float((np.log(width) + top[:, 0] + np.log(totals[:, 0])).sum())
    value -= 0.5 * np.log(np.pi) * answers.participants
    shares = shares / totals
    by_v = at.sd * _sum(answers, there.t) - v
    gradient = _gradient(answers, shares, there, v)
    gradient += (width_by / width).sum(axis=1)
    gradient += mode_by @ (shares * by_v).sum(axis=1)
    gradient += width_by @ (shares * by_v * np.sqrt(2.0) * z).sum(axis=1)
    return value, gradient


def participant_modes(answers: Answers, at: Parameters, link: Link) -> FloatArray:
    """Return the most likely effect of each participant, (participants,), on the latent scale."""
    edges = np.concatenate(([-np.inf], at.thresholds, [np.inf]))
    base = answers.x @ at.beta
    upper, lower = edges[answers.categories + 1] - base, edges[answers.categories] - base
    return at.sd * _mode(answers, at.sd, upper, lower, link)


def _mode(
    answers: Answers, sd: float, upper: FloatArray, lower: FloatArray, link: Link
) -> FloatArray:
    """Return the v that maximises g for each participant, by Newton's method with bisection.

    Bisection replaces steps that leave the bracket. g'' is -1 or less, so the mode is no further
    from v than the magnitude of g' at v.
    """
    v = np.zeros(answers.participants)
    if sd == 0.0:
        return v
    low, high = np.full_like(v, -np.inf), np.full_like(v, np.inf)
    for _ in range(_MODE_STEPS):
        shift = sd * v[answers.codes]
        _, first, second = log_chance(link, upper - shift, lower - shift)
        slope = sd * _sum(answers, first) - v
        rising = slope > 0.0
        low = np.maximum(low, np.where(rising, v, v + slope))
        high = np.minimum(high, np.where(rising, v + slope, v))
        nearer = v + slope / (1.0 - sd**2 * _sum(answers, second))
        outside = (nearer < low) | (nearer > high)
        moved = np.where(outside, 0.5 * (low + high), nearer)
        done = np.abs(moved - v).max() < _MODE_TOLERANCE
        v = moved
        if done:
            break
    return v


def _mode_derivatives(
    answers: Answers, sd: float, mode: FloatArray, width: FloatArray, here: Slopes
) -> tuple[FloatArray, FloatArray]:
    """Return the derivatives of each participant's mode and width by each parameter.

    Both are (parameters, participants).
    """
    mixed = _by_parameters(answers, here.upper_t, here.lower_t, here.tt)
    bent = _by_parameters(answers, here.upper_tt, here.lower_tt, here.ttt)
    t, tt, ttt = (_sum(answers, part) for part in (here.t, here.tt, here.ttt))
    # The predictor contains sd * v, so each derivative by v adds a factor of sd.
    g_vp = np.vstack([sd * mixed, t + sd * mode * tt])
    g_vvp = np.vstack([sd**2 * bent, 2.0 * sd * tt + sd**2 * mode * ttt])
    mode_by = g_vp * width**2
    curve_by = -(g_vvp + sd**3 * ttt * mode_by)
    return mode_by, -0.5 * width**3 * curve_by


def _gradient(answers: Answers, shares: FloatArray, there: Slopes, v: FloatArray) -> FloatArray:
    """Sum the derivatives at fixed v over the nodes, weighted by the nodes' shares."""
    own = shares[answers.codes]
    upper, lower, t = ((own * part).sum(axis=1) for part in (there.upper, there.lower, there.t))
    parts = _by_parameters(answers, upper, lower, t).sum(axis=1)
    by_sd = (own * there.t * v[answers.codes]).sum()
    return np.append(parts, by_sd)


def _by_parameters(
    answers: Answers, upper: FloatArray, lower: FloatArray, t: FloatArray
) -> FloatArray:
    """Sum the derivatives of observations by participant: (thresholds and beta, participants)."""
    count, size = answers.count, answers.participants
    place = answers.categories * size + answers.codes
    # The upper threshold of the last category and the lower one of the first are not parameters.
    up = np.bincount(place, upper, count * size).reshape(count, size)[:-1]
    down = np.bincount(place, lower, count * size).reshape(count, size)[1:]
    return np.vstack([up + down, _sum(answers, answers.x * t[:, np.newaxis]).T])


def _sum(answers: Answers, values: FloatArray) -> FloatArray:
    """Sum values (N, ...) over the observations of each participant."""
    total: FloatArray = np.add.reduceat(values, answers.starts, axis=0)
    return total


@cache
def _quadrature(nodes: int) -> tuple[FloatArray, FloatArray]:
    """Return the quadrature nodes and the logarithms of their weights."""
    z, weights = hermgauss(nodes)
    return z, np.log(weights)
