"""Tests of the faults that are found in frames as they arrive."""

import json

import numpy as np
import pytest

from app.science import rotations as rot
from app.science.skeleton import JOINT_INDEX
from app.wire import BODY_STREAMS, GOALS, GoalsReport, StreamName
from tests.features.record.alarms.watched import TREMBLING, Watched, at, batch, there_and_back
from tests.science.stream_quality.recordings import Recording, generated

HEAD = JOINT_INDEX["Head"]
MINUTE = there_and_back(TREMBLING)
UPSIDE_DOWN = np.array((0.0, 1.0, 0.0, 0.0))


def raised_alarms(recording: Recording, time_scale: float = 1.0) -> set[tuple[str, str | None]]:
    """Return (code, stream) of every alarm raised by a recording, without those of the clock."""
    watched = Watched(time_scale)
    watched.play(recording)
    raised = {change.condition.key for change in watched.changes if change.state == "raised"}
    return {key for key in raised if not key[0].startswith("clock")}


@pytest.mark.parametrize("time_scale", [1.0, 20.0, 100.0])
@pytest.mark.parametrize("sound", [generated(1), generated(2), MINUTE])
def test_valid_movement_raises_no_alarm_at_any_speed(sound: Recording, time_scale: float) -> None:
    """Valid movement raises no alarm, in real time or a hundred times faster."""
    assert raised_alarms(sound, time_scale) == set()


@pytest.mark.parametrize("time_scale", [1.0, 20.0])
def test_each_fault_raises_its_alarm_and_no_other(time_scale: float) -> None:
    """Each fault in both streams raises its own alarm in both, and no other alarm."""
    both = set(BODY_STREAMS)

    def raised_by(bad: Recording) -> set[str]:
        found = raised_alarms(bad, time_scale)
        assert {stream for _, stream in found} == both
        return {code for code, _ in found}

    gap = MINUTE.copy()
    gap.times_s[2000:] += 0.5
    frozen = MINUTE.copy()
    frozen.rotations[2000:2600, HEAD] = frozen.rotations[2000, HEAD]
    jump = MINUTE.copy()
    jump.positions_m[2000:] += 1.0
    broken = MINUTE.copy()
    broken.rotations[2000, HEAD] = np.nan
    slow = MINUTE.copy()
    slow.times_s[2000:] = slow.times_s[2000] + np.arange(len(slow) - 2000) / 60.0
    assert raised_by(gap) == {"gap"}
    assert raised_by(frozen) == {"frozen"}
    assert raised_by(jump) == {"jump"}
    assert raised_by(broken) == {"bad_values"}
    assert raised_by(slow) == {"low_frame_rate"}


def test_an_alarm_states_joint_duration_and_time() -> None:
    """An alarm names the joint, the duration and the time on the client's clock."""
    frozen = MINUTE.copy()
    frozen.rotations[2000:2600, HEAD] = frozen.rotations[2000, HEAD]
    watched = Watched()
    watched.play(frozen)
    raised = next(one for one in watched.changes if one.condition.code == "frozen")
    cleared = [one for one in watched.changes if one.state == "cleared"]
    condition = raised.condition
    assert (condition.joints, condition.unit) == (("Head",), "s")
    assert condition.message.startswith("Head of the target stream frozen for")
    assert condition.client_t_s == pytest.approx(2090 / 90, abs=1.5)
    assert {one.condition.code for one in cleared} == {"frozen"}
    assert cleared[0].condition.value == pytest.approx(600 / 90, abs=1.5)


@pytest.mark.parametrize(("from_hz", "to_hz", "raised"), [(90, 72, False), (90, 60, True)])
def test_a_display_rate_is_not_a_low_frame_rate(from_hz: int, to_hz: int, raised: bool) -> None:  # noqa: FBT001 - by name
    """A drop from 90 Hz to the display rate of 72 Hz raises no alarm; one to 60 Hz does."""
    slow = MINUTE.copy()
    slow.times_s[:2000] = np.arange(2000) / from_hz
    slow.times_s[2000:] = slow.times_s[1999] + (1.0 + np.arange(len(slow) - 2000)) / to_hz
    assert (("low_frame_rate", StreamName.TARGET) in raised_alarms(slow)) is raised


def test_short_gaps_are_counted_without_an_alarm() -> None:
    """Gaps of about 60 ms are counted in the signal but raise no alarm."""
    stuttering = MINUTE.copy()
    for first in range(1000, 1500, 100):
        stuttering.times_s[first:] += 0.05
    watched = Watched()
    watched.play(stuttering)
    assert {code for code, _ in watched.reported} <= {"clock_unknown"}
    signal = watched.watch.signal(at(60.0))
    assert signal["gaps"] == 5
    assert signal["gap_s"] == pytest.approx(5 * (0.05 + 1 / 90), abs=0.02)


def test_the_gap_count_restarts_with_each_phase() -> None:
    """The count of gaps restarts with each phase."""
    gap = MINUTE.copy()
    gap.times_s[500:] += 0.5
    watched = Watched()
    watched.play(gap.part(slice(0, 900)))
    assert watched.watch.signal(at(10.0))["gaps"] == 1
    for first in range(900, 1080, 9):
        watched.watch.batch(batch(gap, first, phase_id=2), at(10.0))
        watched.watch.batch(batch(gap, first, phase_id=2, stream=StreamName.ACTUAL), at(10.0))
    assert watched.watch.signal(at(12.0))["gaps"] == 0


def test_resent_frames_are_checked_once() -> None:
    """Frames that are resent or out of order are not checked again and raise no alarm."""
    watched = Watched()
    for first in range(0, 900, 9):
        for _ in range(2):
            watched.changes += watched.watch.batch(batch(MINUTE, first, 9), at(first / 90))
        watched.changes += watched.watch.batch(batch(MINUTE, first + 50, 9), at(first / 90))
    assert watched.reported == []
    assert watched.watch.signal(at(10.0))["frame_rate_hz"] == pytest.approx(90.0, abs=0.5)


def test_a_change_of_delay_between_phases_is_not_a_jump() -> None:
    """A sudden change of pose between phases is a jump in the target, not in the actual stream."""
    for stream, raised in ((StreamName.TARGET, ["jump"]), (StreamName.ACTUAL, [])):
        moved = MINUTE.copy()
        moved.rotations[450:, HEAD] = rot.multiply(
            UPSIDE_DOWN, moved.rotations[450:, HEAD].astype(float)
        )
        watched = Watched()
        for first in range(0, 900, 9):
            phase_id = 1 if first < 450 else 2
            sent = batch(moved, first, stream=stream, phase_id=phase_id)
            watched.changes += watched.watch.batch(sent, at(first / 90))
        assert [change.condition.code for change in watched.changes][:1] == raised


def test_late_frames_of_an_earlier_epoch_raise_no_alarm() -> None:
    """Late frames of an earlier epoch, which has its own clock, raise no alarm."""
    watched = Watched()
    for first in range(0, 450, 9):
        watched.changes += watched.watch.batch(
            batch(MINUTE, 900 + first, epoch=2, seq_first=first), at(0)
        )
        watched.changes += watched.watch.batch(batch(MINUTE, first, epoch=1), at(0))
    assert watched.reported == []


def test_invalid_frames_give_a_signal_of_valid_json() -> None:
    """Frames with non-finite or extreme values give a signal and alarms in valid JSON."""
    rng = np.random.default_rng(3)
    odd = MINUTE.part(slice(0, 900)).copy()
    late = rng.random(len(odd)) < 0.2
    odd.times_s[late] = rng.choice([1e308, -1e308, np.nan, np.inf], int(late.sum()))
    odd.positions_m[rng.random(len(odd)) < 0.1] = 3e38
    watched = Watched()
    watched.play(odd)
    values = [(one.condition.value, one.condition.client_t_s) for one in watched.changes]
    json.dumps([watched.watch.signal(at(10.0)), values], allow_nan=False)
    assert values


def test_a_device_that_draws_too_slowly_has_one_alarm_that_says_so() -> None:
    """Pictures that all come half a second apart or more are one fault, not many gaps."""
    slow = MINUTE.part(slice(0, 72)).copy()
    slow.times_s[:] = 0.8 * np.arange(72)
    watched = Watched()
    for first in range(0, 72, 2):
        for stream in BODY_STREAMS:
            sent = batch(slow, first, 2, stream=stream)
            watched.changes += watched.watch.batch(sent, at(0.8 * first))
        watched.check(0.8 * first)
    raised = [c.condition for c in watched.changes if c.state == "raised"]
    (condition,) = [one for one in raised if one.code == "too_slow"]
    assert (condition.value, condition.unit) == (1.2, "Hz")
    assert sum(one.code == "gap" for one in raised) <= len(BODY_STREAMS)


@pytest.mark.parametrize("source", ["desktop", "script"])
def test_a_computed_pose_raises_no_alarm_of_a_sensor(source: str) -> None:
    """A joint that rests to the last digit is a fault of a sensor only where there is one."""
    frozen = MINUTE.copy()
    frozen.rotations[2000:2600, HEAD] = frozen.rotations[2000, HEAD]
    watched = Watched()
    states = dict.fromkeys(GOALS, "tracked")
    watched.watch.feet.goals = GoalsReport.model_validate(
        {"t_s": 0.0, "frame_seq": 0, "source": source, "states": states}
    )
    watched.play(frozen)
    assert {code for code, _ in watched.reported} <= {"clock_unknown"}
