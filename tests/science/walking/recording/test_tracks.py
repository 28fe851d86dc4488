"""Tests of floor tracks from captures of skeletons, belt trackers and markers."""

from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures.capture import Reading
from app.adapters.captures.reader import read_capture
from app.science.rig import BodyMotion, MarkerMotion, Rig, RigMotion
from app.science.rotations import from_rotation_vector, identity
from app.science.skeleton import JOINT_INDEX
from app.science.walking.recording.capture_tracks import TrackingOptions, track_of_motion
from app.science.walking.recording.centre_of_mass import centre_of_mass
from app.science.walking.recording.segmentation import walks_of
from app.science.walking.recording.tracks import Walker, bridged, track_of_belt, track_of_rig
from app.science.walking.records.model import WalkingError
from tests.science.retargeting.bodies import SAME, own_body

WALKER = Walker("7", "made", 1.75, "synthetic")


def _standing(frames: int = 3) -> RigMotion:
    rig = own_body(1.75)
    roots = np.tile(rig.offsets_m[0], (frames, 1))
    roots[:, 2] -= np.arange(frames) * 0.1
    rotations = np.tile(identity(rig.joint_count), (frames, 1, 1))
    return RigMotion(rig, 100.0, roots, rotations, np.ones((frames, rig.joint_count), dtype=bool))


def test_ahead_in_the_world_is_ahead_on_the_floor() -> None:
    """A body that moves along -z moves along the floor's y."""
    track = track_of_rig(_standing(), SAME, WALKER)
    assert np.diff(track.xy_m, axis=0) == pytest.approx(np.array([[0.0, 0.1]] * 2))
    assert track.times_s == pytest.approx([0.0, 0.01, 0.02])


def test_the_centre_of_mass_of_a_t_pose_is_where_people_have_it() -> None:
    """The T-pose's centre of mass is in the middle, at .55 to .60 of the stature.

    Arms held out raise it a little.
    """
    centre = centre_of_mass(_standing(), SAME)[0]
    assert centre[0] == pytest.approx(0.0, abs=1e-9)
    assert 0.55 < centre[1] / 1.75 < 0.61


def test_a_leg_moves_the_centre_by_its_share() -> None:
    """Bending a hip moves the centre of mass forward by the share of the leg, a fifth."""
    motion = _standing(1)
    bent = motion.rotations.copy()
    bent[0, JOINT_INDEX["LeftUpperLeg"]] = from_rotation_vector(np.array([np.pi / 2, 0.0, 0.0]))
    raised = RigMotion(motion.rig, 100.0, motion.root_positions_m, bent, motion.observed)
    moved = centre_of_mass(raised, SAME)[0] - centre_of_mass(motion, SAME)[0]
    assert 0.04 < np.linalg.norm(moved) < 0.16


def test_without_legs_the_hips_are_followed() -> None:
    """Without legs the centre of mass raises an error, and the hips are followed instead."""
    without = {joint: name for joint, name in SAME.items() if "Leg" not in joint}
    with pytest.raises(WalkingError, match=r"LeftUpperLeg.*hips"):
        centre_of_mass(_standing(), without)
    track = track_of_motion(_standing(), WALKER, TrackingOptions(joint_map=without))
    hips = own_body(1.75).offsets_m[0]
    assert track.xy_m[0] == pytest.approx([hips[0], -hips[2]])


def test_a_belt_tracker_reaches_into_the_body_along_its_z() -> None:
    """A belt tracker's position is moved into the torso along its z axis, at any facing."""
    quarter = from_rotation_vector(np.array([0.0, np.pi / 2, 0.0]))
    motion = BodyMotion(
        ("head", "belt"),
        np.array([0.0, 0.1]),
        np.zeros((2, 2, 3)),
        np.stack([np.stack([identity(1)[0], identity(1)[0]]), np.stack([quarter, quarter])]),
    )
    track = track_of_belt(motion, "belt", WALKER, torso_depth_m=0.2, off_skin_m=0.03)
    assert track.xy_m == pytest.approx(np.array([[0.0, -0.13], [0.13, 0.0]]), abs=1e-12)
    with pytest.raises(WalkingError, match="head, belt"):
        track_of_motion(motion, WALKER)
    with pytest.raises(WalkingError, match="waist"):
        track_of_belt(motion, "waist", WALKER)


def test_markers_are_followed_by_their_middle() -> None:
    """Markers of the pelvis are found by name, and their mean position is followed."""
    names = ("RPSI", "LASI", "RASI", "LPSI", "HEAD")
    places = np.zeros((2, 5, 3))
    places[:, :4] = [[0.1, 1.0, 0.1], [-0.1, 1.0, -0.1], [0.1, 1.0, -0.1], [-0.1, 1.0, 0.1]]
    places[1, :, 2] -= 0.5
    track = track_of_motion(MarkerMotion(names, 100.0, places), WALKER)
    assert track.xy_m == pytest.approx(np.array([[0.0, 0.0], [0.0, 0.5]]))
    with pytest.raises(WalkingError, match="No pelvis"):
        track_of_motion(MarkerMotion(names[4:], 100.0, places[:, 4:]), WALKER)


def test_short_gaps_are_bridged_and_long_ones_rejected() -> None:
    """Gaps of a tenth of a second are filled linearly; a gap of a second is rejected."""
    times_s = np.arange(200) / 100.0
    places = np.stack([times_s, np.zeros(200)], axis=-1)
    places[:3] = places[50:55] = np.nan
    filled_s, filled = bridged(times_s, places, "A track")
    assert len(filled) == 197
    assert filled_s[0] == 0.0
    assert filled[:, 0] == pytest.approx(times_s[3:])
    places[60:160] = np.nan
    with pytest.raises(WalkingError, match=r"1\.01 s from 0\.59 s"):
        bridged(times_s, places, "A track")
    with pytest.raises(WalkingError, match=r"0 position\(s\)"):
        bridged(times_s, np.full((200, 2), np.nan), "A track")


def test_a_real_walk_is_as_long_as_its_root_says(shared_data: Path) -> None:
    """The centre of mass of CMU 06_01 travels 4.27 m, as its root does.

    The recording cuts the walk at both ends.
    """
    path = shared_data / "motion" / "cmu_bvh" / "06_01.bvh"
    capture = read_capture(
        path.read_bytes(), name=path.name, reading=Reading(metres_per_unit=0.056444)
    )
    assert isinstance(capture.motion, RigMotion)
    track = track_of_motion(_without_t_pose(capture.motion), Walker("6", path.name))
    (walk,) = walks_of(track)
    assert np.linalg.norm(walk.xy_m[-1] - walk.xy_m[0]) == pytest.approx(4.2, abs=0.25)
    assert not (walk.begins_still and walk.ends_still)
    assert 0.6 < walk.length_m / walk.duration_s < 1.6


def _without_t_pose(motion: RigMotion) -> RigMotion:
    """Return the motion without its first frame, a T-pose that the converter added."""
    rig: Rig = motion.rig
    return RigMotion(
        rig,
        motion.rate_hz,
        motion.root_positions_m[1:],
        motion.rotations[1:],
        motion.observed[1:],
    )
