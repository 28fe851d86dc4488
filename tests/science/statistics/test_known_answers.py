"""Tests that published results, each with its source, are reproduced digit by digit."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from app.science.statistics import (
    Expected,
    aligned_ranks_split_plot,
    cells_of,
    cronbach_alpha,
    friedman,
    page_trend,
    pairwise,
    rm_anova,
    rm_anova_power,
    signed_rank,
    split_plot_anova,
    subjects_needed,
)
from app.science.statistics.arrays import complete_rows
from app.science.statistics.tidy import Cells
from tests.science.statistics.published import TEACHING, WINE, cells, pingouin_table, rows, wide


def test_friedman_of_the_rounding_times(shared_data: Path) -> None:
    """Friedman's test of RoundingTimes (Hollander and Wolfe 1973): 11.143, df 2, p .003805.

    R, ?friedman.test.
    """
    table = rows(shared_data / "statistics" / "rounding_times.csv")
    test = friedman(wide(table, ["round_out", "narrow_angle", "wide_angle"]))
    assert test.statistic == pytest.approx(11.143, abs=5e-4)
    assert test.df == 2
    assert test.p == test.p_asymptotic == pytest.approx(0.003805, abs=5e-7)
    assert test.kendall_w == pytest.approx(0.25325, abs=5e-6)
    assert test.method == "asymptotic"
    assert "22" in test.note


def test_friedman_of_the_wines_is_exact_with_ties() -> None:
    """Friedman's test of pingouin's wines: Q 2, chi-square p .3678794, W .0833333.

    The exact p with ties is .3870.
    """
    test = friedman(WINE)
    assert test.statistic == pytest.approx(2.0, abs=1e-12)
    assert test.p_asymptotic == pytest.approx(0.3678794, abs=5e-8)
    assert test.p == pytest.approx(0.3870, abs=5e-5)
    assert test.kendall_w == pytest.approx(0.0833333, abs=5e-8)
    assert (test.method, test.note) == ("exact", "")


def test_anova_with_two_factors_within() -> None:
    """A two-way ANOVA of pingouin's `rm_anova2` gives its F, generalised eta squared and epsilon.

    Pingouin checked these against jamovi.
    """
    found = cells(pingouin_table("rm_anova2"), "Subject", ["Time", "Metric"], "Performance")
    effects = {one.name: one for one in rm_anova(found.values, found.factors).effects}
    published = {
        "Time": (33.85228, 0.25401, 1.0, 1, 9),
        "Metric": (26.95919, 0.35933, 0.96910, 2, 18),
        "Time:Metric": (12.63227, 0.08442, 0.72717, 2, 18),
    }
    assert list(effects) == list(published)
    for name, (f, eta, epsilon, df, df_error) in published.items():
        assert effects[name].f == pytest.approx(f, abs=5e-6)
        assert effects[name].generalised_eta_squared == pytest.approx(eta, abs=5e-6)
        assert effects[name].epsilon == pytest.approx(epsilon, abs=5e-6)
        assert (effects[name].df, effects[name].df_error) == (df, df_error)


def test_anova_with_one_factor_within_and_missing_values() -> None:
    """An ANOVA of pingouin's `rm_anova_wide` uses 9 of 12 rows and gives its published values.

    F, p, epsilon, Mauchly's W and p GG.
    """
    complete, left_out = complete_rows(wide(pingouin_table("rm_anova_wide")))
    assert (complete.shape, left_out) == ((9, 4), 3)
    (effect,) = rm_anova(complete).effects
    assert effect.f == pytest.approx(5.20065, abs=5e-6)
    assert effect.p == pytest.approx(0.00656, abs=5e-6)
    assert effect.epsilon == pytest.approx(0.69433, abs=5e-6)
    assert effect.mauchly_w == pytest.approx(0.30678, abs=5e-6)
    assert effect.p_gg == pytest.approx(0.01670, abs=5e-6)


def test_aligned_ranks_of_a_split_plot(shared_data: Path) -> None:
    """Aligned ranks of ARTool's Higgins1990Table5 give the F values of its documentation.

    Degrees of freedom included.
    """
    table = rows(shared_data / "statistics" / "higgins1990table5.csv")
    found = cells(table, "Tray", ["Fertilizer"], "DryMatter")
    moisture = {row["Tray"]: row["Moisture"] for row in table}
    groups = [moisture[tray] for tray in found.subjects]
    result = aligned_ranks_split_plot(found.values, groups)
    published = ((23.8326, 3, 8), (122.4017, 3, 24), (5.1180, 9, 24))
    for effect, (f, df, df_error) in zip(result.effects, published, strict=True):
        assert effect.f == pytest.approx(f, abs=5e-5)
        assert (effect.df, effect.df_error) == (df, df_error)
    assert "contested" in result.caution


def test_cronbach_alpha_and_its_interval() -> None:
    """Alpha of pingouin's `cronbach_alpha` (15 people, 10 items) is .592 [.195, .840]."""
    found = cells(pingouin_table("cronbach_alpha"), "Subj", ["Items"], "Scores")
    result = cronbach_alpha(found.values)
    assert found.values.shape == (15, 10)
    assert result.alpha == pytest.approx(0.592, abs=5e-4)
    assert result.low == pytest.approx(0.195, abs=5e-4)
    assert result.high == pytest.approx(0.840, abs=5e-4)


def test_signed_rank_with_a_zero_difference() -> None:
    """Signed ranks with a zero difference give W 20.5 and a rank-biserial of -.379.

    From pingouin's tests, which were checked against JASP.
    """
    x = [20, 22, 19, 20, 22, 18, 24, 20, 19, 24, 26, 13]
    y = [38, 37, 33, 29, 14, 12, 20, 22, 17, 25, 26, 16]
    test = signed_rank(x, y)
    assert test.w == 20.5
    assert test.rank_biserial == pytest.approx(-0.379, abs=5e-4)
    assert (test.n, test.n_zero) == (12, 1)


def test_page_trend_of_the_three_ways_of_teaching() -> None:
    """Page's test of scipy's `page_trend_test` example: L 133.5, exact p .00181912.

    The normal approximation gives .00126934.
    """
    test = page_trend(TEACHING)
    assert test.statistic == 133.5
    assert test.p == pytest.approx(0.00181912, abs=5e-9)
    assert test.p_asymptotic == pytest.approx(0.00126934, abs=5e-9)
    assert test.method == "exact"


def test_power_of_twelve_participants() -> None:
    """The power of an ANOVA agrees with G*Power 3 and pingouin.

    12 people with m = 3, r = .5: .823 at .14, .416 at .06; 80 % at .06 takes 27.
    """
    assert rm_anova_power(12, Expected(0.14)) == pytest.approx(0.823, abs=5e-4)
    assert rm_anova_power(12, Expected(0.06)) == pytest.approx(0.416, abs=5e-4)
    assert subjects_needed(0.80, Expected(0.06)) == 27


def test_workload_of_four_ways_of_pointing(shared_data: Path) -> None:
    """Raw TLX of four ways of pointing gives the authors' means and their Friedman test."""
    table = rows(shared_data / "questionnaires" / "tlxscores.csv")
    found = _workload(table, lambda points: float(np.mean([5.0 * (one - 1.0) for one in points])))
    means = dict(zip(found.levels[0], found.values.mean(axis=0), strict=True))
    published = {"Object": 22.8125, "Cube": 25.15625, "Stick": 16.97917, "Laser": 18.48958}
    assert means == pytest.approx(published, abs=5e-6)
    test = friedman(found.complete().values)
    assert test.statistic == pytest.approx(12.057, abs=5e-4)
    assert test.p == pytest.approx(0.00719, abs=5e-6)


def test_ties_do_not_depend_on_how_a_mean_was_rounded(shared_data: Path) -> None:
    """Sums and means of the same answers have the same ties: p .199; unrounded means give .190."""
    table = rows(shared_data / "questionnaires" / "tlxscores.csv")
    sums = _workload(table, sum)
    means = _workload(table, lambda points: sum(5.0 * (one - 1.0) for one in points) / 6.0)
    of_sums, of_means = (pairwise(one.values, one.levels[0]) for one in (sums, means))
    assert [one.p_holm for one in of_sums] == [one.p_holm for one in of_means]
    pair = {(one.a, one.b): one for one in of_sums}["Laser", "Object"]
    assert pair.p_holm == pytest.approx(0.1989, abs=5e-5)


def _workload(table: list[dict[str, str]], score: Callable[[list[float]], float]) -> Cells:
    scales = ("Mental", "Physical", "Temporal", "Performance", "Effort", "Frustration")
    return cells_of(
        [row["PPID"] for row in table],
        {"method": [row["Response"] for row in table]},
        [score([float(row[scale]) for scale in scales]) for row in table],
    )


@pytest.mark.parametrize(
    ("name", "published"),
    [
        ("mixed_anova", ((5.051709, 1, 58), (4.027394, 2, 116), (2.727996, 2, 116))),
        ("mixed_anova_unbalanced", ((2.302642, 2, 23), None, (0.887720, 6, 69))),
    ],
)
def test_split_plot_anova_agrees_with_pingouin(
    name: str, published: tuple[tuple[float, int, int] | None, ...]
) -> None:
    """The split-plot ANOVA agrees with pingouin 0.7's `mixed_anova`.

    For groups of unequal sizes the within-subjects means differ: pingouin averages over subjects,
    while here every group counts equally.
    """
    table = pingouin_table(name)
    found = cells(table, "Subject", ["Time"], "Scores")
    group = {row["Subject"]: row["Group"] for row in table}
    result = split_plot_anova(found.values, [group[subject] for subject in found.subjects])
    tested = (result.between, result.within, result.interaction)
    for effect, expected in zip(tested, published, strict=True):
        if expected is not None:
            assert effect.f == pytest.approx(expected[0], abs=5e-6)
            assert (effect.df, effect.df_error) == expected[1:]
