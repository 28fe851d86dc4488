"""Tests of scores of predicted travel times, and leave-one-out errors."""

import numpy as np
import pytest
from scipy import stats

from app.science.rotations import FloatArray
from app.science.walking.evaluation.evaluation import evaluate, pooled
from app.science.walking.evaluation.leave_one_out import (
    neighbours_left_out,
    nodes_left_out,
    people_left_out,
)
from app.science.walking.evaluation.scoring import comparison, error_summary, signed_rank_power
from app.science.walking.following.following import SteeringFollower
from app.science.walking.maps.database import database_of
from app.science.walking.maps.maps import MapMaker, maps_of
from app.science.walking.maps.suitability import PAPER, TIME_AWARE
from app.science.walking.models.crps import covers, crps_s
from app.science.walking.models.fitting import FitOptions, fitted, space_of
from app.science.walking.records.model import (
    LENGTH,
    STATURE,
    TURNING,
    PlannedPath,
    PlannedWalk,
    WalkingError,
)
from app.science.walking.records.parameters import PAPER_PARAMETERS, regular_grid
from app.science.walking.records.protocols import Course, Trajectories
from app.science.walking.scene.laboratory import straight_scene
from app.science.walking.synthetic.populations import POPULATIONS
from app.science.walking.synthetic.synthetic_walks import Sample, synthetic_walks
from tests.science.walking.spaces import made_up_database, made_up_space


def test_crps_is_its_definition() -> None:
    """CRPS equals E|T - t| - E|T - T'| / 2, |dt| for one draw, and the normal's closed form."""
    draws = np.random.default_rng(1).gamma(4.0, 0.5, 60)
    pairs = np.abs(draws[:, None] - draws[None, :]).mean()
    assert crps_s(draws, 1.7) == pytest.approx(np.abs(draws - 1.7).mean() - pairs / 2.0)
    assert crps_s(np.array([2.0]), 3.5) == pytest.approx(1.5)
    normal = stats.norm.ppf((np.arange(20_000) + 0.5) / 20_000)
    exact = 0.8 * (2 * stats.norm.cdf(0.8) - 1) + 2 * stats.norm.pdf(0.8) - 1 / np.sqrt(np.pi)
    assert crps_s(normal, 0.8) == pytest.approx(exact, abs=1e-4)


def test_a_draw_from_the_truth_errs_by_sqrt_2_of_its_median() -> None:
    """A draw from the truth errs by sqrt(2) times as much as its median; CRPS avoids that."""
    rng = np.random.default_rng(2)
    truth, draws = rng.standard_normal(40_000), rng.standard_normal(40_000)
    ratio = np.median(np.abs(draws - truth)) / np.median(np.abs(truth))
    assert ratio == pytest.approx(np.sqrt(2.0), rel=0.03)
    forecast_s = stats.norm.ppf((np.arange(400) + 0.5) / 400)
    proper = np.mean([crps_s(forecast_s, value) for value in truth[:2000]])
    assert proper < 0.75 * np.abs(truth[:2000]).mean()


def test_percentiles_and_tests_are_those_of_scipy() -> None:
    """Percentiles, Shapiro and Wilk's test and Wilcoxon's direction agree with scipy."""
    rng = np.random.default_rng(3)
    truth = rng.uniform(1.0, 3.0, 200)
    predicted = truth + rng.normal(0.3, 0.2, 200)
    summary = error_summary(predicted, truth)
    errors = np.abs(predicted - truth)
    assert summary.percentiles_s == pytest.approx(np.percentile(errors, [5, 25, 50, 75, 95]))
    assert summary.shapiro_p == pytest.approx(stats.shapiro(errors).pvalue)
    worse = comparison(("stat", "prob"), errors, errors / 2.0)
    assert worse.p == pytest.approx(stats.wilcoxon(errors, errors / 2.0, method="approx",
                                                   correction=False).pvalue)  # fmt: skip
    assert worse.rank_biserial == 1.0
    assert worse.difference_s > 0.0
    with pytest.raises(WalkingError):
        error_summary(truth[:0], truth[:0])


def test_power_grows_from_alpha_to_one() -> None:
    """Signed-rank power is alpha without an effect, .93 at 58 pairs with d = .5, 1 at 2000."""
    assert signed_rank_power(50, 0.0) == pytest.approx(0.05, abs=1e-3)
    assert signed_rank_power(58, 0.5) == pytest.approx(0.93, abs=0.02)
    assert signed_rank_power(2000, 0.5) == pytest.approx(1.0)


def test_central_intervals_have_their_stated_coverage() -> None:
    """Of values drawn from the prediction, half are within its central 50 % interval."""
    rng = np.random.default_rng(4)
    draws = rng.standard_normal(4000)
    inside = [covers(draws, float(value), 0.5) for value in rng.standard_normal(4000)]
    assert np.mean(inside) == pytest.approx(0.5, abs=0.03)


def test_leaving_out_stays_within_the_limits_on_smooth_maps() -> None:
    """Leave-one-out errors of smooth maps: neighbours .5 % (sd 5.5 %), bases .05 % (.17 %)."""
    space = made_up_space(regular_grid(PAPER_PARAMETERS, 8))
    by_neighbours = neighbours_left_out(space)
    assert abs(by_neighbours.mean) <= 0.5
    assert by_neighbours.sd <= 5.5
    by_nodes = nodes_left_out(space, np.random.default_rng(1))
    assert abs(by_nodes.mean) <= 0.05
    assert by_nodes.sd <= 0.17


def test_people_left_out_are_harder_than_entries() -> None:
    """Leaving out people gives larger errors than leaving out single entries of the space."""
    database = made_up_database()
    rng = np.random.default_rng(1)
    easy = neighbours_left_out(space_of(database, PAPER, rng, entries=400, k=20))
    hard = people_left_out(database, PAPER, rng, entries=400, k=20)
    assert hard.entries == len(database)
    assert abs(hard.sd) > abs(easy.sd)


class _ShortPathsOnly(SteeringFollower):
    """A follower whose agents never arrive at the end of a path of more than 50 m."""

    def follow(self, course: Course, vectors: FloatArray) -> Trajectories:
        """Let agents walk; on long paths none arrives."""
        if course.path.length_m <= 50.0:
            return super().follow(course, vectors)
        places = np.zeros((len(vectors), course.samples, 2))
        return Trajectories(places, np.full(len(vectors), np.nan))


def test_a_population_is_predicted_from_others_of_it() -> None:
    """Unseen people of a synthetic population are predicted best by the probabilistic model."""
    maker = MapMaker(grid=regular_grid(PAPER_PARAMETERS, 7))
    scenes = [straight_scene(length) for length in (1.0, 2.0, 3.0)]
    population = POPULATIONS[3]
    training = list(synthetic_walks(population, scenes, Sample(8, 1, seed=1)))
    others = list(synthetic_walks(population, scenes, Sample(5, 2, seed=2, prefix="other ")))
    assert {entry.walk.kind for entry in training} == {"synthetic"}
    assert not {e.walk.subject for e in training} & {e.walk.subject for e in others}
    maps = [one for _, one in maps_of(training, maker, threads=1)]
    database = database_of(training, maps, (LENGTH, TURNING, STATURE))
    fit = fitted(database, FitOptions(entries=600, k=30, reading=TIME_AWARE))
    rng = np.random.default_rng(5)
    halves = [
        evaluate(fit.models, SteeringFollower(), part, rng, draws=60)
        for part in (others[:15], others[15:])
    ]
    result = pooled(halves)
    assert len(result.truth_s) == 30
    assert result.crps_ratio("prob", "stat") < 1.0
    assert result.saved_per_cycle_s("prob", "stat") > 0.0
    assert len(result.iqr_ratios("prob")) == 3
    low, high = result.coverage("prob")
    assert low < high
    assert [(one.first, one.second) for one in result.comparisons()] == [
        ("stat", "adapt"),
        ("stat", "prob"),
        ("adapt", "prob"),
    ]
    # A path on which all agents get lost stops none of the other walks.
    far = PlannedPath(np.array([[0.0, 0.0], [0.0, 100.0]]))
    lost = PlannedWalk(others[1].walk, far, others[1].dependencies)
    given = [others[0], lost, others[2]]
    rest = evaluate(fit.models, _ShortPathsOnly(), given, rng, draws=20)
    assert list(rest.left_out) == [1]
    assert "agents of model" in rest.left_out[1]
    assert rest.subjects == (others[0].walk.subject, others[2].walk.subject)
    assert pooled([rest, rest]).left_out.keys() == {1, 4}
    with pytest.raises(WalkingError, match="None of the 1 walks can be predicted by all models"):
        evaluate(fit.models, _ShortPathsOnly(), [lost], rng, draws=20)


def test_an_evaluation_without_walks_is_rejected() -> None:
    """An evaluation without walks raises an error."""
    with pytest.raises(WalkingError, match="no walk"):
        evaluate([], SteeringFollower(), [], np.random.default_rng(1))
