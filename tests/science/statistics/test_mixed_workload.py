"""Tests that the published analysis of workload in a virtual room is reproduced.

NASA-TLX of 16 people with four ways of answering, one in each of four sessions. The figures are
those printed by lme4, lmerTest and emmeans in the authors' notebook: `analysis/
Part2_MixedModelAnalysis.ipynb` of ischtz/jov2023-vr-objects, commit 49d28a7, section TLX Score.
"""

import csv
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from scipy.stats import rankdata

from app.science.statistics.friedman import friedman
from app.science.statistics.mixed.design import build_design
from app.science.statistics.mixed.model import MixedModel, fit_mixed_model
from app.science.statistics.mixed.term_tests import contrasts, marginal_means, term_tests
from app.science.statistics.mixed.terms import factor
from app.science.statistics.pairwise import pairwise

METHODS = ("Object", "Cube", "Stick", "Laser")
ITEMS = ("Mental", "Physical", "Temporal", "Performance", "Effort", "Frustration")


class Workload(NamedTuple):
    """Raw TLX scores, 0 to 100, one for each person and session."""

    scores: list[float]
    people: list[str]
    methods: list[str]
    sessions: list[int]

    def fit(self, *interactions: tuple[str, ...]) -> MixedModel:
        """Fit method, session and the given interactions, with participants as a random effect."""
        factors = [
            factor("method", self.methods, METHODS),
            factor("session", self.sessions),
        ]
        return fit_mixed_model(self.scores, self.people, build_design(factors, (), interactions))

    def table(self) -> np.ndarray:
        """Return the scores as (people, methods)."""
        scores = {
            (who, how): score
            for who, how, score in zip(self.people, self.methods, self.scores, strict=True)
        }
        return np.array(
            [[scores[who, how] for how in METHODS] for who in dict.fromkeys(self.people)]
        )


@pytest.fixture(scope="module")
def workload(shared_data: Path) -> Workload:
    """Return the scores, with answers 1 to 21 recoded to 0 to 100 in steps of five."""
    with (shared_data / "questionnaires" / "tlxscores.csv").open() as file:
        rows = list(csv.DictReader(file))
    return Workload(
        [float(np.mean([5.0 * (float(row[item]) - 1.0) for item in ITEMS])) for row in rows],
        [row["PPID"] for row in rows],
        [row["Response"] for row in rows],
        [int(row["Session"]) for row in rows],
    )


@pytest.fixture(scope="module")
def authors(workload: Workload) -> MixedModel:
    """Return the authors' model: method, session and their interaction."""
    return workload.fit(("method", "session"))


def test_marginal_means_are_those_of_the_authors(authors: MixedModel) -> None:
    """Marginal means and SE of object, cube, fixed (the stick) and laser are the authors'."""
    found = marginal_means(authors, "method")
    assert [one.value.estimate for one in found] == pytest.approx(
        [22.8125, 25.15625, 16.97917, 18.48958], abs=5e-6
    )
    assert [one.value.se for one in found] == pytest.approx([2.537079] * 4, abs=1e-4)
    assert found[0].value.df == pytest.approx(18.3173, abs=1e-3)


def test_variances_are_those_of_the_authors(authors: MixedModel) -> None:
    """The variances are the authors': 87.12 between people, 15.86 within."""
    assert authors.random_covariance[0, 0] == pytest.approx(87.12, abs=0.01)
    assert authors.residual_sd**2 == pytest.approx(15.86, abs=0.005)
    assert authors.converged


def test_terms_are_those_of_the_authors(authors: MixedModel) -> None:
    """F and Satterthwaite's df of all terms are the authors', for unbalanced sessions."""
    expected = {
        "method": (14.439, 3, 32.877),
        "session": (9.487, 3, 32.877),
        "method:session": (1.143, 9, 34.690),
    }
    for one in term_tests(authors):
        f, df_term, df_error = expected[one.term]
        assert one.f == pytest.approx(f, abs=1e-3)
        assert one.df_term == df_term
        assert one.df_error == pytest.approx(df_error, abs=1e-3)


def test_holms_pattern_is_that_of_the_authors(authors: MixedModel) -> None:
    """t and Holm's p of all six comparisons of methods are the authors'.

    emmeans has Kenward and Roger's 33 degrees of freedom, Satterthwaite's are 32.88.
    """
    expected = {
        ("Object", "Cube"): (-1.664, 0.2110),
        ("Object", "Stick"): (4.142, 0.0009),
        ("Object", "Laser"): (3.070, 0.0128),
        ("Cube", "Stick"): (5.807, 0.0000),
        ("Cube", "Laser"): (4.734, 0.0002),
        ("Stick", "Laser"): (-1.073, 0.2912),
    }
    found = contrasts(authors, "method")
    assert {(one.a, one.b) for one in found} == set(expected)
    for one in found:
        t, p = expected[one.a, one.b]
        assert one.value.t == pytest.approx(t, abs=1e-3)
        assert one.p_holm == pytest.approx(p, abs=2e-4)


def test_without_the_interaction_the_pattern_holds(workload: Workload) -> None:
    """Without the interaction the model rejects the same four comparisons of methods."""
    rejected = {(one.a, one.b) for one in contrasts(workload.fit(), "method") if one.p_holm < 0.05}
    assert rejected == {
        ("Object", "Stick"),
        ("Object", "Laser"),
        ("Cube", "Stick"),
        ("Cube", "Laser"),
    }


def test_rank_tests_find_fewer_differences(workload: Workload) -> None:
    """Friedman's test is significant; exact Wilcoxon does not separate object and laser.

    The authors' p of .066, before Holm, is the share of all 2^15 signs of the differences that are
    not zero whose rank sum is as extreme. Tables for samples without ties have .064.
    """
    table = workload.table()
    found = friedman(table, exact_up_to=0)
    assert found.statistic == pytest.approx(12.057, abs=5e-4)
    assert found.p_asymptotic == pytest.approx(0.00719, abs=5e-6)
    compared = {(one.a, one.b): one for one in pairwise(table, METHODS)}
    ours = compared["Object", "Laser"]
    differences = np.round((table[:, 0] - table[:, 3]) * 6 / 5)
    ranks = rankdata(np.abs(differences[differences != 0]))
    sums = np.array([0.0])
    for rank in ranks:
        sums = np.concatenate((sums, sums + rank))
    assert ours.test.p == pytest.approx(2 * np.mean(sums <= ours.test.w))
    assert ours.p_holm == pytest.approx(0.199, abs=5e-4)
    rejected = {pair for pair, one in compared.items() if one.p_holm < 0.05}
    assert rejected == {("Object", "Stick"), ("Cube", "Stick"), ("Cube", "Laser")}
