"""Tests of the three steering models, their fitting, and the choice of a reading."""

import numpy as np
import pytest

from app.science.walking.following.following import SteeringFollower
from app.science.walking.maps.suitability import PAPER, TIME_AWARE
from app.science.walking.models.annealing import anneal, static_fit
from app.science.walking.models.fitting import FitOptions, fitted, restored
from app.science.walking.models.prediction import Predictor
from app.science.walking.models.reading_choice import person_folds, ranked_readings
from app.science.walking.models.steering_models import AdaptiveModel, ProbabilisticModel
from app.science.walking.records.model import LENGTH, STATURE, PlannedPath, WalkingError
from app.science.walking.synthetic.synthetic_walks import straight_path
from tests.science.walking.spaces import GRID, PEOPLE, made_up_database, made_up_space
from tests.science.walking.submodels import with_fixed_parameter, without_dependency

QUERY = {LENGTH: 2.0, STATURE: 1.75}
QUICK = FitOptions(seed=3, k=20, entries=400, reading=TIME_AWARE)


def test_annealing_finds_the_lowest_of_several_valleys() -> None:
    """Annealing finds the deeper of two valleys that are far from most starting points."""

    def valleys(vector: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
        one, two = np.array([0.4, 0.5, 1.7]), np.array([1.6, 1.2, 0.3])
        near = [float(((vector - middle) ** 2).sum()) for middle in (one, two)]
        return float(min(near[0], near[1] - 0.05))

    vector, value = anneal(valleys, GRID, np.random.default_rng(1))
    assert value == pytest.approx(-0.05, abs=1e-3)
    assert vector == pytest.approx([1.6, 1.2, 0.3], abs=0.05)


def test_the_static_model_is_never_worse_than_the_grid() -> None:
    """The static model, annealed between nodes, is no worse than the best node."""
    database = made_up_database()
    found = static_fit(database, np.random.default_rng(1))
    at_nodes = database.deviations.astype(np.float64).mean(axis=0)
    assert found.node_deviation == pytest.approx(at_nodes.min())
    assert found.deviation <= found.node_deviation
    assert (found.vector >= 0.1).all()
    assert (found.vector <= 2.0).all()


def test_models_differ_as_they_should() -> None:
    """The static model is constant, the adaptive depends on the query, the probabilistic varies."""
    fit, rng = fitted(made_up_database(), QUICK), np.random.default_rng(1)
    other = {LENGTH: 2.0, STATURE: 1.6}
    assert (fit.stat.vectors(QUERY, 3, rng) == fit.stat.vectors(other, 3, rng)).all()
    tall, short = fit.adapt.vectors(QUERY, 1, rng)[0], fit.adapt.vectors(other, 1, rng)[0]
    assert tall[0] > short[0]
    drawn = fit.prob.vectors(QUERY, 500, rng)
    assert len(np.unique(drawn[:, 0])) > 400
    by_stature = ProbabilisticModel(made_up_space())
    tall, short = (by_stature.vectors(query, 500, rng)[:, 1].mean() for query in (QUERY, other))
    assert tall > short + 0.05
    repeated = [fit.prob.vectors(QUERY, 5, np.random.default_rng(9)) for _ in range(2)]
    assert (repeated[0] == repeated[1]).all()


def test_the_adaptive_model_is_at_the_top_of_its_map() -> None:
    """The adaptive model is at its map's maximum; ties go to the largest last parameter."""
    from app.science.walking.maps.interpolation import radial_basis
    from app.science.walking.models.sampling import density_of

    space = made_up_space()
    model, rng = AdaptiveModel(space), np.random.default_rng(1)
    density = density_of(space, space.scaling.z(space.scaling.vector(QUERY)), "radial")
    heights = radial_basis(GRID).at(density.coefficients, rng.uniform(0.1, 2.0, (3000, 3)))
    best = model.vectors(QUERY, 1, rng)
    assert float(radial_basis(GRID).at(density.coefficients, best)[0]) >= heights.max() - 1e-6
    flat = made_up_database()
    level = fitted(flat, QUICK).adapt.vectors(QUERY, 1, rng)[0]
    assert level[2] == pytest.approx(2.0)


def test_both_samplers_serve_the_probabilistic_model() -> None:
    """With the paper's rejection the probabilistic model has about the same mean as the mixture."""
    space, rng = made_up_space(), np.random.default_rng(2)
    mixture = ProbabilisticModel(space).vectors(QUERY, 4000, rng).mean(axis=0)
    paper = ProbabilisticModel(space, "rejection").vectors(QUERY, 4000, rng).mean(axis=0)
    assert paper == pytest.approx(mixture, abs=0.05)
    assert ProbabilisticModel(space).vectors(QUERY, 1, rng).shape == (1, 3)


def test_a_reading_is_chosen_on_people_left_out() -> None:
    """The time-aware reading predicts people who are left out better than the paper's."""
    database = made_up_database()
    scores = ranked_readings(
        database, np.random.default_rng(1), readings=(PAPER, TIME_AWARE), entries=400, k=20
    )
    assert [score.options for score in scores] == [TIME_AWARE, PAPER]
    assert scores[0].crps_s < 0.5 * scores[1].crps_s
    folds = person_folds(database, np.random.default_rng(1))
    assert sorted(name for fold in folds for name in fold) == list(database.persons)


def test_one_person_alone_is_rejected() -> None:
    """Walks of one person are rejected, since differences between people cannot be learnt."""
    database = made_up_database()
    with pytest.raises(WalkingError, match="one subject, 'person 2'"):
        fitted(database.select(database.walked_by(["person 2"])), QUICK)


def test_a_model_restored_is_the_model() -> None:
    """A stored and restored model gives the same draws to the bit."""
    fit = fitted(made_up_database(), QUICK)
    repeated = restored(fit.database, fit.options, fit.reading, fit.scores, fit.static)
    one, two = (m.prob.vectors(QUERY, 50, np.random.default_rng(1)) for m in (fit, repeated))
    assert (one == two).all()


def test_submodels_lack_one_parameter() -> None:
    """A submodel does not ask for its missing dependency, and its fixed parameter does not vary."""
    database = made_up_database()
    rng = np.random.default_rng(1)
    fit = fitted(without_dependency(database, STATURE), QUICK)
    assert fit.prob.vectors({LENGTH: 2.0}, 10, rng).shape == (10, 3)
    fixed = fitted(with_fixed_parameter(database, "velocity", 1.0), QUICK)
    drawn = fixed.prob.vectors(QUERY, 100, rng)
    assert (drawn[:, 0] == 1.05).all()
    assert np.ptp(drawn[:, 1]) > 0.1
    with pytest.raises(WalkingError, match="velocity, acceleration, angular"):
        with_fixed_parameter(database, "speed", 1.0)


def test_agents_that_do_not_arrive_are_redrawn() -> None:
    """Agents that do not arrive on a path of sharp turns are replaced by new draws."""
    fit = fitted(made_up_database(), QUICK)
    follower, rng = SteeringFollower(), np.random.default_rng(1)
    sharp = PlannedPath(np.array([[0.0, 0.0], [0.0, 1.5], [1.5, 1.5]]))
    found = Predictor(fit.prob, follower).predict(sharp, QUERY, 40, rng)
    assert found.lost > 0
    assert found.durations_s.shape == (40,)
    assert np.isfinite(found.durations_s).all()
    best = Predictor(fit.adapt, follower).predict(straight_path(2.0), QUERY, 40, rng)
    assert best.durations_s.shape == (1,)
    assert len({f"person {at}" for at in range(PEOPLE)}) == len(fit.database.persons)
