"""Tests of where a retargeted avatar stands and travels, also without parts of the body."""

import numpy as np
import numpy.typing as npt
import pytest

from app.science.retargeting.transfer import Retargeter
from app.science.rig import Rig, RigError, RigMotion
from app.science.rotations import FloatArray, identity, rotate
from tests.science.retargeting.bodies import SAME, own_body, random_movement

FEET = ("LeftFoot", "LeftToes", "RightFoot", "RightToes")


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(6)


def test_the_lower_foot_stands_on_the_ground_at_the_start(rng: np.random.Generator) -> None:
    """At the start the lower foot is on the ground within a millimetre.

    This holds wherever the capture's own floor was.
    """
    motion = random_movement(own_body(1.7), rng)
    for stature_m in (1.3, 1.65, 1.9):
        avatar = own_body(stature_m)
        result = Retargeter(motion.rig, SAME, avatar, SAME).batch(motion)
        places, world = result.world()
        toes = [(joint, end) for joint, end in avatar.ends if "Toes" in avatar.names[joint]]
        tips = [places[0, j] + rotate(world[0, j], np.array(end)) for j, end in toes]
        lowest = min(*(p[1] for p in tips), *(places[0, avatar.index(n), 1] for n in FEET))
        assert abs(float(lowest)) < 1e-3


class _Slope:
    """Ground that rises by a tenth along x."""

    def height_m(self, x_m: npt.ArrayLike, z_m: npt.ArrayLike) -> FloatArray:
        """Return the height of the slope."""
        return 0.1 * np.asarray(x_m) + 0.0 * np.asarray(z_m)


def test_the_hips_follow_the_ground_below_them(rng: np.random.Generator) -> None:
    """The avatar is raised by the height of the ground below its hips."""
    motion = random_movement(own_body(1.7), rng)
    retargeter = Retargeter(motion.rig, SAME, own_body(1.9), SAME)
    flat, sloped = retargeter.batch(motion), retargeter.batch(motion, _Slope())
    rise = (sloped.root_positions_m - flat.root_positions_m)[:, 1]
    walked = flat.root_positions_m[:, 0] - flat.root_positions_m[0, 0]
    np.testing.assert_allclose(rise - rise[0], 0.1 * walked, atol=1e-12)
    offset = retargeter.hips_offset_m(motion.root_positions_m[0], motion.rotations[0], _Slope())
    root, _ = retargeter.frame(motion.root_positions_m[0], motion.rotations[0], offset)
    np.testing.assert_allclose(root, sloped.root_positions_m[0], atol=1e-12)


def test_the_frame_that_stands_on_the_ground_can_be_chosen(rng: np.random.Generator) -> None:
    """For captures that begin in the air, the frame that stands on the ground can be chosen."""
    motion = random_movement(own_body(1.7), rng)
    avatar = own_body(1.5)
    result = Retargeter(motion.rig, SAME, avatar, SAME).batch(motion, standing_frame=-1)
    lowest = result.world()[0][-1, [avatar.index(name) for name in FEET], 1].min()
    assert -1e-12 <= float(lowest) < 0.2
    with pytest.raises(RigError, match="frames 0 to 59"):
        Retargeter(motion.rig, SAME, avatar, SAME).batch(motion, standing_frame=60)


def test_hips_below_a_root_are_where_they_should_be(rng: np.random.Generator) -> None:
    """A root above the hips in the tree is moved so that the hips travel correctly."""
    body = own_body(1.7)
    offsets = np.concatenate((np.zeros((1, 3)), body.offsets_m))
    ends = tuple((joint + 1, end) for joint, end in body.ends)
    rooted = Rig(
        ("root", *body.names), (-1, *(p + 1 for p in body.parents)), offsets, identity(23), ends
    )
    motion = random_movement(body, rng)
    plain = Retargeter(body, SAME, body, SAME).batch(motion)
    there = Retargeter(body, SAME, rooted, SAME)
    result = there.batch(motion)
    np.testing.assert_allclose(result.world()[0][:, 1:], plain.world()[0], atol=1e-12)
    np.testing.assert_allclose(
        there.hips_m(result.root_positions_m, result.rotations), plain.root_positions_m, atol=1e-12
    )
    back = Retargeter(rooted, SAME, body, SAME).batch(result)
    np.testing.assert_allclose(back.root_positions_m, plain.root_positions_m, atol=1e-12)


def test_an_upper_body_stands_on_the_avatars_legs(rng: np.random.Generator) -> None:
    """A capture without legs scales by the trunk and stands on the avatar's straight legs."""
    body = own_body(1.7)
    remaining = [
        at for at, name in enumerate(body.names) if not name.endswith(("Leg", "Foot", "Toes"))
    ]
    upper = Rig(
        tuple(body.names[at] for at in remaining),
        tuple(-1 if at == 0 else remaining.index(body.parents[at]) for at in remaining),
        body.offsets_m[remaining],
        identity(len(remaining)),
    )
    upper_map = {name: name for name in upper.names}
    retargeter = Retargeter(upper, upper_map, own_body(1.87), SAME)
    assert (retargeter.scaled_by, retargeter.leg_ratio) == ("trunk", None)
    assert retargeter.scale == pytest.approx(1.1)
    still = RigMotion(
        upper,
        100.0,
        np.zeros((3, 3)),
        identity(3, len(remaining)),
        np.ones((3, len(remaining)), dtype=bool),
    )
    standing = retargeter.batch(still).root_positions_m[0, 1]
    assert standing == pytest.approx(1.87 * (0.545 - 0.014), abs=1e-9)
    assert set(retargeter.unmapped_avatar_joints) == set(SAME) - set(upper.names)
