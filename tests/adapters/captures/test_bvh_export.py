"""Tests that other programs read the BVH files that we write correctly."""

import warnings
from pathlib import Path

import numpy as np
import pytest
from pymotion.io.bvh import BVH
from pymotion.ops.skeleton import fk

from app.adapters.captures import Reading, read_capture, to_bvh
from app.adapters.captures.bvh_export import safe_names
from app.science.rig import Rig, RigMotion
from app.science.rotations import FloatArray, from_euler, geodesic_angle
from tests.adapters.captures.moving_rigs import motive_body, random_motion, random_rig

_METRES = Reading(metres_per_unit=0.01)


def _by_pymotion(path: Path) -> dict[str, FloatArray]:
    """Return each joint's positions by upc-pymotion, in the file's unit and double precision."""
    file = BVH()
    file.load(str(path))
    turns, places, parents, offsets, _, _ = file.get_data()
    found, _ = fk(turns, places[:, 0, :], offsets, parents)
    return {str(name): found[:, joint] for joint, name in enumerate(file.data["names"])}


def _by_bvhio(path: Path, frames: int) -> dict[str, FloatArray]:
    """Return each joint's positions by bvhio, whose single precision is a few micrometres."""
    with warnings.catch_warnings():
        # It imports a deprecated module.
        warnings.simplefilter("ignore", PendingDeprecationWarning)
        import bvhio
    root = bvhio.readAsHierarchy(str(path))
    found: dict[str, list[FloatArray]] = {}
    for frame in range(frames):
        root.loadPose(frame)
        for joint, _, _ in root.layout():
            found.setdefault(joint.Name, []).append(np.array(joint.PositionWorld))
    return {name: np.array(places) for name, places in found.items()}


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_other_readers_see_the_same_positions(tmp_path: Path, seed: int) -> None:
    """Two other readers give the same positions of a rig with rest rotations, to a micrometre."""
    rng = np.random.default_rng(seed)
    rig = random_rig(rng, *motive_body(), rest=True, ends=True)
    motion = random_motion(rng, rig, frames=12)
    path = tmp_path / "out.bvh"
    path.write_text(to_bvh(motion))
    expected = dict(zip(rig.names, np.moveaxis(motion.world()[0], 1, 0), strict=True))
    double, single = _by_pymotion(path), _by_bvhio(path, 12)
    for name, places in expected.items():
        np.testing.assert_allclose(double[name] / 100.0, places, rtol=0.0, atol=1e-6)
        np.testing.assert_allclose(single[name] / 100.0, places, rtol=0.0, atol=3e-6)


def test_reading_it_back_gives_the_same_body() -> None:
    """Positions, free ends, rotations and the rest pose survive writing and reading."""
    rng = np.random.default_rng(4)
    rig = random_rig(rng, *motive_body(), rest=True, ends=True)
    motion = random_motion(rng, rig, frames=12)
    reread = read_capture(to_bvh(motion).encode(), name="written.bvh", reading=_METRES).motion
    assert isinstance(reread, RigMotion)
    order = [reread.rig.names.index(name) for name in rig.names]
    np.testing.assert_allclose(reread.world()[0][:, order], motion.world()[0], atol=1e-9)
    rest, _ = reread.rig.rest_world()
    expected, _ = rig.rest_world()
    np.testing.assert_allclose(rest[order], expected, atol=1e-9)
    before, after = (m.world()[1] for m in (motion, reread))
    turned = geodesic_angle(before[0], before[5])
    np.testing.assert_allclose(geodesic_angle(after[0], after[5])[order], turned, atol=1e-9)
    assert len(reread.rig.ends) == len(rig.ends)


@pytest.mark.parametrize("file", ["cmu_bvh/05_06.bvh", "bvh_toolbox/walk01.bvh"])
def test_a_capture_written_and_read_elsewhere_stays(
    shared_data: Path, tmp_path: Path, file: str
) -> None:
    """A real walk that we write and another program reads is unchanged."""
    path = shared_data / "motion" / file
    motion = read_capture(path.read_bytes(), name=path.name).motion
    assert isinstance(motion, RigMotion)
    written = tmp_path / "out.bvh"
    written.write_text(to_bvh(motion))
    found = _by_pymotion(written)
    for joint, name in enumerate(motion.rig.names):
        np.testing.assert_allclose(found[name] / 100.0, motion.world()[0][:, joint], atol=1e-6)


def test_a_gimbal_lock_changes_no_position(tmp_path: Path) -> None:
    """In a gimbal lock, with x at a right angle, all positions are still correct."""
    rig = Rig(
        ("Hip", "Arm", "Hand"),
        (-1, 0, 1),
        np.array(((0.0, 0.0, 0.0), (0.3, 0.1, 0.0), (0.2, 0.0, 0.4))),
        np.tile((1.0, 0.0, 0.0, 0.0), (3, 1)),
    )
    near = np.array((0.0, 1e-9, -1e-8, 1e-6, 1e-4))
    angles = np.stack((0.7 + 0 * near, np.pi / 2 - near, 0.4 + 0 * near), axis=-1)
    turns = np.repeat(from_euler("ZXY", angles)[:, np.newaxis], 3, axis=1)
    motion = RigMotion(rig, 60.0, np.zeros((5, 3)), turns, np.ones((5, 3), dtype=np.bool_))
    path = tmp_path / "locked.bvh"
    path.write_text(to_bvh(motion))
    found = _by_pymotion(path)
    for joint, name in enumerate(rig.names):
        np.testing.assert_allclose(found[name] / 100.0, motion.world()[0][:, joint], atol=1e-6)


def test_joint_names_are_written_as_unique_single_words() -> None:
    """Blanks and braces in joint names are replaced, and names stay unique."""
    assert safe_names(("a b", "a_b", "x{y}", "{}")) == ("a_b", "a_b_2", "x_y", "joint")
