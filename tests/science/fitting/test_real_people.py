"""Tests that skeletons fitted to captured people have human lengths and walk as people do."""

from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures import Reading
from app.adapters.captures.reader import read_capture
from app.science.fitting import FitError, Fitted, fit_skeleton
from app.science.rig import BodyMotion, MarkerMotion, RigMotion
from app.science.rotations import FloatArray, geodesic_angle, rotate

_WALKS = ("cmu_c3d/02_01.c3d", "c3d/Gait.c3d", "trc/walk.trc")


def _fitted(shared_data: Path, path: str) -> Fitted:
    file = shared_data / "motion" / path
    motion = read_capture(file.read_bytes(), name=file.name).motion
    assert isinstance(motion, MarkerMotion | BodyMotion)
    return fit_skeleton(motion)


def _place(motion: RigMotion, name: str) -> FloatArray:
    places: FloatArray = motion.world()[0][:, motion.rig.index(name)]
    return places


def _bone(motion: RigMotion, name: str) -> float:
    return float(np.linalg.norm(motion.rig.offsets_m[motion.rig.index(name)]))


def _heading(motion: RigMotion) -> tuple[FloatArray, FloatArray]:
    """Return horizontal unit vectors ahead and to the right of a walk."""
    hips = motion.root_positions_m
    forward = (hips[-1] - hips[0]) * (1.0, 0.0, 1.0)
    forward = forward / np.linalg.norm(forward)
    return forward, np.cross(forward, (0.0, 1.0, 0.0))


@pytest.mark.parametrize("path", _WALKS)
def test_walkers_have_the_legs_of_people(shared_data: Path, path: str) -> None:
    """Thighs and shanks are 35 to 48 cm long and differ by up to 6 cm, between sides up to 2 cm."""
    motion = _fitted(shared_data, path).motion
    for bone in ("LowerLeg", "Foot"):  # named after the joint below: thigh, then shank
        left, right = _bone(motion, f"Left{bone}"), _bone(motion, f"Right{bone}")
        assert abs(left - right) < 0.02
        assert 0.35 < left < 0.48
    assert abs(_bone(motion, "LeftLowerLeg") - _bone(motion, "LeftFoot")) < 0.06
    assert 0.15 < 2.0 * _bone(motion, "LeftUpperLeg") < 0.22  # between the hip joints


@pytest.mark.parametrize("path", _WALKS)
def test_bones_of_constant_length_follow_the_measured_joints(shared_data: Path, path: str) -> None:
    """Bones of constant length miss the measured joint centres by less than a centimetre rms."""
    assert _fitted(shared_data, path).residual_m < 0.01


@pytest.mark.parametrize("path", _WALKS)
def test_walkers_keep_left_and_right_and_take_turns(shared_data: Path, path: str) -> None:
    """Passing feet are 5 cm apart or more, the right one to the right, and they alternate."""
    motion = _fitted(shared_data, path).motion
    forward, right = _heading(motion)
    step = _place(motion, "RightFoot") - _place(motion, "LeftFoot")
    passing = np.abs(step @ forward) < 0.1
    assert passing.any()
    assert float((step @ right)[passing].min()) > 0.05
    assert 1 <= int((np.diff(np.sign(step @ forward)) != 0).sum()) <= 6
    assert float(np.abs(step @ forward).max()) < 1.0


@pytest.mark.parametrize("path", _WALKS)
def test_walkers_face_where_they_go_and_bend_their_knees_backwards(
    shared_data: Path, path: str
) -> None:
    """Walkers' hips are across the walk to 25 degrees; knees bend one way only, by 40 to 80.

    Up to 12 degrees of overextension are accepted, since some markers make a straight knee look so.
    """
    motion = _fitted(shared_data, path).motion
    _, right = _heading(motion)
    hips = _place(motion, "RightUpperLeg") - _place(motion, "LeftUpperLeg")
    straight = (hips @ right) / np.linalg.norm(hips, axis=-1)
    assert float(straight.min()) > np.cos(np.radians(25.0))
    for side in ("Left", "Right"):
        knee = motion.rotations[:, motion.rig.index(f"{side}LowerLeg")]
        flexion = np.degrees(-2.0 * np.arctan2(knee[:, 1], knee[:, 0]))
        flexion = (flexion + 180.0) % 360.0 - 180.0
        assert float(flexion.min()) > -12.0
        assert 40.0 < float(flexion.max()) < 80.0


def test_stride_of_the_cmu_walk_is_a_persons(shared_data: Path) -> None:
    """In the CMU walk, the same foot strikes every 0.8 to 1.3 s, at a speed of 1 to 1.5 m/s."""
    motion = _fitted(shared_data, "cmu_c3d/02_01.c3d").motion
    forward, _ = _heading(motion)
    times: list[float] = []
    for side in ("Left", "Right"):
        ahead = (_place(motion, f"{side}Foot") - motion.root_positions_m) @ forward
        inner = ahead[1:-1]
        peaks = np.flatnonzero((inner > ahead[:-2]) & (inner >= ahead[2:]) & (inner > 0.2)) + 1
        times += [float(t) for t in np.diff(peaks) / motion.rate_hz]
    assert times
    assert all(0.8 < stride < 1.3 for stride in times)
    travel = float(np.linalg.norm(motion.root_positions_m[-1] - motion.root_positions_m[0]))
    assert 1.0 < travel / motion.duration_s < 1.5


def _solved_by_the_cmu(shared_data: Path) -> RigMotion:
    """Return the movement of the same trial as solved by the CMU, from its ASF and AMC files."""
    folder = shared_data / "motion" / "cmu_asfamc"
    motion = read_capture(
        (folder / "02_01.amc").read_bytes(),
        name="02_01.amc",
        reading=Reading(companions={"02.asf": (folder / "02.asf").read_bytes()}),
    ).motion
    assert isinstance(motion, RigMotion)
    return motion


def test_the_cmu_fit_agrees_with_the_cmus_own_skeleton(shared_data: Path) -> None:
    """Joints fitted to the C3D lie within 4 cm rms of those that the CMU solved (AMC)."""
    theirs = _solved_by_the_cmu(shared_data)
    ours = _fitted(shared_data, "cmu_c3d/02_01.c3d").motion
    pairs = {"LowerLeg": "tibia", "Foot": "foot", "UpperLeg": "femur"}
    pairs |= {"UpperArm": "humerus", "LowerArm": "radius"}
    for joint, bone in pairs.items():
        for side, letter in (("Left", "l"), ("Right", "r")):
            # The C3D's x, y, z are the AMC's z, x, y, and ours x, z, -y.
            place = _place(ours, f"{side}{joint}")
            seen = np.stack((-place[:, 2], place[:, 1], place[:, 0]), axis=-1)
            apart = seen - _place(theirs, f"{letter}{bone}")
            assert float(np.sqrt(np.mean(np.sum(apart**2, axis=-1)))) < 0.04, f"{side}{joint}"


def test_the_cmu_fit_faces_where_the_cmus_own_skeleton_faces(shared_data: Path) -> None:
    """Hips, chest and head turn about the vertical as in the AMC, to 0.2 degrees on average."""
    theirs = _solved_by_the_cmu(shared_data)
    ours = _fitted(shared_data, "cmu_c3d/02_01.c3d").motion
    for joint, bone in (("Hips", "root"), ("UpperChest", "thorax"), ("Head", "head")):
        # Ours faces -z at rest and theirs +z; our -z and x axes are their x and z.
        mine = rotate(ours.world()[1][:, ours.rig.index(joint)], np.array((0.0, 0.0, -1.0)))
        its = rotate(theirs.world()[1][:, theirs.rig.index(bone)], np.array((0.0, 0.0, 1.0)))
        apart = np.arctan2(-mine[:, 2], mine[:, 0]) - np.arctan2(its[:, 0], its[:, 2])
        apart = np.degrees((apart + np.pi) % (2.0 * np.pi) - np.pi)
        assert abs(float(apart.mean())) < 0.2, joint
        assert float(apart.std()) < 0.5, joint


@pytest.mark.parametrize("path", ["c3d/Gait.c3d", "trc/walk.trc"])
def test_outer_markers_alone_give_nearly_the_same_legs(shared_data: Path, path: str) -> None:
    """Outer knee and ankle markers alone move these joints by less than 2 cm rms."""
    file = shared_data / "motion" / path
    both = read_capture(file.read_bytes(), name=file.name).motion
    assert isinstance(both, MarkerMotion)
    inner = {f"{s}.{joint}.Medial" for s in "LR" for joint in ("Knee", "Ankle")}
    assert inner <= set(both.names)
    remaining = [column for column, name in enumerate(both.names) if name not in inner]
    outer = MarkerMotion(
        tuple(both.names[column] for column in remaining),
        both.rate_hz,
        both.positions_m[:, remaining],
    )
    ours, theirs = fit_skeleton(outer).motion, fit_skeleton(both).motion
    for side in ("Left", "Right"):
        for joint in ("LowerLeg", "Foot"):
            apart = _place(ours, f"{side}{joint}") - _place(theirs, f"{side}{joint}")
            assert float(np.sqrt(np.mean(np.sum(apart**2, axis=-1)))) < 0.02


def test_the_unfitted_joints_of_each_file_are_named(shared_data: Path) -> None:
    """Chest (CMU), chest and head (Gait) and all but the legs (walk.trc) are unfitted."""
    assert _fitted(shared_data, "cmu_c3d/02_01.c3d").unfitted == ("Chest",)
    assert _fitted(shared_data, "c3d/Gait.c3d").unfitted == ("Chest", "Head")
    legs = _fitted(shared_data, "trc/walk.trc")
    assert {n for n in legs.motion.rig.names if n != "Hips"} == {
        f"{side}{joint}"
        for side in ("Left", "Right")
        for joint in ("UpperLeg", "LowerLeg", "Foot", "Toes")
    }


def test_gait_is_trimmed_to_where_the_person_is_seen(shared_data: Path) -> None:
    """Of the Gait file's 4.87 s, only the 1.86 s in which the cameras see the person are kept."""
    fitted = _fitted(shared_data, "c3d/Gait.c3d")
    assert (fitted.first_frame, fitted.motion.frame_count) == (137, 186)
    assert any("1.86 s from 1.37 s on" in note for note in fitted.notes)


def test_clusters_on_one_leg_are_rejected(shared_data: Path) -> None:
    """The OptiTrack walk, which marks only one leg, is rejected."""
    with pytest.raises(FitError, match="the pelvis needs LASI"):
        _fitted(shared_data, "c3d/walkingOptiTrack.c3d")


def test_vicon_bodies_agree_with_their_authors_bvh(shared_data: Path) -> None:
    """Hip, collar and shoulders lie within 1.2 cm rms of the authors' BVH, forearms within 1 cm.

    The BVH declares its root's rotations as ZYX but stores them as ZXY (read as declared, a turn of
    the person about the vertical becomes a bow), and lags by 5 frames, which is their smoothing.
    """
    file = shared_data / "motion" / "vicon_tracker" / "HumanRobotHandover_0.bvh"
    declared, stored = b"Zposition Zrotation Yrotation X", b"Zposition Zrotation Xrotation Y"
    text = file.read_bytes()
    assert declared in text
    theirs = read_capture(
        text.replace(declared, stored), name=file.name, reading=Reading(metres_per_unit=0.001)
    ).motion
    assert isinstance(theirs, RigMotion)
    ours = _fitted(shared_data, "vicon_tracker/HumanRobotHandover_0.csv").motion
    lag = 5
    joints = {"Hips": "hip", "Neck": "neck"}
    joints |= {"LeftUpperArm": "left_upper_arm", "RightUpperArm": "right_upper_arm"}
    for mine, its in joints.items():
        apart = _place(ours, mine)[:-lag] - _place(theirs, its)[lag : ours.frame_count]
        assert float(np.sqrt(np.mean(np.sum(apart**2, axis=-1)))) < 0.012, mine
    bones = {"Neck": "neck", "LeftLowerArm": "left_forearm", "RightLowerArm": "right_forearm"}
    bones |= {"LeftHand": "left_hand", "RightHand": "right_hand"}
    for mine, its in bones.items():
        assert _bone(ours, mine) == pytest.approx(_bone(theirs, its), abs=0.01), mine


def test_vicon_hands_go_where_the_tracker_saw_them(shared_data: Path) -> None:
    """Hands of fitted arms stay within 3 cm rms of their rigid bodies; legs are unfitted."""
    file = shared_data / "motion" / "vicon_tracker" / "HumanRobotHandover_0.csv"
    bodies = read_capture(file.read_bytes(), name=file.name).motion
    assert isinstance(bodies, BodyMotion)
    fitted = fit_skeleton(bodies)
    motion, first = fitted.motion, fitted.first_frame
    for side in ("left", "right"):
        column = next(i for i, name in enumerate(bodies.names) if name == f"{side}_hand")
        seen = bodies.positions_m[first : first + motion.frame_count, column]
        apart = _place(motion, f"{side.title()}Hand") - seen
        assert float(np.sqrt(np.nanmean(np.sum(apart**2, axis=-1)))) < 0.03
    legs = {f"{s}{j}" for s in ("Left", "Right") for j in ("UpperLeg", "LowerLeg", "Foot", "Toes")}
    assert legs <= set(fitted.unfitted)
    assert any("right_hand turns by more than 90 degrees" in note for note in fitted.notes)


def test_straight_elbows_do_not_spin(shared_data: Path) -> None:
    """A nearly straight arm turns by less than 12 degrees per frame."""
    motion = _fitted(shared_data, "c3d/Gait.c3d").motion
    for side in ("Left", "Right"):
        arm = motion.rotations[:, motion.rig.index(f"{side}UpperArm")]
        assert float(np.degrees(geodesic_angle(arm[1:], arm[:-1])).max()) < 12.0
