"""The restricted likelihood of a mixed model, with its first and second derivatives.

With V the covariance of all observations, block-diagonal by participant,

    -2 l = log|V| + log|X' V^-1 X| + (y - X beta)' V^-1 (y - X beta) + (N - p) log 2 pi,
    beta = C X' V^-1 y,    C = (X' V^-1 X)^-1 = Cov(beta).

V is linear in its parameters phi, the lower triangle of G and sigma^2: V = sum phi_k D_k. With P =
V^-1 - V^-1 X C X' V^-1

    d(-2l)/dphi_k          = tr(P D_k) - y' P D_k P y,
    d2(-2l)/dphi_k dphi_l  = -tr(P D_k P D_l) + 2 y' P D_k P D_l P y,
    dC/dphi_k              = C X' V^-1 D_k V^-1 X C.

All terms are sums over participants, so the cost grows linearly with their number.

Source: Harville 1977, J Am Stat Assoc 72, 320.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from app.science.statistics.arrays import FloatArray, IntArray


class Blocks(NamedTuple):
    """Observations of P participants with up to n each, padded with rows of zeros.

    y (P, n), x (P, n, p), z (P, n, r), and own (P, n): whether the row is an observation.
    """

    y: FloatArray
    x: FloatArray
    z: FloatArray
    own: npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Rows:
    """Observations: y (N,), x (N, p), z (N, r) and the participant of each, codes (N,)."""

    y: FloatArray
    x: FloatArray
    z: FloatArray
    codes: IntArray

    @cached_property
    def blocks(self) -> Blocks:
        """The same observations by participant, so that numpy processes all at the same time."""
        counts = np.bincount(self.codes)
        order = np.argsort(self.codes, kind="stable")
        who = self.codes[order]
        place = np.arange(len(who)) - (np.cumsum(counts) - counts)[who]

        def filled(values: FloatArray) -> FloatArray:
            block = np.zeros((len(counts), int(counts.max()), *values.shape[1:]))
            block[who, place] = values[order]
            return block

        own = np.arange(counts.max()) < counts[:, np.newaxis]
        return Blocks(filled(self.y), filled(self.x), filled(self.z), own)


@dataclass(frozen=True, eq=False)
class Restricted:
    """The restricted likelihood at given variances; m parameters phi, sigma^2 the last.

    Attributes:
        beta: (p,) fixed effects.
        covariance: (p, p) covariance of beta.
        criterion: -2 l.
        gradient: (m,) gradient of the criterion.
        hessian: (m, m) Hessian of the criterion.
        slopes: (m, p, p) derivatives of `covariance` by each parameter.
    """

    beta: FloatArray
    covariance: FloatArray
    criterion: float
    gradient: FloatArray
    hessian: FloatArray
    slopes: FloatArray

    @property
    def decrement(self) -> float:
        """The expected decrease of the criterion to its optimum, by a quadratic approximation."""
        step = np.linalg.lstsq(self.hessian, self.gradient, rcond=None)[0]
        return float(self.gradient @ step) / 2.0


def restricted_likelihood(rows: Rows, g: FloatArray, variance: float) -> Restricted:
    """Evaluate the restricted likelihood at G (r, r) and sigma^2, in squared units of y.

    r may be zero.
    """
    count, width = rows.x.shape
    y, x, z, own = rows.blocks
    v = z @ g @ z.transpose(0, 2, 1) + variance * np.eye(y.shape[1])
    weights = _inverse(v)
    wx = weights @ x
    normal = np.tensordot(x, wx, axes=((0, 1), (0, 1)))
    covariance = _inverse(normal)
    beta = covariance @ np.tensordot(wx, y, axes=((0, 1), (0, 1)))
    squares, gradient, hessian, slopes = _derivatives(rows.blocks, weights, covariance, beta)
    # Each padding row contributes a factor of sigma^2 to the determinant.
    log_det = np.linalg.slogdet(v)[1].sum() - (~own).sum() * np.log(variance)
    criterion = log_det + np.linalg.slogdet(normal)[1] + squares
    criterion += (count - width) * np.log(2.0 * np.pi)
    return Restricted(beta, covariance, float(criterion), gradient, hessian, slopes)


def _derivatives(
    blocks: Blocks, weights: FloatArray, covariance: FloatArray, beta: FloatArray
) -> tuple[float, FloatArray, FloatArray, FloatArray]:
    """Return weighted sum of squares, gradient, Hessian and derivatives of the covariance."""
    d = _parts(blocks)
    residual = blocks.y - blocks.x @ beta
    weighted = (weights @ residual[:, :, np.newaxis])[:, :, 0]
    w, wx = weights[:, np.newaxis], (weights @ blocks.x)[:, np.newaxis]
    wd, dwx = w @ d, d @ wx
    pulled = (d @ weighted[:, np.newaxis, :, np.newaxis])[..., 0]
    first = np.trace(wd, axis1=2, axis2=3).sum(axis=0)
    first -= np.einsum("gkn,gn->k", pulled, weighted)
    a = (wx.transpose(0, 1, 3, 2) @ dwx).sum(axis=0)
    u = (pulled[:, :, np.newaxis] @ wx).sum(axis=0)[:, 0]
    ca = covariance @ a
    # tr(P D_k P D_l) has three parts; the middle one is tr(C X'W D_k W D_l W X).
    traces = np.einsum("gkij,glji->kl", wd, wd)
    traces -= 2.0 * np.tensordot(dwx @ covariance, w @ dwx, axes=((0, 2, 3), (0, 2, 3)))
    traces += np.einsum("kij,lji->kl", ca, ca)
    forms = np.tensordot(pulled, pulled @ weights, axes=((0, 2), (0, 2)))
    forms -= u @ covariance @ u.T
    first -= np.trace(ca, axis1=1, axis2=2)
    squares = float((residual * weighted).sum())
    return squares, first, 2.0 * forms - traces, ca @ covariance


def _parts(blocks: Blocks) -> FloatArray:
    """Return the derivative of each participant's V by each parameter, (P, m, n, n)."""
    z, size = blocks.z, blocks.z.shape[2]
    columns = z.transpose(2, 0, 1)
    parts = []
    for i in range(size):
        for j in range(i + 1):
            product = columns[i][:, :, np.newaxis] * columns[j][:, np.newaxis, :]
            parts.append(product if i == j else product + product.transpose(0, 2, 1))
    return np.stack([*parts, np.eye(z.shape[1]) * blocks.own[:, :, np.newaxis]], axis=1)


def _inverse(matrices: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.inv(matrices), dtype=np.float64)
