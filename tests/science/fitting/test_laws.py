"""Tests that the fit recovers the bones and rotations of a synthetic person."""

import numpy as np
import pytest

from app.science.fitting import fit_skeleton
from app.science.rig import BodyMotion, MarkerMotion, RigMotion
from app.science.rotations import (
    FloatArray,
    from_rotation_vector,
    geodesic_angle,
    multiply,
    normalise,
    rotate,
)
from app.science.skeleton import JOINT_NAMES, PARENTS
from tests.science.fitting.synthetic_body import NAMES, bodies_on, markers_on, moving


@pytest.mark.parametrize("seed", range(8))
def test_markers_recover_lengths_and_rotations(seed: int) -> None:
    """Markers recover bones to 1e-9 m and rotations to 1e-6 rad if joints hinge as assumed."""
    truth = moving(seed)
    fitted = fit_skeleton(markers_on(truth))
    assert set(fitted.motion.rig.names) == set(NAMES)
    assert fitted.unfitted == ("Chest",)
    assert fitted.residual_m < 1e-9
    for name in NAMES:
        ours, theirs = fitted.motion.rig.index(name), truth.rig.index(name)
        np.testing.assert_allclose(
            fitted.motion.rig.offsets_m[ours], truth.rig.offsets_m[theirs], atol=1e-9
        )
        apart = geodesic_angle(fitted.motion.rotations[:, ours], truth.rotations[:, theirs])
        assert float(apart.max()) < 1e-6, name
    np.testing.assert_allclose(fitted.motion.root_positions_m, truth.root_positions_m, atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_a_turned_room_turns_the_hips_alone(seed: int) -> None:
    """Turning the room about the vertical and shifting it changes only the hips."""
    rng = np.random.default_rng(seed)
    markers = markers_on(moving(seed))
    turn = from_rotation_vector(np.array((0.0, rng.uniform(-3.0, 3.0), 0.0)))
    shift = np.array((rng.normal(), 0.0, rng.normal()))
    there = MarkerMotion(markers.names, markers.rate_hz, rotate(turn, markers.positions_m) + shift)
    here, moved = fit_skeleton(markers).motion, fit_skeleton(there).motion
    np.testing.assert_allclose(moved.rig.offsets_m, here.rig.offsets_m, atol=1e-9)
    assert float(geodesic_angle(moved.rotations[:, 1:], here.rotations[:, 1:]).max()) < 1e-6
    hips = multiply(turn, here.rotations[:, 0])
    assert float(geodesic_angle(moved.rotations[:, 0], hips).max()) < 1e-6


@pytest.mark.parametrize("scale", [0.6, 1.0, 1.1])
def test_marker_noise_of_a_millimetre_moves_joints_little(scale: float) -> None:
    """With 1 mm of marker noise joints stay within 5 mm rms of their centres."""
    rng = np.random.default_rng(3)
    markers = markers_on(moving(3))
    noisy = markers.positions_m * scale + rng.normal(0.0, 0.001, markers.positions_m.shape)
    fitted = fit_skeleton(MarkerMotion(markers.names, markers.rate_hz, noisy))
    assert fitted.residual_m < 0.005
    assert len(fitted.motion.rig.names) == len(NAMES)


def test_a_limb_that_is_not_marked_is_named() -> None:
    """Without the right wrist the right arm is listed as unfitted, and the rest is unchanged."""
    markers = markers_on(moving(1))
    remaining = [name for name in markers.names if name not in {"RWRA", "RWRB"}]
    columns = [markers.names.index(name) for name in remaining]
    fitted = fit_skeleton(
        MarkerMotion(tuple(remaining), markers.rate_hz, markers.positions_m[:, columns])
    )
    assert fitted.unfitted == (
        "Chest",
        "RightShoulder",
        "RightUpperArm",
        "RightLowerArm",
        "RightHand",
    )
    whole = fit_skeleton(markers).motion
    for name in fitted.motion.rig.names:
        ours, theirs = fitted.motion.rig.index(name), whole.rig.index(name)
        np.testing.assert_allclose(
            fitted.motion.rotations[:, ours], whole.rotations[:, theirs], atol=1e-9
        )


def test_another_laboratorys_labels_give_the_same_legs() -> None:
    """The legs are the same when markers are labelled as by OptiTrack and Qualisys."""
    ours = markers_on(moving(4))
    labels = {f"{s}FWT": f"Waist{s}Front" for s in "LR"} | {
        f"{s}BWT": f"Waist{s}Back" for s in "LR"
    }
    labels |= {f"{s}{a}": f"{s}{b}" for s in "LR" for a, b in _OPTITRACK.items()}
    places = [ours.positions_m[:, ours.names.index(name)] for name in labels]
    # Their sets have no marker on the second toe but one on either side of it.
    names = list(labels.values())
    for side in "LR":
        toe = ours.positions_m[:, ours.names.index(f"{side}TOE")]
        names += [f"{side}ToeIn", f"{side}ToeOut"]
        across = 0.03 * (1.0 if side == "L" else -1.0)
        right = _foot_right(moving(4), side) * across
        places += [toe + right, toe - right]
    named = tuple(f"Ann_{name}" for name in names)  # Motive prefixes the skeleton's name
    theirs = MarkerMotion(named, ours.rate_hz, np.stack(places, axis=1))
    here, there = fit_skeleton(ours).motion, fit_skeleton(theirs).motion
    for joint in ("Hips", "LeftUpperLeg", "RightUpperLeg", "LeftLowerLeg", "RightFoot"):
        a, b = here.rig.index(joint), there.rig.index(joint)
        np.testing.assert_allclose(here.rig.offsets_m[a], there.rig.offsets_m[b], atol=1e-9)
        apart = geodesic_angle(here.rotations[:, a], there.rotations[:, b])
        assert float(apart.max()) < 1e-6


_OPTITRACK = {"KNE": "KneeOut", "ANK": "AnkleOut", "HEE": "Heel"}


def _foot_right(motion: RigMotion, side: str) -> FloatArray:
    foot = motion.rig.index("LeftFoot" if side == "L" else "RightFoot")
    return rotate(motion.world()[1][:, foot], np.array((1.0, 0.0, 0.0)))


def test_the_rig_is_the_bodys() -> None:
    """Joints are named and ordered as in the product's body, each below its nearest ancestor."""
    rig = fit_skeleton(markers_on(moving(0))).motion.rig
    assert rig.names == tuple(name for name in JOINT_NAMES if name in rig.names)
    for joint, name in enumerate(rig.names[1:], 1):
        ancestors = set()
        above = PARENTS[JOINT_NAMES.index(name)]
        while above >= 0:
            ancestors.add(JOINT_NAMES[above])
            above = PARENTS[above]
        assert rig.names[rig.parents[joint]] in ancestors


def _upright(seed: int) -> RigMotion:
    """Return a person with a rigid trunk, as rigid bodies on hip and collar assume it."""
    truth = moving(seed)
    rotations = truth.rotations.copy()
    for name in ("Spine", "UpperChest", "LeftLowerArm", "RightLowerArm"):
        joint = truth.rig.index(name)
        rotations[:, joint] = _without_twist(rotations[:, joint]) if "Arm" in name else (1, 0, 0, 0)
    return RigMotion(truth.rig, truth.rate_hz, truth.root_positions_m, rotations, truth.observed)


def _without_twist(rotations: FloatArray) -> FloatArray:
    """Return only the rotation about y, since bodies on elbow and hand show no forearm twist."""
    hinge = rotations * np.array((1.0, 0.0, 1.0, 0.0))
    return normalise(hinge)


@pytest.mark.parametrize("seed", range(4))
def test_rigid_bodies_recover_positions_and_rotations(seed: int) -> None:
    """Rigid bodies recover joint positions and arm rotations, however they are attached."""
    truth = _upright(seed)
    fitted = fit_skeleton(bodies_on(truth, seed))
    ours, theirs = fitted.motion, truth
    placed, _ = ours.world()
    true_places, true_world = theirs.world()
    _, world = ours.world()
    for name in ("Hips", "LeftUpperArm", "RightUpperArm", "LeftLowerArm", "RightLowerArm"):
        mine, its = ours.rig.index(name), theirs.rig.index(name)
        np.testing.assert_allclose(placed[:, mine], true_places[:, its], atol=1e-6)
        assert float(geodesic_angle(world[:, mine], true_world[:, its]).max()) < 1e-6, name
    assert set(fitted.unfitted) >= {"LeftUpperLeg", "RightFoot", "UpperChest"}


def test_uneven_times_are_resampled() -> None:
    """Samples at uneven times are resampled to an even rate, missing ones interpolated."""
    bodies = bodies_on(moving(2), 2)
    remaining = np.delete(np.arange(len(bodies.times_s)), [100, 150])
    uneven = BodyMotion(
        bodies.names,
        bodies.times_s[remaining],
        bodies.positions_m[remaining],
        bodies.rotations[remaining],
    )
    fitted = fit_skeleton(uneven).motion
    assert fitted.frame_count == len(bodies.times_s)
    whole = fit_skeleton(bodies).motion
    np.testing.assert_allclose(
        np.delete(fitted.root_positions_m, [100, 150], axis=0),
        np.delete(whole.root_positions_m, [100, 150], axis=0),
        atol=1e-9,
    )
