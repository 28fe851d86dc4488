"""The linear mixed model: fixed effects of the conditions, random effects of the participants.

For participant i with n_i observations

    y_i = X_i beta + Z_i b_i + e_i,    b_i ~ N(0, G),    e_i ~ N(0, sigma^2 I),

Z a column of ones (how high this participant answers) and, if requested, a slope (how strongly this
participant reacts). G and sigma^2 are estimated by REML with statsmodels' `MixedLM`, beta by
generalised least squares given them. statsmodels tests beta against the normal distribution, which
rejects too often with a dozen participants; so degrees of freedom are computed here by
Satterthwaite's method (`term_tests`), as in lmerTest.

If a variance is estimated as zero, the fit is called singular: that random effect then does not
contribute to the degrees of freedom, and the result reports it. Singular is not wrong, but with a
slope it mostly means that there are too few observations for one. `search` describes how the
variances are found.

If participants react differently, a model without their slopes tests the effect of a condition
against the wrong error: in the table of error rates it rejects twice as often as it should, with
the slope it does not. Include the slope unless there are reasons not to.

A missing observation must be left out beforehand: a mixed model uses the observed data, and is
valid if the reasons for missing depend only on observed data (missing at random).

Sources: Laird and Ware 1982, Biometrics 38, 963; Bates et al. 2015, J Stat Softw 67(1).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.science.statistics.arrays import FloatArray, IntArray
from app.science.statistics.mixed.design import Design
from app.science.statistics.mixed.likelihood import Restricted, Rows
from app.science.statistics.mixed.search import search
from app.science.statistics.mixed.terms import Covariate, Label, ModelError, participant_codes

_FEWEST_PARTICIPANTS = 3


@dataclass(frozen=True, eq=False)
class MixedModel:
    """A fitted linear mixed model; `term_tests` computes its tests.

    Attributes:
        random_names: `intercept` and, if there is one, the slope.
        random_covariance: (k, k) G, in squared units of the measure (per unit of the slope).
        residual_sd: sigma, in units of the measure.
        reml_criterion: -2 times the restricted log-likelihood; depends on the design's coding.
        observations, participants: the numbers of observations and participants.
        converged: whether the search ended at a minimum of the criterion.
        singular: whether a variance is zero or a correlation of random effects is 1.
        messages: sentences that a reader of the fit must know; empty if there are none.
        design: the fixed part of the model.
        restricted: fixed effects, their covariance, and the derivatives for degrees of freedom.
    """

    random_names: tuple[str, ...]
    random_covariance: FloatArray
    residual_sd: float
    reml_criterion: float
    observations: int
    participants: int
    converged: bool
    singular: bool
    messages: tuple[str, ...]
    design: Design
    restricted: Restricted

    @property
    def intraclass_correlation(self) -> float:
        """The share of the variance between participants, at a slope column of zero."""
        between = float(self.random_covariance[0, 0])
        return between / (between + self.residual_sd**2)


def fit_mixed_model(
    values: Sequence[float] | FloatArray,
    participants: Sequence[Label],
    design: Design,
    random_slope: Covariate | None = None,
) -> MixedModel:
    """Fit a linear mixed model by REML.

    Args:
        values: (N,) the measure, finite.
        participants: the participants of the N observations, by name.
        design: the design of the same N observations.
        random_slope: a single column whose effect differs between participants, correlated with
            their intercepts. The design should contain it too, or its mean effect is taken as zero.

    Raises:
        ModelError: lengths differ, a value is not finite or all are equal, there are fewer than
            three participants, or none of them has two observations.
    """
    y = np.asarray(values, dtype=np.float64)
    codes = participant_codes(participants)
    _check(y, codes, design)
    columns, names = [np.ones(len(y))], ["intercept"]
    if random_slope is not None:
        columns.append(random_slope.columns[:, 0])
        names.append(random_slope.name)
    z = np.column_stack(columns)
    found = search(Rows(y, design.matrix, z, codes))
    return MixedModel(
        random_names=tuple(names),
        random_covariance=found.g,
        residual_sd=float(np.sqrt(found.variance)),
        reml_criterion=found.restricted.criterion,
        observations=len(y),
        participants=int(codes.max()) + 1,
        converged=found.converged,
        singular=found.singular,
        messages=found.messages,
        design=design,
        restricted=found.restricted,
    )


def _check(y: FloatArray, codes: IntArray, design: Design) -> None:
    if not len(y) == len(codes) == len(design.matrix):
        raise ModelError(
            f"{len(y)} values, {len(codes)} participants' names and {len(design.matrix)} rows of "
            "the design do not fit; each observation needs one of each."
        )
    if not np.isfinite(y).all() or np.ptp(y) == 0.0:
        raise ModelError("The values must be finite, and not all the same.")
    counts = np.bincount(codes)
    if len(counts) < _FEWEST_PARTICIPANTS or counts.max() == 1:
        raise ModelError(
            f"{len(counts)} participants with at most {counts.max()} observations each are "
            "too few; give three or more, some with two or more."
        )
    if len(y) <= design.matrix.shape[1]:
        raise ModelError(
            f"{len(y)} observations are too few for {design.matrix.shape[1]} coefficients."
        )
