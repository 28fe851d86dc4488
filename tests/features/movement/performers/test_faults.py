"""What becomes of a skeleton whose bones are lost, vanish, appear, or change."""

import json
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from app.adapters.live import Pose
from app.features.movement.live.sources import DoorKey, Sample
from app.features.movement.performers.performer import Performer, PerformerName
from app.features.movement.performers.recording import Recording, at_constant_rate
from app.features.movement.performers.views import _proposed
from app.science.rig import RigMotion
from tests.features.movement.performers.senders import by_json, by_vmc, part_of_walk, samples


@pytest.fixture(scope="module")
def walk() -> RigMotion:
    """Provide a quarter of a second of a generated walk."""
    return part_of_walk(60, 90)


def performer(door: DoorKey) -> Performer:
    """Return a performer of a door."""
    return Performer(PerformerName(door, "x", ""), "127.0.0.1:5")


def without(sample: Sample, *bones: str) -> Sample:
    """Return a sample that lacks some bones."""
    return replace(sample, poses=tuple(one for one in sample.poses if one.tracker not in bones))


def test_a_lost_bone_keeps_its_pose_and_is_not_observed(walk: RigMotion) -> None:
    """Also one that the source sends but does not track."""
    one = performer("json")
    first, second, third = list(samples("json", by_json(walk)))[:3]
    (before,) = one.take(first, first.skeletons[0])
    (after,) = one.take(without(second, "LeftFoot"), second.skeletons[0])
    foot = walk.rig.index("LeftFoot")
    assert before.observed.all()
    assert np.flatnonzero(~after.observed).tolist() == [foot]
    np.testing.assert_array_equal(after.rotations[foot], before.rotations[foot])
    poses = tuple(replace(pose, tracked=pose.tracker != "Head") for pose in third.poses)
    (last,) = one.take(replace(third, poses=poses), third.skeletons[0])
    assert np.flatnonzero(~last.observed).tolist() == [walk.rig.index("Head")]


def test_a_skeleton_waits_for_its_last_bone_and_says_which(walk: RigMotion) -> None:
    """No frame before; the first whole one is the standing frame."""
    one = performer("json")
    packets = list(samples("json", by_json(walk)))[:2]
    definition = packets[0].skeletons[0]
    assert one.take(without(packets[0], "Head", "LeftToes"), definition) == []
    assert list(one.missing) == ["Head", "LeftToes"]
    assert not one.agree("standing")
    (frame,) = one.take(packets[1], definition)
    assert not one.missing
    assert one.agreed is not None
    assert one.agreed.standing is frame


def test_a_bone_that_a_vmc_sender_stops_or_begins_to_send_changes_the_skeleton(
    walk: RigMotion,
) -> None:
    """Within about a second without a bone; at once with a new one."""
    one = performer("osc")
    packets = list(samples("osc", by_vmc(walk)))
    later = [replace(each, arrival_s=each.arrival_s + 2.0) for each in packets]
    frames = [frame for each in packets for frame in one.take(without(each, "LeftToes"), None)]
    assert {frame.rotations.shape[0] for frame in frames} == {21}
    frames = [frame for each in later for frame in one.take(each, None)]
    assert frames[-1].rotations.shape[0] == 22
    gone = [replace(without(each, "RightToes"), arrival_s=each.arrival_s + 4.0) for each in later]
    frames = [frame for each in gone for frame in one.take(each, None)]
    assert frames[-1].rotations.shape[0] == 21
    assert frames[-1].observed.all()


def test_other_lengths_of_bones_are_another_skeleton(walk: RigMotion) -> None:
    """A second later at the latest; a recording ends then and keeps what it has."""
    one = performer("json")
    packets = list(samples("json", by_json(walk)))
    frames = [frame for each in packets[:10] for frame in one.take(each, each.skeletons[0])]
    assert one.agreed is not None
    recording = a_recording(one)
    for frame in frames:
        recording.take(frame)

    def longer(pose: Pose) -> Pose:
        x, y, z = pose.position_m or (0.0, 0.0, 0.0)
        return pose if pose.tracker != "LeftFoot" else replace(pose, position_m=(x, y - 0.05, z))

    changed = [
        replace(each, arrival_s=each.arrival_s + 1.1, poses=tuple(map(longer, each.poses)))
        for each in packets[10:]
    ]
    frames = [frame for each in changed for frame in one.take(each, each.skeletons[0])]
    foot = walk.rig.index("LeftFoot")
    grown = frames[-1].skeleton.rig.offsets_m[foot] - walk.rig.offsets_m[foot]
    np.testing.assert_allclose(grown, (0.0, -0.05, 0.0), atol=1e-12)
    for frame in frames:
        recording.take(frame)
    assert (recording.state, recording.frames) == ("changed", 10)


def a_recording(one: Performer, *, limit_s: float = 10.0, max_frames: int = 1000) -> Recording:
    """Return a recording that has just begun."""
    assert one.agreed is not None
    at = datetime(2026, 1, 1, tzinfo=UTC)
    return Recording("r", one.name, one.agreed.rig, "account:a", at, limit_s, max_frames)


def test_a_recording_ends_when_it_is_full(walk: RigMotion) -> None:
    """By time or by its frames; memory is bounded."""
    one = performer("json")
    packets = list(samples("json", by_json(walk)))
    frames = [frame for each in packets for frame in one.take(each, each.skeletons[0])]
    for limits, kept in (({"limit_s": 0.0401}, 11), ({"max_frames": 7}, 7)):
        recording = a_recording(one, **limits)
        for frame in frames:
            recording.take(frame)
        assert (recording.state, recording.frames) == ("full", kept)
        assert len(recording.recorded().times_s) == kept


def test_a_recording_is_at_the_source_s_rate_and_names_its_gaps(walk: RigMotion) -> None:
    """The source's clock counts, not when packets arrived; frames between others are in between."""
    one = performer("json")
    packets = [each for at, each in enumerate(samples("json", by_json(walk))) if not 10 <= at < 20]
    frames = [frame for each in packets for frame in one.take(each, each.skeletons[0])]
    recording = a_recording(one)
    for frame in frames:
        # Arrivals are 4 ms apart and the source says 8.3 ms: here they agree.
        recording.take(replace(frame, mapped_s=50.0 + (frame.source_s or 0.0)))
    motion, gaps = at_constant_rate(recording.recorded())
    assert motion.rate_hz == walk.rate_hz == 120.0
    assert motion.frame_count == walk.frame_count
    ((start, end),) = [(one.from_s, one.to_s) for one in gaps]
    assert (start, end) == pytest.approx((9 / 120, 20 / 120))
    kept = [*range(10), *range(20, 30)]
    np.testing.assert_allclose(motion.rotations[kept], walk.rotations[kept], atol=1e-6)
    np.testing.assert_allclose(
        motion.root_positions_m[kept], walk.root_positions_m[kept], atol=1e-5
    )
    assert motion.observed[:9].all()
    assert not motion.observed[11:19].any()


def test_a_clock_that_does_not_count_seconds_is_not_used(walk: RigMotion) -> None:
    """A script that sends milliseconds: the arrival counts."""
    one = performer("json")
    said = [json.loads(each) for each in by_json(walk)]
    fast = (json.dumps({**each, "time_s": 1000.0 * each["time_s"]}).encode() for each in said)
    packets = list(samples("json", fast))
    frames = [frame for each in packets for frame in one.take(each, each.skeletons[0])]
    recording = a_recording(one)
    for frame in frames:
        recording.take(replace(frame, mapped_s=frame.arrival_s))
    motion, _ = at_constant_rate(recording.recorded())
    assert motion.rate_hz == 250.0


def test_a_skeleton_of_unknown_names_is_not_called_ready() -> None:
    """If nothing but the hips is known by name, no body is moved, and the bones are named."""
    _, problems = _proposed(("pelvis", "blob"), (-1, 0))
    assert len(problems) == 1
    assert "(pelvis, blob) only the hips are known" in problems[0]
    assert _proposed(("pelvis", "head"), (-1, 0))[1] == ()
