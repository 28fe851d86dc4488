"""Tests of the dependency blending space: scaling, blends, neighbours and weights."""

from collections.abc import Mapping

import numpy as np
import pytest

from app.science.walking.maps.blending import blending_space
from app.science.walking.maps.densifying import drawn_blends, drawn_weights
from app.science.walking.maps.neighbours import LEAF, neighbours, tree_of
from app.science.walking.records.dependencies import dependency_vectors, scaling_of
from app.science.walking.records.model import WalkingError
from tests.science.walking.spaces import GRID, NAMES, dependency_rows, made_up_space


def test_dependencies_count_by_their_own_spread() -> None:
    """Dependencies are scaled to z-scores; one that is constant over all walks has no weight."""
    rows = np.column_stack([[1.0, 2.0, 3.0], [50.0, 70.0, 90.0], [1.8, 1.8, 1.8]])
    scaling = scaling_of(("length_m", "load_kg", "stature_m"), rows)
    z = scaling.z(rows)
    assert z[:, :2].mean(axis=0) == pytest.approx([0.0, 0.0], abs=1e-12)
    assert z[:, :2].std(axis=0) == pytest.approx([1.0, 1.0])
    assert (z[:, 2] == 0.0).all()
    query = {"length_m": 2.0, "load_kg": 70.0, "stature_m": 1.6, "age": 30.0}
    assert scaling.z(scaling.vector(query)) == pytest.approx([0.0, 0.0, 0.0])


@pytest.mark.parametrize(
    ("query", "expected_message"), [({"length_m": 1.0}, "stature_m is missing"),
                        ({"length_m": 1.0, "stature_m": np.nan}, "finite")],
)  # fmt: skip
def test_a_query_without_a_dependency_is_rejected(
    query: Mapping[str, float], expected_message: str
) -> None:
    """A query that lacks a dependency raises an error that names it."""
    scaling = scaling_of(NAMES, dependency_rows(np.random.default_rng(1)))
    with pytest.raises(WalkingError, match=expected_message):
        scaling.vector(query)


def test_a_walk_without_a_dependency_is_named() -> None:
    """Fitting a walk that lacks the stature raises an error that names the recording."""
    walks = [{"length_m": 1.0, "stature_m": 1.7}, {"length_m": 2.0}]
    with pytest.raises(WalkingError, match=r"walk from b\.csv has no stature_m"):
        dependency_vectors(NAMES, walks, ["a.csv", "b.csv"])


def test_weights_of_blends_are_those_of_kovar_and_gleicher() -> None:
    """Weights of a blend sum to 1 and are from -.1 to 1.1, sometimes outside of 0 to 1."""
    weights = drawn_weights(4000, 4, np.random.default_rng(1))
    assert weights.sum(axis=1) == pytest.approx(np.ones(4000))
    assert weights.min() >= -0.1
    assert weights.max() <= 1.1
    assert weights.min() < -0.09
    assert weights.max() > 1.0


def test_blends_have_the_dependencies_and_maps_of_their_weights() -> None:
    """A blend's dependencies and map have the same weights; maps stay within [0, 1]."""
    rng = np.random.default_rng(3)
    rows = dependency_rows(rng, 40)
    maps = rng.random((40, 25)).astype(np.float32)
    blends = drawn_blends(scaling_of(NAMES, rows).z(rows), 60, rng)
    matrix = blends.as_matrix(40)
    assert blends.of_vectors(rows) == pytest.approx(matrix @ rows)
    assert blends.of_maps(maps) == pytest.approx(np.clip(matrix @ maps, 0.0, 1.0), abs=1e-6)


def test_blends_never_include_people_who_are_left_out() -> None:
    """The entries of a space without some people are walks of the others, or blends of them."""
    rng = np.random.default_rng(4)
    rows = dependency_rows(rng, 60)
    person = np.arange(60) % 6
    own = np.flatnonzero(person != 5)
    # Each walk marks one node, so that a map shows which walks it contains.
    marks = np.zeros((60, GRID.size), dtype=np.float32)
    marks[np.arange(60), np.arange(60)] = 1.0
    scaling = scaling_of(NAMES, rows[own])
    space = blending_space(GRID, scaling, rows[own], marks[own], rng=rng, entries=500, k=50)
    assert len(space.values) == 500
    assert (space.values[:, person.nonzero()[0]] > 0.0).any()
    assert not space.values[:, np.flatnonzero(person == 5)].any()


def test_parents_are_the_nearest_walks_nearest_first() -> None:
    """A blend's parents are the walks that are nearest to its target, sorted by distance."""
    z = np.random.default_rng(6).standard_normal((200, 4))
    blends = drawn_blends(z, 300, np.random.default_rng(7))
    targets = np.random.default_rng(7).uniform(z.min(axis=0), z.max(axis=0), size=(300, 4))
    apart = ((targets[:, np.newaxis] - z) ** 2).sum(axis=-1)
    assert (blends.parents == np.argsort(apart, axis=1)[:, :5]).all()


def test_walks_on_one_course_are_blended_of_all_people() -> None:
    """Of walks that are equally near, every person's are blended as often.

    In the order of a partial sort, one person's walks were the parents of all blends.
    """
    people, lengths_m = 8, np.repeat((2.0, 5.0, 9.0), 4)
    person = np.repeat(np.arange(people), len(lengths_m))
    rows = np.column_stack([np.tile(lengths_m, people), np.zeros(len(person))])
    scaling = scaling_of(NAMES, rows)
    blends = drawn_blends(scaling.z(rows), 4000, np.random.default_rng(8))
    shares = np.bincount(person[blends.parents].ravel(), minlength=people) / blends.parents.size
    # 12,000 draws: 1 / 8 has a standard error of .003.
    assert shares == pytest.approx(np.full(people, 1 / people), abs=0.015)
    assert (np.diff(np.sort(blends.parents, axis=1), axis=1) > 0).all()


def test_blends_of_walks_on_one_course_are_exactly_there() -> None:
    """Blends of equal dependencies have exactly these, so that none is nearer by rounding."""
    rows = np.array([[m, 0.3] for _ in range(12) for m in (2.1, 5.3, 9.7)])
    scaling = scaling_of(NAMES, rows)
    maps = np.zeros((len(rows), GRID.size), dtype=np.float32)
    space = blending_space(
        GRID, scaling, rows, maps, rng=np.random.default_rng(9), entries=400, k=20
    )
    assert len(np.unique(space.z, axis=0)) == 3
    for z in (space.z[0], space.z[0] + np.array([0.1, 0.0])):
        _, weights = space.neighbours(z)
        assert weights == pytest.approx(np.full(20, 1 / 20))


def test_neighbours_are_the_nearest_and_weigh_by_distance() -> None:
    """Neighbours are the nearest by sorting all distances, with weights w = 1 - d / d_k."""
    rng = np.random.default_rng(5)
    points = np.round(rng.standard_normal((50 * LEAF, 3)), 1)
    tree = tree_of(points)
    for z in 1.5 * rng.standard_normal((50, 3)):
        indices, weights = neighbours(tree, z, 37)
        apart = np.linalg.norm(points - z, axis=1)
        farthest = np.sort(apart)[36]
        expected = 1.0 - apart[indices] / farthest
        assert len(set(indices.tolist())) == 37
        assert apart[indices].max() == pytest.approx(farthest)
        assert weights == pytest.approx(expected / expected.sum())


def test_equal_walks_weigh_the_same() -> None:
    """Neighbours at equal distances have equal weights, also at zero distance."""
    ring = np.array([[np.cos(angle), np.sin(angle)] for angle in np.linspace(0.0, 6.0, 8)])
    for points in (np.ones((8, 2)), 1.0 + ring):
        _, weights = neighbours(tree_of(points), np.ones(2), 8)
        assert weights == pytest.approx(np.full(8, 1 / 8))


def test_an_answer_traced_to_its_walks_is_the_blended_map() -> None:
    """A blended map equals the weighted maps of the walks that it blends, except for clipping."""
    space = made_up_space()
    walks = space.values[: space.walks].astype(np.float64)
    for z in space.z[5:60:11]:
        indices, weights = space.neighbours(z)
        blended = weights @ space.values[indices]
        assert space.origins(z).sum() == pytest.approx(1.0)
        assert np.abs(space.origins(z) @ walks - blended).max() < 0.02


@pytest.mark.parametrize("k", [0, 401])
def test_the_number_of_neighbours_is_limited_by_the_entries(k: int) -> None:
    """More neighbours than entries, or none, are rejected."""
    with pytest.raises(WalkingError, match="1 to 400"):
        neighbours(made_up_space().tree, np.zeros(2), k)
