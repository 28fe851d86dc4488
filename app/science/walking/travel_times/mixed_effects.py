"""A curve of travel time with effects of people: its posterior, and draws for somebody new.

Walk j of person i on path x takes

    log T_ij = log f(x_ij; beta + b_i) + e_ij
    b_i  ~ N(0, Sigma)                people differ in the curve's first q coefficients, q = 1 or 2
    e_ij ~ t_nu(0, s_share^2 + (s_seconds / f(x_ij))^2)    a share of the time, and some seconds

with the curve f of `curves`. Walks of one person share b_i and so are not counted as independent. A
prediction for somebody new adds up what is not known: beta, the new person's b, and the single
walk's e.

With few people the standard deviations are hardly known themselves, and a prediction that takes
them as known is too narrow. So they are integrated over: a normal distribution mixed over its
unknown scale is Student's t, with heavy tails for three people and hardly any for fifty. beta has a
wide normal prior and is integrated out exactly, with the curve linearised where it fits best
(Lindstrom and Bates 1990, "Nonlinear mixed effects models for repeated measures data"). Standard
deviations have log-normal priors that span a factor of seven each way, since a prior flat in the
logarithm is the one whose predictive intervals are Student's; they are drawn by adaptive importance
sampling (Cappe et al. 2004, "Population Monte Carlo"). The tails of single walks are a choice
among a few nu, and an unusual walk is trusted less by as much (Lange et al. 1989, "Robust
statistical modeling using the t distribution"). All of it is reproducible by the seed.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import lgamma, log, pi

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import WalkingError
from app.science.walking.travel_times.curves import Curve, TimedWalks

KEPT = 400
"""Draws of the posterior that are kept: all that is needed for predictions."""
SHARE, SECONDS = 0.08, 0.25
"""Medians of the priors of a single walk's deviation: share of the time, and seconds."""
PRIOR_SD, CORRELATION_SD = 1.0, 0.5
"""Widths of the priors of a log standard deviation, and of a correlation's inverse tanh."""
TAILS = (3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 25.0, 50.0)
"""Degrees of freedom of single walks; their prior is Gamma(2, .1) (Juarez and Steel 2010)."""
MOST_SD, FARTHEST = 0.5, 1.5
"""Largest deviation of the logarithm of a walk's time: standard deviation, and single draw."""
_LEAST, _MOST = log(1e-3), log(3.0)
_PROPOSAL_TAILS = 5.0
_TRIALS, _FINAL_TRIALS, _ROUNDS, _EVEN = 250, 2000, 10, 0.15
_GAUSS_NEWTON, _OUTER, _SETTLED = 12, 5, 0.05
_STEP = 1e-4
_Solve = Callable[[FloatArray], "_Solved"]


@dataclass(frozen=True, eq=False)
class Posterior:
    """What was learnt of a curve: S draws of all that is not known.

    Attributes:
        curve: the curve.
        coefficients: (S, p) of a median person.
        between: (S, q, q) covariances between people, of the first q coefficients.
        within: (S, 2) standard deviations of single walks: share of the time, and seconds.
        tails: degrees of freedom of single walks.
    """

    curve: Curve
    coefficients: FloatArray
    between: FloatArray
    within: FloatArray
    tails: float

    def people(self, count: int, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
        """Draw new people: their coefficients (count, p), and their `within` (count, 2)."""
        at = rng.integers(0, len(self.coefficients), count)
        values = self.coefficients[at].copy()
        q = self.between.shape[1]
        cholesky = np.linalg.cholesky(self.between[at])
        values[:, :q] += np.einsum("spq,sq->sp", cholesky, rng.standard_normal((count, q)))
        return values, self.within[at]

    def draw(
        self, walk: TimedWalks, count: int, rng: np.random.Generator
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Draw walks of new people on one path.

        Args:
            walk: a single walk; its duration is not used.
            count: number of draws.
            rng: random generator.

        Returns:
            Travel times (count,) in seconds, the people's coefficients (count, p), and the time of
            each walk over the median time of its person (count,).
        """
        values, within = self.people(count, rng)
        middle_s = self.curve.times_s(walk, values[:, None])[:, 0]
        sd = np.sqrt(_variances(within, middle_s[:, None])[:, 0])
        longer = np.exp(np.clip(sd * rng.standard_t(self.tails, count), -FARTHEST, FARTHEST))
        return middle_s * longer, values, longer


@dataclass(frozen=True, eq=False)
class _Linear:
    """The curve linearised, for walks sorted by person.

    Attributes:
        response, design: (N,) and (N, p).
        middle_s: (N,) the times at which it was linearised.
        trust: (N,) weights of the walks.
        tails: degrees of freedom of single walks.
    """

    response: FloatArray
    design: FloatArray
    middle_s: FloatArray
    trust: FloatArray
    tails: float


@dataclass(frozen=True, eq=False)
class _Solved:
    """The marginal density of S vectors of scales, and what is expected given each.

    Attributes:
        log_density: (S,).
        mean, covariance: (S, p) and (S, p, p) of beta.
        effects: (S, n, q) expected b_i of n people.
    """

    log_density: FloatArray
    mean: FloatArray
    covariance: FloatArray
    effects: FloatArray


def posterior_of(
    walks: TimedWalks, curve: Curve, rng: np.random.Generator, kept: int = KEPT
) -> Posterior:
    """Learn a curve from walks of two people or more; raise WalkingError if there is only one."""
    if len(walks.persons) < 2:
        raise WalkingError(
            f"All {len(walks)} walks are of one person, {walks.subjects[0]!r}: how people differ"
            " cannot be learnt from one. Give walks of two or more."
        )
    problem = _Problem(walks, curve)
    scales, spread = problem.prior_scales, np.diag(problem.prior_scale_sds**2)
    for _ in range(_OUTER):
        linear = problem.linearised(scales)
        before, (scales, spread) = scales, _adapted(problem.at(linear), scales, spread, rng)
        if np.abs(scales - before).max() < _SETTLED:
            break
    solve = problem.at(problem.linearised(scales))
    points, log_weights = _weighted(solve, scales, spread, _FINAL_TRIALS, rng)
    chosen = points[rng.choice(len(points), size=kept, p=_normalised(log_weights))]
    solved = solve(chosen)
    noise = rng.standard_normal(solved.mean.shape)
    wander = np.einsum("spr,sr->sp", np.linalg.cholesky(solved.covariance), noise)
    q = problem.q
    within = np.exp(chosen[:, q : q + 2])
    tails = problem.linearised(scales).tails
    return Posterior(curve, solved.mean + wander, _covariances(chosen, q), within, tails)


class _Problem:
    """The walks, sorted by person, with the curve and the priors.

    A vector of scales is: the log standard deviations between people (q), those within (2), and
    for q = 2 the inverse tanh of the correlation.
    """

    def __init__(self, walks: TimedWalks, curve: Curve) -> None:
        self.walks = walks.select(np.argsort(np.array(walks.subjects), kind="stable"))
        self.curve = curve
        self.log_s = np.log(self.walks.durations_s)
        self.person = np.unique(np.array(self.walks.subjects), return_inverse=True)[1]
        first = np.flatnonzero(np.diff(self.person, prepend=-1))
        self.people = list(zip(first, np.append(first[1:], len(walks)), strict=True))
        own = curve.coefficients(walks.others.shape[1])
        self.prior_mean = np.array([one.mean for one in own])
        self.prior_sd = np.array([one.sd for one in own])
        between = [one.between for one in own if one.between > 0.0]
        self.q = len(between)
        correlations = [0.0] * (self.q == 2)
        self.prior_scales = np.array([*np.log([*between, SHARE, SECONDS]), *correlations])
        self.prior_scale_sds = np.array(
            [PRIOR_SD] * (self.q + 2) + [CORRELATION_SD for _ in correlations]
        )

    def at(self, linear: _Linear) -> _Solve:
        """Return the marginal density as a function of scales alone."""
        return lambda scales: self.solved(linear, scales)

    def linearised(self, scales: FloatArray) -> _Linear:
        """Linearise the curve where it fits best for these scales, and weigh unusual walks."""
        values, effects = self.prior_mean.copy(), np.zeros((len(self.people), self.q))
        trust, tails = np.ones(len(self.walks)), TAILS[-1]
        for _ in range(_GAUSS_NEWTON):
            linear = self._linear_at(values, effects, trust, tails)
            solved = self.solved(linear, scales[None])
            change = np.clip(solved.mean[0] - values, -0.5, 0.5)
            values, effects = values + change, np.clip(solved.effects[0], -1.0, 1.0)
            tails, trust = self._weighed(linear, values, effects, scales)
        return self._linear_at(values, effects, trust, tails)

    def _linear_at(
        self, values: FloatArray, effects: FloatArray, trust: FloatArray, tails: float
    ) -> _Linear:
        own = self._own(values, effects)
        middle_s = self.curve.times_s(self.walks, own)
        columns = []
        for at in range(len(values)):
            step = _STEP * np.eye(len(values))[at]
            up, down = (self.curve.times_s(self.walks, own + way * step) for way in (1, -1))
            columns.append((np.log(up) - np.log(down)) / (2.0 * _STEP))
        design = np.stack(columns, axis=-1)
        response = self.log_s - np.log(middle_s) + np.einsum("np,np->n", design, own)
        return _Linear(response, design, middle_s, trust, tails)

    def _own(self, values: FloatArray, effects: FloatArray) -> FloatArray:
        own = np.tile(values, (len(self.walks), 1))
        own[:, : self.q] += effects[self.person]
        return own

    def _weighed(
        self, linear: _Linear, values: FloatArray, effects: FloatArray, scales: FloatArray
    ) -> tuple[float, FloatArray]:
        """Return how heavy the tails of single walks are, and how far to trust each walk."""
        off = linear.response - np.einsum("np,np->n", linear.design, self._own(values, effects))
        within = np.exp(scales[None, self.q : self.q + 2])
        z2 = off**2 / _variances(within, linear.middle_s)[0]
        scores = [_log_t(z2, tails) + np.log(tails) - 0.1 * tails for tails in TAILS]
        tails = TAILS[int(np.argmax(scores))]
        return tails, (tails + 1.0) / (tails + z2)

    def solved(self, linear: _Linear, scales: FloatArray) -> _Solved:
        """Integrate people's effects and beta out, for vectors (S, v) of scales."""
        q, x, y = self.q, linear.design, linear.response
        variances = _variances(np.exp(scales[:, q : q + 2]), linear.middle_s) / linear.trust
        weights = 1.0 / variances
        count, p = x.shape
        squares = (x[:, :, None] * x[:, None, :]).reshape(count, -1)
        products = np.concatenate([squares, x * y[:, None]], axis=1)
        sums = np.stack([weights[:, a:b] @ products[a:b] for a, b in self.people], axis=1)
        xx = sums[..., : p * p].reshape(*sums.shape[:2], p, p)
        xy = sums[..., p * p :]
        covariance = _covariances(scales, q)
        inverse, determinant = _inverted(xx[:, :, :q, :q] + np.linalg.inv(covariance)[:, None])
        solution = inverse @ np.concatenate([xx[:, :, :q, :], xy[:, :, :q, None]], axis=-1)
        across = np.swapaxes(xx[:, :, :q, :], -1, -2)
        prior = 1.0 / self.prior_sd**2
        a = (xx - across @ solution[..., :-1]).sum(axis=1) + np.diag(prior)
        g = (xy - (across @ solution[..., -1:])[..., 0]).sum(axis=1) + prior * self.prior_mean
        c = weights @ y**2 - np.einsum("siq,siq->s", xy[:, :, :q], solution[..., -1])
        mean = np.linalg.solve(a, g[..., None])[..., 0]
        log_density = -0.5 * (
            np.log(variances).sum(axis=1)
            + len(self.people) * np.linalg.slogdet(covariance)[1]
            + np.log(determinant).sum(axis=1)
            + np.linalg.slogdet(a)[1]
            + c
            - np.einsum("sp,sp->s", g, mean)
            + (((scales - self.prior_scales) / self.prior_scale_sds) ** 2).sum(axis=1)
        )
        effects = solution[..., -1] - np.einsum("siqp,sp->siq", solution[..., :-1], mean)
        return _Solved(log_density, mean, np.linalg.inv(a), effects)


def _adapted(
    solve: _Solve, middle: FloatArray, spread: FloatArray, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Move a proposal to where the density is; return its middle (v,) and its spread (v, v).

    Each round, the draws are weighted by a power of the density that leaves enough of them alive.
    """
    for _ in range(_ROUNDS):
        points, log_weights = _weighted(solve, middle, spread, _TRIALS, rng)
        weights, power = _even(log_weights)
        middle = weights @ points
        away = points - middle
        spread = (away * weights[:, None]).T @ away + 1e-6 * np.eye(len(middle))
        if power == 1.0 and 1.0 / (weights**2).sum() >= _EVEN * _TRIALS:
            break
    return middle, spread


def _weighted(
    solve: _Solve, middle: FloatArray, spread: FloatArray, trials: int, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Draw scales (S, v) from a multivariate t, and return them with their log weights (S,)."""
    count = len(middle)
    z = rng.standard_normal((trials, count))
    z /= np.sqrt(rng.chisquare(_PROPOSAL_TAILS, (trials, 1)) / _PROPOSAL_TAILS)
    points = np.clip(middle + z @ np.linalg.cholesky(spread).T, _LEAST, _MOST)
    squared = (z**2).sum(axis=1)
    log_proposal = -0.5 * (_PROPOSAL_TAILS + count) * np.log1p(squared / _PROPOSAL_TAILS)
    return points, solve(points).log_density - log_proposal


def _even(log_weights: FloatArray) -> tuple[FloatArray, float]:
    """Temper weights until at least a tenth of the draws counts; return them and the power."""
    power = 1.0
    while True:
        weights = _normalised(power * log_weights)
        if 1.0 / (weights**2).sum() >= 0.1 * len(weights) or power < 1e-6:
            return weights, power
        power *= 0.7


def _normalised(log_weights: FloatArray) -> FloatArray:
    weights = np.exp(log_weights - log_weights.max())
    found: FloatArray = weights / weights.sum()
    return found


def _inverted(matrices: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return inverses and determinants of matrices (..., q, q) for q = 1 or 2.

    Written out, because a library call for each of many small matrices takes most of the time.
    """
    if matrices.shape[-1] == 1:
        return 1.0 / matrices, matrices[..., 0, 0]
    a, b = matrices[..., 0, 0], matrices[..., 0, 1]
    c, d = matrices[..., 1, 0], matrices[..., 1, 1]
    determinant = a * d - b * c
    inverse = np.stack([np.stack([d, -b], axis=-1), np.stack([-c, a], axis=-1)], axis=-2)
    return inverse / determinant[..., None, None], determinant


def _covariances(scales: FloatArray, q: int) -> FloatArray:
    """Return people's covariances (S, q, q)."""
    sds = np.exp(scales[:, :q])
    found: FloatArray = sds[:, :, None] * sds[:, None, :] * np.eye(q)
    if q == 2:
        found[:, 0, 1] = found[:, 1, 0] = np.tanh(scales[:, -1]) * sds[:, 0] * sds[:, 1]
    return found


def _variances(within: FloatArray, middle_s: FloatArray) -> FloatArray:
    """Return the variances (S, N) of a walk's logarithm, for deviations (S, 2)."""
    found: FloatArray = within[:, :1] ** 2 + (within[:, 1:] / middle_s) ** 2
    return np.minimum(found, MOST_SD**2)


def _log_t(z2: FloatArray, tails: float) -> float:
    """Return the log density of Student's t at squares of standardised deviations, summed."""
    constant = lgamma((tails + 1.0) / 2.0) - lgamma(tails / 2.0) - 0.5 * log(tails * pi)
    return float((constant - 0.5 * (tails + 1.0) * np.log1p(z2 / tails)).sum())
