"""Tests that a reason is given where the data do not allow a latency."""

import re
from dataclasses import astuple, replace
from pathlib import Path

import numpy as np
import pytest

from app.science import rotations as rot
from app.science.latency.achieved_latency import (
    AchievedLatency,
    AchievedLatencyError,
    StreamPair,
    achieved_latency,
    is_off,
    latency_of_runs,
    tolerance_s,
)
from app.science.rotations import FloatArray
from tests.science.moving_bodies import (
    Flaws,
    Movement,
    delayed_copy,
    looped_capture,
    made_movement,
    record,
)

MS = 0.001


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(5)


def test_little_movement_gives_no_latency_but_says_how_much(rng: np.random.Generator) -> None:
    """With less than 5 s above 20 deg/s no latency is given, only the amount of movement."""
    movement = made_movement(rng)

    def stops(times_s: FloatArray) -> FloatArray:
        return movement(np.minimum(times_s, 3.2))

    result = latency_of_runs([record(stops, 0.125, rng, Flaws(noise_deg=0.2), duration_s=10.0)])
    assert (result.latency_s, result.low_s, result.high_s) == (None, None, None)
    assert result.movement_s == pytest.approx(3.25, abs=0.1)
    assert re.fullmatch(r"3\.\d s of movement above 20 deg/s; 5 s are needed\.", str(result.reason))


@pytest.mark.parametrize(("speed_deg_s", "expected_s"), [(18.0, 0.0), (22.0, 8.0)])
def test_movement_is_what_turns_faster_than_20_degrees_a_second(
    speed_deg_s: float, expected_s: float
) -> None:
    """Movement is the time in which any joint turns faster than 20 deg/s; noise does not count."""
    rng = np.random.default_rng(1)
    times_s = np.arange(0.0, 8.0, 1 / 90)
    vectors = np.radians(0.2) * rng.normal(size=(len(times_s), 22, 3))
    vectors[:, 9, 1] += np.radians(speed_deg_s) * times_s
    q = rot.from_rotation_vector(vectors)
    movement_s = achieved_latency(times_s, q, times_s, q).movement_s
    assert movement_s == pytest.approx(expected_s, abs=0.1)


def test_unrelated_bodies_have_no_latency(rng: np.random.Generator) -> None:
    """Unrelated, shuffled, reversed or motionless streams have no latency, each with a reason."""
    run = record(made_movement(rng), 0.125, rng, duration_s=30.0)
    other = record(made_movement(rng), 0.125, rng, duration_s=30.0).actual_rotations
    own = run.actual_rotations
    for actual in (other, own[rng.permutation(len(own))], own[::-1], own[:1].repeat(len(own), 0)):
        result = latency_of_runs([replace(run, actual_rotations=actual)])
        assert result.latency_s is None
        assert result.reason is not None
        assert "do not match" in result.reason


def test_a_latency_beyond_the_lags_is_not_made_up(rng: np.random.Generator) -> None:
    """A latency beyond the searched lags gives no number, but a reason."""
    result = latency_of_runs([record(made_movement(rng), 0.52, rng)], highest_s=0.5)
    assert result.latency_s is None
    assert result.reason is not None


@pytest.mark.parametrize("noise_deg", [0.0, 0.3])
@pytest.mark.parametrize("latency_s", [0.0, 0.125, 0.35])
def test_movement_that_repeats_gives_the_smallest_lag_and_says_so(
    latency_s: float, noise_deg: float, rng: np.random.Generator
) -> None:
    """For perfectly periodic movement the smallest lag is given with a warning."""
    movement = made_movement(rng, highest_hz=0.1)
    stride = record(_every_second(movement), latency_s, rng, Flaws(noise_deg=noise_deg))
    result = latency_of_runs([stride])
    assert result.latency_s == pytest.approx(latency_s, abs=1.0 * MS)
    other_ms = round(1000 * latency_s) + 1000
    assert result.reason == f"The movement repeats itself: {other_ms} ms would fit as well."


def _every_second(movement: Movement) -> Movement:
    return lambda times_s: movement(5.0 * np.sin(2.0 * np.pi * times_s))


def test_walking_that_differs_from_step_to_step_is_not_ambiguous(shared_data: Path) -> None:
    """The latency of real walking is unambiguous although its steps look alike."""
    times_s, rotations = looped_capture(shared_data / "motion" / "cmu_bvh" / "02_01.bvh", 30.0)
    result = latency_of_runs([delayed_copy(times_s, rotations, 1.2)])
    assert result.latency_s == pytest.approx(1.2, abs=0.1 * MS)
    assert result.reason is None


def test_latency_is_off_beyond_ten_milliseconds_or_a_frame() -> None:
    """A latency counts as off beyond the longer of 10 ms and a frame; an unknown one never does."""
    at_90 = AchievedLatency(0.125, 0.124, 0.126, 60.0, 5400, 1 / 90)
    assert tolerance_s(at_90) == 1 / 90
    assert tolerance_s(replace(at_90, frame_s=1 / 120)) == 0.010
    assert not is_off(at_90, 0.125 + 0.0110)
    assert is_off(at_90, 0.125 + 0.0112)
    assert is_off(replace(at_90, frame_s=1 / 120), 0.125 - 0.0101)
    assert not is_off(replace(at_90, latency_s=None), 10.0)


def test_empty_streams_have_a_reason() -> None:
    """Streams without usable or active frames give no latency, but a reason."""
    rng = np.random.default_rng(0)
    run = record(made_movement(rng), 0.0, rng, duration_s=6.0)
    none = StreamPair(*(values[:0] for values in astuple(run)))
    one = StreamPair(*(values[:1] for values in astuple(run)))
    paused = replace(run, active=np.zeros_like(run.active))
    nan = replace(run, actual_times_s=np.full_like(run.actual_times_s, np.nan))
    for runs in ([], [none], [one], [paused], [nan]):
        result = latency_of_runs(runs)
        assert (result.latency_s, result.movement_s) == (None, 0.0)
        assert result.reason == "There are no active frames of both bodies."


def test_streams_of_other_shapes_are_rejected() -> None:
    """Errors about wrong joints, unequal lengths and impossible lags name them."""
    times_s, q = np.arange(5.0), rot.identity(5, 22)
    with pytest.raises(AchievedLatencyError, match="do not fit"):
        achieved_latency(times_s, q[:, :21], times_s, q)
    with pytest.raises(AchievedLatencyError, match="do not fit"):
        achieved_latency(times_s, q, times_s[:4], q)
    with pytest.raises(AchievedLatencyError, match="active"):
        achieved_latency(times_s, q, times_s, q, active=np.ones(4, dtype=np.bool_))
    with pytest.raises(AchievedLatencyError, match="not a range"):
        achieved_latency(times_s, q, times_s, q, lowest_s=1.0, highest_s=0.5)


@pytest.mark.parametrize("share", [0.25, 0.5, 0.8])
@pytest.mark.parametrize("after_s", [0.2, 0.35])
def test_a_delay_that_changes_is_noticed_with_its_pieces(
    share: float, after_s: float, rng: np.random.Generator
) -> None:
    """A delay that grows from 100 ms on the way is flagged, and its pieces are named."""
    movement = made_movement(rng)
    before, after = (
        record(movement, latency_s, np.random.default_rng(8)) for latency_s in (0.1, after_s)
    )
    later = before.actual_times_s > share * before.actual_times_s[-1]
    both = np.where(later[:, None, None], after.actual_rotations, before.actual_rotations)
    result = latency_of_runs([replace(before, actual_rotations=both)])
    assert result.changed
    assert is_off(result, 0.1)
    assert is_off(result, 0.15)
    assert result.pieces_s[0] == pytest.approx(0.1, abs=1.0 * MS)
    # The last piece begins at 75 % of the phase, which may be before the change.
    assert result.pieces_s[-1] == pytest.approx(after_s, abs=5.0 * MS)
    assert result.reason is not None
    assert "changed during the phase; its pieces, in order: 100 ms, " in result.reason


@pytest.mark.parametrize(
    ("late", "seconds"),
    [
        (lambda t_s: np.where(t_s // 1.0 % 2 == 0, 0.1, 0.2), range(15, 26)),
        (lambda t_s: np.where(t_s // 5.0 % 2 == 0, 0.1, 0.2), range(15, 26)),
        (lambda t_s: np.where((t_s > 16.0) & (t_s < 24.0), 0.3, 0.1), range(6, 10)),
        (lambda t_s: np.where(t_s > 36.0, 0.2, 0.1), range(3, 6)),
    ],
    ids=["every second", "every five seconds", "for eight seconds", "for the last tenth"],
)
def test_a_delay_that_changes_for_moments_is_noticed(
    late: Movement, seconds: range, rng: np.random.Generator
) -> None:
    """A delay that alternates, or grows for a while within 40 s, is flagged with its seconds."""
    movement = made_movement(rng)
    usual = record(movement, 0.0, rng, Flaws(noise_deg=0.1), duration_s=40.0)
    moved = record(
        lambda times_s: movement(times_s - late(times_s)),
        0.0,
        rng,
        Flaws(noise_deg=0.1),
        duration_s=40.0,
    )
    result = latency_of_runs([replace(usual, actual_rotations=moved.actual_rotations)])
    assert result.changed
    assert is_off(result, 0.1)
    assert result.reason is not None
    told = re.search(r"(\d+) ms in the median second.* in (\d+) of \d+\.", result.reason)
    assert told is not None
    assert int(told[2]) in seconds


@pytest.mark.parametrize("noise_deg", [0.0, 1.5])
def test_a_constant_delay_has_not_changed(noise_deg: float, rng: np.random.Generator) -> None:
    """Noise, jitter and dropped frames do not make pieces of one delay differ."""
    flaws = Flaws(noise_deg=noise_deg, jitter_s=0.002, dropped=0.1)
    result = latency_of_runs([record(made_movement(rng), 0.125, rng, flaws)])
    assert not result.changed
    assert result.pieces_s == pytest.approx([0.125] * 4, abs=4.0 * MS)
    assert result.reason is None
