"""Tests that capsule contacts are exact, and that the fast forms agree with the plain one."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.science.tasks import (
    SurfaceArrays,
    segment_box_distance_m,
    touching,
    touching_and_near,
    touching_frames,
)
from app.science.tasks.contacts import Floats
from tests.science.tasks.vector_files import layout

ARRAYS = SurfaceArrays.of(layout("hand_rim"))


def body(rng: np.random.Generator, n_frames: int) -> tuple[Floats, Floats]:
    """Return random capsules around the boxes: segments (N, 22, 2, 3) and radii (22,)."""
    segments = rng.uniform((-1.0, 0.8, -1.0), (1.0, 1.8, 0.2), (n_frames, 22, 2, 3))
    return segments, rng.uniform(0.01, 0.1, 22)


def sampled_distance_m(start: Floats, end: Floats, low: Floats, high: Floats) -> Floats:
    """Return the distance by brute force: the nearest of 2001 points of each segment."""
    share = np.linspace(0.0, 1.0, 2001)[:, None]
    points = start[:, None] + share * (end - start)[:, None]
    outside = points - np.clip(points, low[:, None], high[:, None])
    nearest: Floats = np.linalg.norm(outside, axis=-1).min(axis=1)
    return nearest


@given(st.integers(0, 2**32 - 1), st.sampled_from(["any", "point", "parallel", "tiny"]))
def test_distance_agrees_with_sampling(seed: int, shape: str) -> None:
    """The distance agrees with sampled points along the segment to half a step."""
    rng = np.random.default_rng(seed)
    start, end = rng.normal(size=(2, 50, 3))
    if shape == "point":
        end = start.copy()
    elif shape == "parallel":
        end[:, :2] = start[:, :2]
    elif shape == "tiny":
        end = start + 1e-300
    low = 0.5 * rng.normal(size=(50, 3))
    high = low + rng.uniform(0.01, 1.0, (50, 3))
    exact = segment_box_distance_m(start, end, low, high)
    sampled = sampled_distance_m(start, end, low, high)
    half_step_m = np.linalg.norm(end - start, axis=1) / 4000
    assert np.all(exact <= sampled + 1e-12)
    assert np.all(sampled <= exact + half_step_m + 1e-12)


def test_distance_does_not_depend_on_the_direction() -> None:
    """Swapping the ends of a segment does not change the distance."""
    rng = np.random.default_rng(1)
    start, end = rng.normal(size=(2, 200, 3))
    low, high = -rng.uniform(0.1, 1.0, (200, 3)), rng.uniform(0.1, 1.0, (200, 3))
    there = segment_box_distance_m(start, end, low, high)
    np.testing.assert_allclose(there, segment_box_distance_m(end, start, low, high), atol=1e-12)


def test_the_broad_phase_loses_no_contact() -> None:
    """Contacts are exactly the pairs whose distance is at most the radius."""
    segments, radii = body(np.random.default_rng(2), 1)
    n_surfaces = len(ARRAYS.keys)
    surface, part = np.divmod(np.arange(n_surfaces * 22), 22)
    distance_m = segment_box_distance_m(
        segments[0, part, 0], segments[0, part, 1], ARRAYS.low_m[surface], ARRAYS.high_m[surface]
    ).reshape(n_surfaces, 22)
    found = touching(ARRAYS, segments[0], radii)
    assert found.any()
    np.testing.assert_array_equal(distance_m <= radii, found)


def test_frames_at_once_are_frames_one_by_one() -> None:
    """The batched form gives the same contacts as single frames, across chunks."""
    segments, radii = body(np.random.default_rng(3), 300)
    together = np.array(touching_frames(ARRAYS, segments, radii, 0.02))
    single = [np.array(touching_and_near(ARRAYS, frame, radii, 0.02)) for frame in segments]
    np.testing.assert_array_equal(together, np.stack(single, axis=1))


def test_whatever_touches_is_near() -> None:
    """The release margin only adds pairs, so every contact is also near."""
    segments, radii = body(np.random.default_rng(4), 20)
    touches, near = touching_frames(ARRAYS, segments, radii, 0.02)
    assert np.all(near | ~touches)
    assert near.sum() > touches.sum()


def test_a_body_far_from_everything_touches_nothing() -> None:
    """A distant body has no contacts, in arrays of the full shape."""
    segments, radii = body(np.random.default_rng(5), 3)
    far = segments + np.array([0.0, 0.0, 5.0])
    assert not touching(ARRAYS, far[0], radii).any()
    assert touching_frames(ARRAYS, far, radii)[0].shape == (3, len(ARRAYS.keys), 22)
    assert not touching_frames(ARRAYS, far, radii)[0].any()


def test_arrays_of_wrong_shape_are_rejected() -> None:
    """Arrays of a wrong shape raise an error that states the expected and the given shape."""
    with pytest.raises(ValueError, match=r"Expected segments of shape \(P, 2, 3\), got \(2, 3\)"):
        touching(ARRAYS, np.zeros((2, 3)), np.zeros(1))
    with pytest.raises(ValueError, match=r"one radius per part: \(4,\), got \(3,\)"):
        touching(ARRAYS, np.zeros((4, 2, 3)), np.zeros(3))
    with pytest.raises(ValueError, match="release_margin_m is -1"):
        touching_and_near(ARRAYS, np.zeros((1, 2, 3)), np.zeros(1), -1.0)
