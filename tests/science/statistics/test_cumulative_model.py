"""Tests of cumulative link models against R's `ordinal`, and of their own properties."""

import csv
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import expit, ndtr

from app.science.statistics.mixed.cumulative_likelihood import Answers, Parameters, log_likelihood
from app.science.statistics.mixed.cumulative_links import Link
from app.science.statistics.mixed.cumulative_model import CumulativeModel, fit_cumulative_model
from app.science.statistics.mixed.cumulative_tests import (
    cumulative_contrasts,
    cumulative_term_tests,
    likelihood_ratio,
)
from app.science.statistics.mixed.design import Design, build_design
from app.science.statistics.mixed.terms import ModelError, factor


class Wine(NamedTuple):
    """Bitterness of wine, 1 to 5, rated by nine judges (Randall 1989)."""

    ratings: list[int]
    judges: list[str]
    design: Design

    def fit(self, nodes: int, link: Link = "logit") -> CumulativeModel:
        """Fit the model with random judges, or without judges for `nodes` of 0."""
        judges = self.judges if nodes else None
        return fit_cumulative_model(
            self.ratings, judges, self.design, link=link, nodes=max(nodes, 1)
        )


@pytest.fixture(scope="module")
def wine(shared_data: Path) -> Wine:
    """Return the example data of R's package `ordinal`."""
    with (shared_data / "statistics" / "ordinal_wine.csv").open() as file:
        rows = list(csv.DictReader(file))
    temp = factor("temp", [row["temp"] for row in rows])
    contact = factor("contact", [row["contact"] for row in rows])
    return Wine(
        [int(row["rating"]) for row in rows],
        [row["judge"] for row in rows],
        build_design([temp, contact]),
    )


def effects(model: CumulativeModel) -> list[float]:
    """Return only the estimates of the effects."""
    return [one.estimate for one in model.effects]


def test_the_plain_model_is_that_of_r(wine: Wine) -> None:
    """Effects, thresholds and log-likelihood equal those of ordinal::clm on its wine data."""
    model = wine.fit(0)
    assert effects(model) == pytest.approx([2.5031, 1.5278], abs=5e-5)
    found = [one.estimate for one in model.thresholds]
    assert found == pytest.approx([-1.3444, 1.2508, 3.4669, 5.0064], abs=5e-5)
    assert model.log_likelihood == pytest.approx(-86.492, abs=5e-4)
    assert [one.se for one in model.effects] == pytest.approx([0.5287, 0.4766], abs=5e-5)
    assert [one.between for one in model.thresholds] == ["1|2", "2|3", "3|4", "4|5"]


def test_the_mixed_model_by_laplace_is_that_of_r(wine: Wine) -> None:
    """With Laplace's approximation the mixed model equals that of ordinal::clmm."""
    model = wine.fit(1)
    assert effects(model) == pytest.approx([3.0630, 1.8349], abs=5e-5)
    assert model.participant_variance == pytest.approx(1.2795, abs=1e-4)
    assert model.log_likelihood == pytest.approx(-81.5654, abs=5e-5)
    assert [one.se for one in model.effects] == pytest.approx([0.5954, 0.5125], abs=1e-4)
    assert (model.converged, model.messages, model.participants) == (True, (), 9)


def test_the_mixed_model_by_quadrature_is_that_of_r(wine: Wine) -> None:
    """With ten quadrature points the mixed model equals that of ordinal::clmm."""
    model = wine.fit(10)
    assert effects(model) == pytest.approx([3.0619, 1.8334], abs=5e-5)
    assert model.log_likelihood == pytest.approx(-81.5325, abs=5e-5)


def test_contact_improves_the_model(wine: Wine) -> None:
    """The likelihood ratio of a term is twice the difference of two fits."""
    small = fit_cumulative_model(wine.ratings, wine.judges, build_design(wine.design.factors[:1]))
    expected = likelihood_ratio(small, wine.fit(1))
    assert expected.statistic == pytest.approx(
        2.0 * (wine.fit(1).log_likelihood - small.log_likelihood)
    )
    assert (expected.df, expected.method) == (1, "Laplace approximation")
    (found,) = cumulative_term_tests(wine.ratings, wine.judges, wine.design, terms=["contact"])
    assert found.test.p == pytest.approx(expected.p)
    assert expected.p < 0.001


@pytest.mark.parametrize("link", ["logit", "probit"])
@pytest.mark.parametrize("nodes", [1, 7])
def test_the_gradient_is_that_of_the_likelihood(wine: Wine, link: Link, nodes: int) -> None:
    """The analytic gradient equals numeric differences of the approximated likelihood."""
    order = np.argsort(wine.judges, kind="stable")
    codes = np.unique(np.array(wine.judges), return_inverse=True)[1][order]
    answers = Answers(
        np.array(wine.ratings)[order] - 1, wine.design.matrix[order, 1:], codes.astype(np.int64), 5
    )
    at = np.array([-1.1, 1.0, 2.9, 4.0, 1.7, 0.9, 0.8])

    def value(free: np.ndarray) -> float:
        parts = Parameters(free[:4], free[4:6], float(free[6]))
        return log_likelihood(answers, parts, link, nodes)[0]

    _, gradient = log_likelihood(answers, Parameters(at[:4], at[4:6], 0.8), link, nodes)
    differences = [(value(at + step) - value(at - step)) / 2e-5 for step in 1e-5 * np.eye(7)]
    assert gradient == pytest.approx(differences, abs=1e-6)


@pytest.mark.parametrize("link", ["logit", "probit"])
def test_quadrature_is_the_integral(link: Link) -> None:
    """Twenty quadrature nodes agree with adaptive integration over a participant's effect."""
    answers = Answers(np.array([0, 2, 1, 2]), np.zeros((4, 0)), np.zeros(4, dtype=np.int64), 3)
    f = expit if link == "logit" else ndtr

    def density(u: float) -> float:
        low, high = f(-0.5 - 1.3 * u), f(0.9 - 1.3 * u)
        return float(
            low * (1 - high) ** 2 * (high - low) * np.exp(-(u**2) / 2) / np.sqrt(2 * np.pi)
        )

    expected = np.log(quad(density, -12, 12)[0])
    at = Parameters(np.array([-0.5, 0.9]), np.zeros(0), 1.3)
    assert log_likelihood(answers, at, link, 20)[0] == pytest.approx(expected, abs=1e-6)


def test_turning_the_scale_round_turns_the_effects_round(wine: Wine) -> None:
    """Reversed answers give the same likelihood, opposite effects and mirrored thresholds."""
    plain = wine.fit(1, "probit")
    turned = fit_cumulative_model(
        [6 - one for one in wine.ratings], wine.judges, wine.design, link="probit"
    )
    assert turned.log_likelihood == pytest.approx(plain.log_likelihood, abs=1e-8)
    assert effects(turned) == pytest.approx([-one for one in effects(plain)], abs=1e-5)
    mirrored = [-one.estimate for one in reversed(plain.thresholds)]
    assert [one.estimate for one in turned.thresholds] == pytest.approx(mirrored, abs=1e-5)


def test_unused_categories_are_left_out_and_reported(wine: Wine) -> None:
    """Categories that no participant chose are reported and do not change the estimates."""
    stretched = fit_cumulative_model(
        [2 * one - 1 for one in wine.ratings], wine.judges, wine.design, scale=range(1, 10)
    )
    assert effects(stretched) == pytest.approx(effects(wine.fit(1)), abs=1e-6)
    assert stretched.unused_levels == (2, 4, 6, 8)
    assert stretched.messages == (
        "Nobody answered 2, 4, 6, 8; the model leaves these categories out.",
    )


def test_alike_participants_have_no_variance() -> None:
    """Participants who do not differ get a variance of zero, and the fit is the plain model's."""
    answers, people = [1, 2, 3] * 8, [who for who in range(12) for _ in range(2)]
    design = build_design([factor("limb", ["hand", "foot"] * 12)])
    model = fit_cumulative_model(answers, people, design)
    assert model.participant_sd == 0.0
    assert np.isnan(model.participant_sd_se)
    assert model.messages == ("Participants do not differ: their variance is estimated as zero.",)
    plain = fit_cumulative_model(answers, None, design)
    assert model.log_likelihood == pytest.approx(plain.log_likelihood, abs=1e-9)


def test_separated_answers_are_reported() -> None:
    """If all answers of a condition are at one end of the scale, its effect is not estimated."""
    answers = [1, 5, 2, 5, 3, 5, 1, 5, 2, 5, 2, 5]
    people = [who for who in range(6) for _ in range(2)]
    design = build_design([factor("limb", ["hand", "foot"] * 6)])
    model = fit_cumulative_model(answers, people, design)
    assert not model.converged
    assert "end of the scale" in model.messages[0]


@pytest.mark.parametrize(
    ("answers", "people", "scale", "expected_message"),
    [
        ([1, 1, 1, 1, 1, 1], 3, None, "no variation to model"),
        ([1, 2, 3, 1, 2, 8], 3, range(1, 8), "not on the scale"),
        ([1, 2, 3, 1, 2, 3], 2, None, "too few"),
        ([1, 2, 3], 3, None, "do not fit"),
    ],
)
def test_answers_that_cannot_be_fitted_are_rejected(
    answers: list[int], people: int, scale: range | None, expected_message: str
) -> None:
    """Constant answers, answers off the scale and too few people are rejected."""
    design = build_design([factor("limb", ["hand", "foot"] * 3)])
    names = [at % people for at in range(len(answers))]
    with pytest.raises(ModelError, match=expected_message):
        fit_cumulative_model(answers, names, design, scale=scale)


def test_models_of_other_answers_are_not_compared(wine: Wine) -> None:
    """Models of different answers, or fitted in different ways, cannot be compared."""
    with pytest.raises(ModelError, match="differ in nodes"):
        likelihood_ratio(wine.fit(0), wine.fit(1))


def test_contrasts_are_effects_where_there_are_two_levels(wine: Wine) -> None:
    """The contrast of two levels is their coefficient, also within levels of another factor."""
    model = wine.fit(1)
    (warm, *_) = model.effects
    (found,) = cumulative_contrasts(model, "temp", against="cold")
    assert (found.a, found.b) == ("warm", "cold")
    assert found.value.estimate == pytest.approx(warm.estimate)
    assert (found.value.se, found.p_holm) == pytest.approx((warm.se, warm.p))
    by_contact = cumulative_contrasts(model, "temp", by="contact")
    assert [one.within for one in by_contact] == ["no", "yes"]
    assert [one.value.z for one in by_contact] == pytest.approx([-warm.z, -warm.z])
