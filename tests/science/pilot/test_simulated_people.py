"""Tests of simulated courses, ratings and visits against the models that define them."""

import numpy as np
import pytest

from app.science.pilot import (
    Course,
    GradedItem,
    drawn_courses,
    drawn_ratings,
    drawn_visits,
    expected_rating,
)

_ITEM = GradedItem("q", (1, 2, 3, 4), (-1.0, 0.0, 2.0), discrimination=1.5)


@pytest.mark.parametrize("trait", [-2.0, 0.0, 1.3])
def test_ratings_follow_the_graded_response_model(trait: float) -> None:
    """The share of ratings at or above a category is Samejima's logistic curve, within 4 SE."""
    sets = 40_000
    ratings = drawn_ratings(_ITEM, np.full(sets, trait), np.random.default_rng(5))
    for rating, threshold in zip((2, 3, 4), _ITEM.thresholds, strict=True):
        p = 1.0 / (1.0 + np.exp(-1.5 * (trait - threshold)))
        assert (ratings >= rating).mean() == pytest.approx(p, abs=4 * np.sqrt(p * (1 - p) / sets))
    spread = ratings.std() / np.sqrt(sets)
    assert ratings.mean() == pytest.approx(expected_rating(_ITEM, trait), abs=4 * spread)


def test_a_reverse_keyed_item_is_rated_for_the_opposite_trait() -> None:
    """An item worded against the trait is rated as its mirror image is for the opposite trait."""
    against = GradedItem("q", (1, 2, 3, 4), (-1.0, 0.0, 2.0), 1.5, towards=-1)
    traits = np.linspace(-2.0, 2.0, 500)
    ratings = drawn_ratings(against, traits, np.random.default_rng(2))
    assert np.array_equal(ratings, drawn_ratings(_ITEM, -traits, np.random.default_rng(2)))


def test_a_course_without_noise_has_its_declared_parts() -> None:
    """Levels are the means plus a share of the effect before and the period, and nothing else."""
    effects = np.array([[0.0, -2.0, -6.0]])
    course = Course(10.0 + effects, effects, 0.5, 1.0, 0.0, 0.0, 0.0)
    orders = np.array([[[2, 0, 1], [0, 1, 2]]])
    levels = drawn_courses(course, orders, np.random.default_rng(0))[0, :, 0]
    # Order 2, 0, 1: condition 0 comes second, after the effect of -6; condition 1 third, after 0.
    assert levels[0].tolist() == [10.0 - 3.0 + 1.0, 8.0 + 0.0 + 2.0, 4.0]
    assert levels[1].tolist() == [10.0, 8.0 + 0.0 + 1.0, 4.0 - 1.0 + 2.0]
    null = drawn_courses(course.without_effect(), orders, np.random.default_rng(0))[0, :, 0]
    assert null.tolist() == [[11.0, 12.0, 10.0], [10.0, 11.0, 12.0]]


def test_persons_and_moments_have_their_declared_variances() -> None:
    """Variance between people, of their reactions and of moments is recovered within 3 %."""
    course = Course(np.zeros((2, 3)), np.zeros((2, 3)), 0.0, 0.0, 1.0, 0.7, 0.5)
    orders = np.tile(np.arange(3), (1, 40_000, 1))
    levels = drawn_courses(course, orders, np.random.default_rng(1))[0]
    assert levels.var() == pytest.approx(1.0 + 0.49 + 0.25, rel=0.03)
    assert np.cov(levels[:, 0, 0], levels[:, 1, 1])[0, 1] == pytest.approx(1.0, rel=0.03)
    assert np.cov(levels[:, 0, 0], levels[:, 1, 0])[0, 1] == pytest.approx(1.49, rel=0.03)


def test_the_order_of_somebody_who_stops_is_used_again() -> None:
    """People who complete have the slots of the ledger one after the other, without a gap."""
    slots = np.array([[0, 1], [1, 0]] * 30)
    visits = drawn_visits(slots, 20, 60, 0.2, np.random.default_rng(3))
    assert visits.completed.mean() == pytest.approx(0.8**2, abs=0.05)
    for orders, completed in zip(visits.orders, visits.completed, strict=True):
        assert np.array_equal(orders[completed], slots[: completed.sum()])
