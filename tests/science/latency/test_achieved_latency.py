"""Tests that known latencies are recovered and lie within the stated intervals."""

from dataclasses import astuple, replace
from pathlib import Path

import numpy as np
import pytest
from scipy import signal

from app.science import rotations as rot
from app.science.latency.achieved_latency import StreamPair, achieved_latency, latency_of_runs
from tests.science.moving_bodies import (
    Flaws,
    delayed_copy,
    looped_capture,
    made_movement,
    record,
)

MS = 0.001
LATENCIES_S = (0.0, 0.0073, 0.125, 0.35)
CAPTURES = ("02_01", "05_06", "06_01", "12_02")


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(5)


def found(run: StreamPair) -> tuple[float, float, float]:
    """Return the latency and its interval, which must both exist."""
    result = latency_of_runs([run])
    assert result.latency_s is not None, result.reason
    assert result.low_s is not None
    assert result.high_s is not None
    assert result.low_s < result.latency_s < result.high_s
    return result.latency_s, result.low_s, result.high_s


def width(run: StreamPair) -> float:
    """Return the length of the interval."""
    _, low_s, high_s = found(run)
    return high_s - low_s


@pytest.mark.parametrize("latency_s", LATENCIES_S)
def test_noise_on_both_streams_leaves_the_latency(
    latency_s: float, rng: np.random.Generator
) -> None:
    """Half a degree of noise on all rotations of both bodies changes the result by under 1 ms."""
    run = record(made_movement(rng), latency_s, rng, Flaws(noise_deg=0.5))
    got_s, low_s, high_s = found(run)
    assert got_s == pytest.approx(latency_s, abs=1.0 * MS)
    assert high_s - low_s < 1.0 * MS


def test_the_interval_has_its_stated_coverage() -> None:
    """Of forty recordings about two have an interval that misses the true latency."""
    missed = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        latency_s = float(rng.uniform(0.0, 0.4))
        flaws = Flaws(noise_deg=1.5, jitter_s=0.002, dropped=0.1)
        run = record(made_movement(rng), latency_s, rng, flaws, duration_s=15.0)
        _, low_s, high_s = found(run)
        missed += not low_s <= latency_s <= high_s
    # Binomial with n = 40 and p = 0.05: more than 6 in 1 of 300 such tests.
    assert missed <= 6


@pytest.mark.parametrize("latency_s", LATENCIES_S)
def test_jitter_and_dropped_frames_widen_the_interval_and_stay_inside(
    latency_s: float,
) -> None:
    """Jitter, wrong timestamps and dropped frames widen the interval, which covers the truth."""
    noise, worse = Flaws(noise_deg=0.5), Flaws(0.5, jitter_s=0.003, stamp_s=0.002, dropped=0.2)
    clean, poor = (
        record(made_movement(np.random.default_rng(2)), latency_s, np.random.default_rng(3), flaws)
        for flaws in (noise, worse)
    )
    _, low_s, high_s = found(poor)
    assert low_s <= latency_s <= high_s
    assert high_s - low_s > width(clean)


def test_slow_errors_widen_the_interval(rng: np.random.Generator) -> None:
    """Errors that last for a second widen the interval more than equally large quick ones."""
    run = record(made_movement(rng), 0.125, rng, Flaws(noise_deg=0.1))
    drift = np.radians(1.0) * rng.normal(size=(len(run.actual_times_s), 22, 3))
    slow = signal.lfilter([0.02], [1.0, -0.98], drift, axis=0) / np.sqrt(0.02 / 1.98)
    quick_run, slow_run = (
        replace(run, actual_rotations=rot.multiply(run.actual_rotations, noise))
        for noise in (rot.from_rotation_vector(drift), rot.from_rotation_vector(slow))
    )
    assert width(slow_run) > 2.0 * width(quick_run)
    _, low_s, high_s = found(slow_run)
    assert low_s <= 0.125 <= high_s


def test_identical_streams_have_no_latency(rng: np.random.Generator) -> None:
    """Identical streams have zero latency within 0.1 ms, whatever the quaternions' signs."""
    run = record(made_movement(rng), 0.0, rng, Flaws(noise_deg=0.3), duration_s=20.0)
    flips = np.where(rng.random(run.target_rotations.shape[:2]) < 0.5, -1.0, 1.0)
    result = achieved_latency(
        run.target_times_s,
        run.target_rotations,
        run.target_times_s,
        run.target_rotations * flips[..., np.newaxis],
    )
    assert result.latency_s == pytest.approx(0.0, abs=0.1 * MS)
    assert result.correlation == pytest.approx(1.0)


@pytest.mark.parametrize("name", CAPTURES)
@pytest.mark.parametrize("latency_s", [0.0, 0.125, 0.35])
def test_a_captured_movement_through_the_delay_buffer(
    shared_data: Path, name: str, latency_s: float
) -> None:
    """Captured movement delayed by the avatar's own buffer is found to within 1 ms."""
    file = shared_data / "motion" / "cmu_bvh" / f"{name}.bvh"
    run = delayed_copy(*looped_capture(file, 20.0), latency_s)
    got_s, low_s, high_s = found(run)
    assert got_s == pytest.approx(latency_s, abs=0.1 * MS)
    assert low_s <= latency_s <= high_s


def test_a_filter_adds_its_group_delay(rng: np.random.Generator) -> None:
    """A filter of constant group delay adds exactly that delay."""
    run = record(made_movement(rng), 0.125, rng, duration_s=30.0)
    window = np.hanning(21)[1:-1]
    smooth = signal.lfilter(window / window.sum(), [1.0], run.actual_rotations, axis=0)
    late = replace(run, actual_rotations=rot.normalise(smooth[40:]), **_from(run, 40))
    assert found(late)[0] == pytest.approx(0.125 + 9 / 90, abs=0.2 * MS)


def test_a_slow_controller_adds_about_its_mean_lag(rng: np.random.Generator) -> None:
    """A first-order follower lags by its time constant at most, less for quicker movement."""
    keep = np.exp(-1.0 / (90 * 0.05))
    mean_lag_s = keep / (1.0 - keep) / 90
    run = record(made_movement(rng, highest_hz=0.6), 0.0, rng, duration_s=30.0)
    followed = signal.lfilter([1.0 - keep], [1.0, -keep], run.actual_rotations, axis=0)
    late = replace(run, actual_rotations=rot.normalise(followed[90:]), **_from(run, 90))
    assert 0.95 * mean_lag_s < found(late)[0] < mean_lag_s


def _from(run: StreamPair, frame: int) -> dict[str, np.ndarray]:
    return {
        "actual_times_s": run.actual_times_s[frame:],
        "active": run.active[frame:],
    }


def test_constant_and_slow_differences_are_not_time(rng: np.random.Generator) -> None:
    """Constant offsets and slow sagging of the limbs do not change the latency."""
    run = record(made_movement(rng), 0.125, rng, duration_s=30.0)
    share = (run.actual_times_s / 30.0)[:, np.newaxis, np.newaxis]
    sag = rot.from_rotation_vector(rng.normal(size=(22, 3)) * 0.1 * (1.0 + share))
    hanging = replace(run, actual_rotations=rot.multiply(sag, run.actual_rotations))
    assert found(hanging)[0] == pytest.approx(0.125, abs=1.0 * MS)


def test_glitches_and_unusable_samples_decide_nothing(rng: np.random.Generator) -> None:
    """Glitches, NaN, non-unit rotations and untracked joints do not change the latency."""
    run = record(made_movement(rng), 0.125, rng, Flaws(noise_deg=0.2), duration_s=30.0)
    target, actual = run.target_rotations.copy(), run.actual_rotations.copy()
    glitches = rng.random(actual.shape[:2]) < 0.01
    actual[glitches] = rot.normalise(rng.normal(size=(int(glitches.sum()), 4)))
    target[rng.random(target.shape[:2]) < 0.03] = np.nan
    actual[rng.random(actual.shape[:2]) < 0.03] *= 1.5
    actual[:, 7], target[:, 12] = np.inf, 0.0
    times_s = run.actual_times_s.copy()
    times_s[50], times_s[60] = np.nan, times_s[40]
    faulty = replace(run, target_rotations=target, actual_rotations=actual, actual_times_s=times_s)
    got_s, low_s, high_s = found(faulty)
    assert got_s == pytest.approx(0.125, abs=1.0 * MS)
    assert low_s <= 0.125 <= high_s


def test_the_hips_do_not_count(rng: np.random.Generator) -> None:
    """Rotations of the hips, which are not delayed, do not change the latency."""
    run = record(made_movement(rng), 0.125, rng, Flaws(noise_deg=0.2), duration_s=10.0)
    actual = run.actual_rotations.copy()
    actual[:, 0] = rot.normalise(rng.normal(size=(len(actual), 4)))
    assert latency_of_runs([replace(run, actual_rotations=actual)]) == latency_of_runs([run])


def test_only_active_frames_count(rng: np.random.Generator) -> None:
    """Frames of a pause, even with another delay, do not change the latency."""
    movement = made_movement(rng)
    active_run = record(movement, 0.125, rng, duration_s=30.0)
    other = record(movement, 0.3, rng, duration_s=30.0)
    active = (active_run.actual_times_s % 6.0) < 4.0
    mixed = np.where(active[:, None, None], active_run.actual_rotations, other.actual_rotations)
    result = latency_of_runs([replace(active_run, actual_rotations=mixed, active=active)])
    # At the edges the curves include a little of the other side.
    assert result.latency_s == pytest.approx(0.125, abs=1.0 * MS)
    assert result.samples == active.sum()
    assert result.movement_s == pytest.approx(20.0, abs=0.2)


def test_runs_of_the_client_have_clocks_of_their_own(rng: np.random.Generator) -> None:
    """Runs of the client whose clocks differ by a day are each evaluated separately."""
    movement = made_movement(rng)
    first = record(movement, 0.125, rng, duration_s=4.0)
    second = record(movement, 0.125, rng, duration_s=4.0)
    second = replace(
        second,
        target_times_s=second.target_times_s + 86_400.0,
        actual_times_s=second.actual_times_s + 86_400.0,
    )
    assert latency_of_runs([first]).latency_s is None
    result = latency_of_runs([first, second])
    assert result.latency_s == pytest.approx(0.125, abs=0.2 * MS)
    assert result.movement_s == pytest.approx(8.0, abs=0.2)
    assert result.samples == 720


def test_a_long_phase_with_a_long_pause(rng: np.random.Generator) -> None:
    """The latency is found over several stretches with pauses of hours between them."""
    movement = made_movement(rng)
    early = record(movement, 0.125, rng, duration_s=70.0)
    late = record(movement, 0.125, rng, duration_s=10.0)
    hours = (1e4, 0.0, 1e4, 0.0, False)
    run = StreamPair(
        *(
            np.concatenate((before, after + shift))
            for before, after, shift in zip(astuple(early), astuple(late), hours, strict=True)
        )
    )
    result = latency_of_runs([run])
    assert result.latency_s == pytest.approx(0.125, abs=0.1 * MS)
    assert result.movement_s == pytest.approx(80.0, abs=0.3)
