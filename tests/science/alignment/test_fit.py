"""Tests of fitting an alignment: laws, noise, and what cannot be found."""

from dataclasses import replace

import numpy as np
import pytest

from app.science.alignment import (
    Alignment,
    AlignmentError,
    PoseStream,
    estimate_delay,
    fit_alignment,
    refit_world,
)
from app.science.rotations import (
    FloatArray,
    from_rotation_vector,
    geodesic_angle,
    multiply,
    rotate,
)
from tests.science.alignment.rooms import (
    INSIDE_OUT,
    OPTICAL,
    Noise,
    Room,
    foot_errors,
    looking_around,
    moved_world,
    recorded,
    seen_by,
    some_room,
)


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(23)


def _exact(rng: np.random.Generator, seconds: float = 12.0) -> tuple[Room, PoseStream, PoseStream]:
    """Return a room with both streams without noise, sampled at the same moments."""
    head = looking_around(seconds, 90.0)
    room = replace(some_room(rng), delay_s=0.02)
    return room, head, seen_by(room, head)


def test_exact_streams_are_aligned_exactly(rng: np.random.Generator) -> None:
    """Without noise everything is found to nanometres, nanoradians and nanoseconds."""
    room, headset, tracker = _exact(rng)
    found = fit_alignment(headset, tracker)
    assert geodesic_angle(found.rotation, room.rotation) < 1e-9
    assert geodesic_angle(found.mount.rotation, room.mount_rotation) < 1e-9
    np.testing.assert_allclose(found.position_m, room.position_m, atol=1e-9)
    np.testing.assert_allclose(found.mount.position_m, room.mount_m, atol=1e-9)
    assert found.mount.delay_s == pytest.approx(0.02, abs=1e-9)
    assert found.quality.residual_p95_m < 1e-9
    assert found.quality.residual_p95_rad < 1e-9
    head_m, head_q = found.head(headset.times_s, *tracker.at(headset.times_s + 0.02)[:2])
    np.testing.assert_allclose(head_m[9:-9], headset.positions_m[9:-9], atol=1e-8)
    assert float(geodesic_angle(head_q, headset.rotations)[9:-9].max()) < 1e-8


def test_the_choice_of_worlds_and_clocks_changes_nothing_else(rng: np.random.Generator) -> None:
    """Turned and shifted worlds turn and shift the answer; residuals and mount stay the same."""
    headset, tracker = recorded(looking_around(12.0), some_room(rng), OPTICAL, rng)
    found = fit_alignment(headset, tracker)
    (h_turn, t_turn), (h_shift, t_shift) = (
        from_rotation_vector(rng.normal(size=(2, 3))),
        rng.normal(0.0, 3.0, (2, 3)),
    )
    other = fit_alignment(
        moved_world(replace(headset, times_s=headset.times_s + 500.0), h_turn, h_shift),
        moved_world(replace(tracker, times_s=tracker.times_s + 500.0), t_turn, t_shift),
    )
    points, times = rng.normal(size=(5, 3)), np.full(5, found.reference_s + found.mount.delay_s)
    here = _brought(found, times, points)
    there = _brought(other, times + 500.0, rotate(t_turn, points) + t_shift)
    np.testing.assert_allclose(there, rotate(h_turn, here) + h_shift, atol=1e-6)
    np.testing.assert_allclose(other.mount.position_m, found.mount.position_m, atol=1e-6)
    assert geodesic_angle(other.mount.rotation, found.mount.rotation) < 1e-6
    assert other.mount.delay_s == pytest.approx(found.mount.delay_s, abs=1e-6)
    assert other.quality.residual_m == pytest.approx(found.quality.residual_m, rel=1e-3)
    assert other.quality.uncertainty_m == pytest.approx(found.quality.uncertainty_m, rel=1e-2)
    np.testing.assert_allclose(
        other.quality.looking.spread_rad, found.quality.looking.spread_rad, atol=1e-9
    )


def test_another_mount_changes_only_the_mount(rng: np.random.Generator) -> None:
    """A tracker that is mounted otherwise on the same head leaves the worlds as they are."""
    room, headset, tracker = _exact(rng)
    other = replace(
        room, mount_rotation=from_rotation_vector(rng.normal(size=3)), mount_m=-room.mount_m
    )
    found, again = fit_alignment(headset, tracker), fit_alignment(headset, seen_by(other, headset))
    assert geodesic_angle(found.rotation, again.rotation) < 1e-9
    np.testing.assert_allclose(found.position_m, again.position_m, atol=1e-9)
    np.testing.assert_allclose(again.mount.position_m, -room.mount_m, atol=1e-9)


@pytest.mark.parametrize(
    ("seconds", "noise", "foot_m"),
    [
        (10.0, OPTICAL, 0.0023),
        (20.0, OPTICAL, 0.0009),
        (20.0, INSIDE_OUT, 0.0042),
        (20.0, replace(OPTICAL, gross=0.05), 0.0012),
    ],
    ids=["optical-10s", "optical-20s", "inside-out", "gross-errors"],
)
def test_noise_moves_a_foot_by_millimetres(seconds: float, noise: Noise, foot_m: float) -> None:
    """At each level of noise feet, delay and stated uncertainty keep within their bounds."""
    head, feet, delays, surprises = looking_around(seconds), [], [], []
    for seed in range(12):
        rng = np.random.default_rng(seed)
        room = replace(some_room(rng), delay_s=rng.uniform(-0.06, 0.06))
        found = fit_alignment(*recorded(head, room, noise, rng))
        feet.append(float(np.percentile(foot_errors(found, room, head), 95)))
        delays.append(abs(found.mount.delay_s - room.delay_s))
        surprises.append(feet[-1] / found.quality.uncertainty_m)
        assert (found.quality.outliers > 0.01) is (noise.gross > 0.0)
        assert found.quality.outliers <= 2.0 * noise.gross
    assert float(np.percentile(feet, 95)) <= foot_m
    assert float(np.percentile(delays, 95)) <= 0.001
    # Lengths in three dimensions are about 1.5 standard errors, and hardly ever 4.
    assert 0.5 <= float(np.median(surprises)) <= 3.0
    assert max(surprises) < 5.0


@pytest.mark.parametrize("delay_s", [-0.2, 0.0, 0.0137, 0.4])
def test_the_angular_speeds_show_the_delay(delay_s: float) -> None:
    """Speeds alone give any delay within four of their stated standard errors."""
    for seed in range(5):
        rng = np.random.default_rng(seed)
        room = replace(some_room(rng), delay_s=delay_s)
        delay = estimate_delay(*recorded(looking_around(20.0), room, OPTICAL, rng))
        assert abs(delay.delay_s - delay_s) < 4.0 * delay.uncertainty_s
        assert delay.uncertainty_s < 0.002
        assert delay.correlation > 0.95


def test_drift_is_found_where_there_is_one(rng: np.random.Generator) -> None:
    """A drift of 0.1 mm/s is found in 30 s; without a drift, or in 5 s, none is stated."""
    drifting = replace(some_room(rng), drift_m_s=(0.00006, 0.0, -0.00008))
    found = fit_alignment(*recorded(looking_around(30.0), drifting, OPTICAL, rng))
    np.testing.assert_allclose(found.drift_m_s, drifting.drift_m_s, atol=1.5e-5)
    for seconds, room in ((30.0, replace(drifting, drift_m_s=(0.0, 0.0, 0.0))), (5.0, drifting)):
        still = fit_alignment(*recorded(looking_around(seconds), room, OPTICAL, rng))
        assert not still.drift_m_s.any()


def test_after_a_recentre_one_second_is_enough(rng: np.random.Generator) -> None:
    """With a known mount, the worlds are found again from one second of any movement."""
    room, head = some_room(rng), looking_around(20.0)
    headset, tracker = recorded(head, room, OPTICAL, rng)
    known = fit_alignment(headset, tracker)
    turn, shift = from_rotation_vector(np.array((0.0, 0.7, 0.0))), np.array((0.5, 0.0, -0.2))
    second = moved_world(headset.between(9.0, 10.0), turn, shift)
    again = refit_world(second, tracker, known)
    assert again.mount is known.mount
    there = replace(
        room,
        rotation=multiply(turn, room.rotation),
        position_m=rotate(turn, room.position_m) + shift,
    )
    errors = foot_errors(again, there, moved_world(head, turn, shift))
    assert float(np.percentile(errors, 95)) < 0.003


def _turning_about(
    axis: tuple[float, float, float], rng: np.random.Generator
) -> tuple[PoseStream, PoseStream]:
    t = np.arange(0.0, 12.0, 1.0 / 400.0)
    angle = 0.6 * np.sin(1.3 * t) + 0.2 * np.sin(3.1 * t)
    turned = from_rotation_vector(angle[:, np.newaxis] * np.array(axis))
    head = PoseStream.of(t, np.stack((0 * t, 1.6 + 0 * t, 0.1 * np.sin(t)), axis=-1), turned)
    return recorded(head, some_room(rng), OPTICAL, rng)


def _unlike(rng: np.random.Generator) -> tuple[PoseStream, PoseStream]:
    headset, _ = recorded(looking_around(12.0), some_room(rng), OPTICAL, rng)
    backwards = looking_around(12.0)
    backwards = replace(backwards, rotations=backwards.rotations[::-1] * 1.0)
    return headset, recorded(backwards, some_room(rng), OPTICAL, rng)[1]


def _later(rng: np.random.Generator) -> tuple[PoseStream, PoseStream]:
    return recorded(looking_around(12.0), replace(some_room(rng), delay_s=0.8), OPTICAL, rng)


def _still(rng: np.random.Generator) -> tuple[PoseStream, PoseStream]:
    return _turning_about((0.0, 0.005, 0.0), rng)


def _brief(rng: np.random.Generator) -> tuple[PoseStream, PoseStream]:
    return recorded(looking_around(2.0), some_room(rng), OPTICAL, rng)


@pytest.mark.parametrize(
    ("streams", "problem", "words"),
    [
        (lambda rng: _turning_about((0.0, 1.0, 0.0), rng), "nod", "up and down"),
        (lambda rng: _turning_about((1.0, 0.0, 0.0), rng), "turn", "left and right"),
        (_still, "still", "look around"),
        (_unlike, "unlike", "is it fixed"),
        (_brief, "short", "2 s are needed"),
    ],
    ids=["turned-only", "nodded-only", "still", "other-head", "brief"],
)
def test_what_cannot_be_aligned_is_named(
    streams: object, problem: str, words: str, rng: np.random.Generator
) -> None:
    """A movement that shows no alignment is refused, with what to do instead."""
    assert callable(streams)
    with pytest.raises(AlignmentError, match=words) as caught:
        fit_alignment(*streams(rng))
    assert caught.value.problem == problem


def test_a_delay_outside_of_the_range_is_never_made_up(rng: np.random.Generator) -> None:
    """A tracker that comes later than was searched is refused as such or as unlike."""
    with pytest.raises(AlignmentError) as caught:
        fit_alignment(*_later(rng), longest_delay_s=0.3)
    assert caught.value.problem in {"delay", "unlike"}


def test_samples_of_no_weight_and_gaps_do_not_count(rng: np.random.Generator) -> None:
    """Guessed samples, marked by weight 0, and samples that are missing leave the fit exact."""
    room, headset, tracker = _exact(rng)
    guessed = (tracker.times_s > 4.0) & (tracker.times_s < 6.0)
    frozen = replace(
        tracker,
        positions_m=np.where(guessed[:, None], tracker.positions_m[0], tracker.positions_m),
        rotations=np.where(guessed[:, None], tracker.rotations[0], tracker.rotations),
        weights=np.where(guessed, 0.0, 1.0),
    )
    kept = ~guessed
    gap = PoseStream.of(tracker.times_s[kept], tracker.positions_m[kept], tracker.rotations[kept])
    for stream in (frozen, gap):
        found = fit_alignment(headset, stream)
        assert geodesic_angle(found.rotation, room.rotation) < 1e-9
        assert found.quality.samples < len(headset.times_s) - 170


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"times_s": [0.0, 0.0, 0.2]}, "Sample 2 of 3.*not later"),
        ({"positions_m": [[0, 0, 0], [0, np.nan, 0], [0, 0, 0]]}, "Sample 2.*finite position"),
        ({"rotations": np.zeros((3, 4))}, "Sample 1.*unit length"),
        ({"weights": [1.0, 1.0, -1.0]}, "Sample 3.*weight"),
        ({"positions_m": np.zeros((2, 3))}, r"\(2, 3\)"),
    ],
)
def test_streams_that_are_none_are_refused(change: dict[str, object], words: str) -> None:
    """A sample that is not a pose is refused with its number and time."""
    good: dict[str, object] = {
        "times_s": [0.0, 0.1, 0.2],
        "positions_m": np.zeros((3, 3)),
        "rotations": np.tile((1.0, 0.0, 0.0, 0.0), (3, 1)),
        "weights": np.ones(3),
    }
    with pytest.raises(AlignmentError, match=words):
        PoseStream.of(**{**good, **change})  # type: ignore[arg-type]  # wrong on purpose


def _brought(found: Alignment, times_s: FloatArray, points_m: FloatArray) -> FloatArray:
    return found.to_headset(times_s, points_m, np.tile((1.0, 0.0, 0.0, 0.0), (len(points_m), 1)))[1]
