"""Tests of the quality check on recordings whose faults are known to the frame."""

import numpy as np
import pytest
from numpy.typing import NDArray

from app.science.skeleton import JOINT_INDEX
from app.science.stream_quality import Memory, QualityLimits, StreamQuality, assess, examine
from tests.science.simulation.people import RATE_HZ
from tests.science.stream_quality.recordings import Recording, generated

FRAME_S = 1.0 / RATE_HZ
HEAD, HAND = JOINT_INDEX["Head"], JOINT_INDEX["RightHand"]


def quality(recording: Recording, counted: NDArray[np.bool_] | None = None) -> StreamQuality:
    """Return the faults of a recording, counted."""
    return assess(recording.times_s, recording.rotations, recording.positions_m, counted=counted)


def test_a_sound_recording_has_no_fault() -> None:
    """A sound recording of 28 s with standing feet and unmoving toes has no fault."""
    found = quality(generated())
    assert found.frames == 28 * 90
    assert found.span_s == pytest.approx(28.0 - FRAME_S)
    assert found.frame_rate_hz == pytest.approx(90.0)
    faults = (found.gaps, found.jumps, found.non_unit, found.non_finite, found.backwards)
    assert (faults, found.frozen_joints) == ((0, 0, 0, 0, 0), ())


@pytest.mark.parametrize(("missing", "gaps"), [(1, 0), (2, 0), (3, 1), (45, 1)])
def test_a_gap_is_longer_than_two_late_frames(missing: int, gaps: int) -> None:
    """At 90 Hz 33 ms (two missing frames) are no gap, 44 ms are one."""
    found = quality(generated().without(np.arange(100, 100 + missing)))
    assert found.gaps == gaps
    length_s = (missing + 1) * FRAME_S if gaps else 0.0
    assert (found.gap_s, found.longest_gap_s) == pytest.approx((length_s, length_s))
    assert found.frame_rate_hz == pytest.approx(90.0)


def test_at_a_low_frame_rate_a_gap_is_longer() -> None:
    """At 30 Hz, 67 ms (one missing frame) is not a gap; 100 ms is."""
    slow = generated().part(slice(None, None, 3))
    assert quality(slow.without(np.array([50]))).gaps == 0
    assert quality(slow.without(np.array([50, 51]))).gaps == 1


def test_a_time_that_is_not_later_runs_backwards() -> None:
    """A time that goes back or repeats is counted once as running backwards."""
    bad = generated().copy()
    bad.times_s[200:] -= 5.0
    assert quality(bad).backwards == 1
    bad = generated().copy()
    bad.times_s[300] = bad.times_s[299]
    assert quality(bad).backwards == 1


def test_a_pose_that_is_off_for_one_frame_jumps_there_and_back() -> None:
    """A joint that is wrong for one frame has two jumps, and no other joint has any."""
    bad = generated().copy()
    bad.rotations[500, HEAD] = (0.0, 0.0, 1.0, 0.0)
    found = examine(bad.times_s, bad.rotations, bad.positions_m)
    assert np.argwhere(found.turned).tolist() == [[500, HEAD], [501, HEAD]]
    assert quality(bad).jumps == 2


@pytest.mark.parametrize(("turn_deg", "jumps"), [(21.0, 0), (24.0, 1)])
def test_the_fastest_turn_is_an_argument(turn_deg: float, jumps: int) -> None:
    """A joint's speed limit can be set: 2,000 deg/s are 22.2 degrees in a frame at 90 Hz."""
    still = np.zeros((10, 22, 4), np.float32)
    still[..., 0] = 1.0
    half = np.radians(turn_deg) / 2.0
    still[5:, HAND] = (np.cos(half), 0.0, np.sin(half), 0.0)
    times_s, places = np.arange(10) / RATE_HZ, np.zeros((10, 3), np.float32)
    assert assess(times_s, still, places).jumps == jumps
    strict = QualityLimits(turn_rad_per_s=np.radians(500.0))
    assert assess(times_s, still, places, limits=strict).jumps == 1


@pytest.mark.parametrize(("step_m", "jumps"), [(0.10, 0), (0.12, 1)])
def test_hips_that_move_faster_than_anybody_jump(step_m: float, jumps: int) -> None:
    """Hips faster than 10 m/s, 11 cm in a frame at 90 Hz, count as a jump."""
    bad = generated().copy()
    bad.positions_m[700:, 0] += np.float32(step_m) - np.diff(bad.positions_m[699:701, 0])[0]
    assert quality(bad).jumps == jumps


def test_a_stutter_of_the_clock_is_no_jump() -> None:
    """Two frames with timestamps 1 ms apart and a movement of 11 ms are no jump."""
    bad = generated().copy()
    bad.times_s[1::5] -= FRAME_S - 0.001
    assert quality(bad).jumps == 0


def test_a_person_may_move_while_nothing_is_seen() -> None:
    """After a gap of half a second any pose is accepted."""
    bad = generated().without(np.arange(800, 845))
    bad.rotations[800:, HAND] = (0.0, 1.0, 0.0, 0.0)
    assert quality(bad).jumps == 0


def test_a_frozen_joint_is_named_and_timed() -> None:
    """A frozen joint is reported as frozen since its last change, exact to one frame."""
    bad = generated().copy()
    bad.rotations[900:1350, HEAD] = bad.rotations[900, HEAD]
    found = quality(bad)
    assert found.frozen_joints == ("Head",)
    assert found.frozen_s[HEAD] == pytest.approx(450 * FRAME_S, abs=2 * FRAME_S)


@pytest.mark.parametrize("frames", [45, 88])
def test_a_short_stillness_is_no_freeze(frames: int) -> None:
    """A joint that is still for less than a second is not frozen."""
    bad = generated().copy()
    bad.rotations[900 : 900 + frames, HEAD] = bad.rotations[900, HEAD]
    assert quality(bad).frozen_joints == ()


def test_a_joint_that_never_moved_is_still_and_not_frozen() -> None:
    """A joint that never moves, since it is not tracked, is not frozen."""
    bad = generated().copy()
    bad.rotations[:, HEAD] = (1.0, 0.0, 0.0, 0.0)
    assert quality(bad).frozen_joints == ()


def test_a_joint_that_rests_now_and_then_is_not_frozen() -> None:
    """A joint that rests repeatedly, such as a leg placed by a solver, is not frozen."""
    bad = generated().copy()
    for begin in range(0, len(bad), 360):
        bad.rotations[begin : begin + 180, HEAD] = bad.rotations[begin, HEAD]
    assert quality(bad).frozen_joints == ()


def test_a_body_that_stands_still_as_a_whole_is_not_frozen() -> None:
    """A body that is still as a whole, as at the end of a phase, is not frozen."""
    bad = generated().copy()
    bad.rotations[1200:] = bad.rotations[1200]
    assert quality(bad).frozen_joints == ()


def test_a_joint_that_freezes_again_is_found_again() -> None:
    """A joint that freezes a second time is found again."""
    bad = generated().copy()
    for begin in (500, 1100, 1700):
        bad.rotations[begin : begin + 270, HEAD] = bad.rotations[begin, HEAD]
    assert quality(bad).frozen_s[HEAD] == pytest.approx(9.0, abs=6 * FRAME_S)


def test_a_gap_is_no_freeze() -> None:
    """A joint that is the same before and after a gap of ten seconds is not frozen."""
    bad = generated().copy()
    bad.rotations[600:660, HEAD] = bad.rotations[600, HEAD]
    bad.times_s[630:] += 10.0
    assert quality(bad).frozen_joints == ()


def test_faults_outside_active_time_are_not_counted() -> None:
    """Faults outside of active time are not counted."""
    bad = generated().copy()
    bad.rotations[100, 0, 0] = np.nan
    bad.rotations[200, 0] *= 1.1
    bad.rotations[300:, HEAD] = (0.0, 0.0, 1.0, 0.0)
    bad.times_s[400:] += 1.0
    active = np.arange(len(bad)) >= 450
    everything, counted = quality(bad), quality(bad, active)
    assert (everything.non_finite, everything.non_unit, everything.gaps) == (1, 1, 1)
    assert (counted.non_finite, counted.non_unit, counted.gaps, counted.jumps) == (0, 0, 0, 0)
    assert counted.frames == active.sum()
    assert counted.span_s == pytest.approx((active.sum() - 1) * FRAME_S)


def test_a_gap_counts_if_the_clock_ran_before_it() -> None:
    """A gap counts if active time was running before it, not if the clock was paused."""
    bad = generated().copy()
    bad.times_s[450:] += 60.0
    ran = np.arange(len(bad)) < 450
    assert quality(bad, ran).gaps == 1
    assert quality(bad, np.arange(len(bad)) < 440).gaps == 0


def test_a_span_may_begin_with_another_pose() -> None:
    """A pose that changes because the avatar's delay was changed is no jump."""
    first, then = generated().part(slice(0, 300)), generated().part(slice(900, 1200)).copy()
    then.rotations[:, HAND] = (0.0, 1.0, 0.0, 0.0)
    memory = examine(first.times_s, first.rotations, first.positions_m).after
    then.times_s[:] = first.times_s + first.times_s[-1] + FRAME_S
    arrays = (then.times_s, then.rotations, then.positions_m)
    assert examine(*arrays, before=memory).jumped[0]
    assert not examine(*arrays, before=memory.without_pose()).jumped.any()
    assert isinstance(memory, Memory)
