"""The legs of any rig: their joints, their lengths, and the positions of their feet.

A foot is tracked by its *ball*: the toe joint, which is the paper's "main toe joint" and the point
that rests longest on the ground, from the flat foot to toe-off. For a rig without toe joints the
free end of the foot is used. Without one, or where exporters put it on the ankle itself, the ball
is where the proportions of the product's body put it for legs of this length, on a foot that is
flat at rest: the ankle itself swings up to twice as high as a ball, and steps measured at one and
the other could not be compared.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.science.retargeting.axes import CANONICAL
from app.science.retargeting.bones import joints_of, rest_facing
from app.science.retargeting.joint_chains import is_below
from app.science.retargeting.joint_map import JointMap
from app.science.rig import Rig, RigError
from app.science.rotations import FloatArray, conjugate, rotate
from app.science.skeleton import JOINT_INDEX, build_skeleton

Side = Literal["left", "right"]
SIDES: tuple[Side, Side] = ("left", "right")
Place = tuple[float, float, float]
_HERE: Place = (0.0, 0.0, 0.0)
_PARTS = ("UpperLeg", "LowerLeg", "Foot")
# A toe or an end nearer to the ankle, in leg lengths (2 cm for an adult), is no ball of a foot.
_SHORTEST_FOOT = 0.025


@dataclass(frozen=True)
class Leg:
    """Joints of one leg as indices of the rig.

    Attributes:
        side: left or right.
        thigh, shin, foot: the joints at hip, knee and ankle.
        ball: the joint to which the ball is attached.
        ball_in_joint_m: position of the ball in that joint's frame; zero for a toe joint.
        length_m: thigh plus shin.
        thigh_share: thigh over thigh plus shin.
        sole: (joint, position in its frame) of every point that may touch the ground: ankle, toes
            and free ends below.
    """

    side: Side
    thigh: int
    shin: int
    foot: int
    ball: int
    ball_in_joint_m: Place
    length_m: float
    thigh_share: float
    sole: tuple[tuple[int, Place], ...]

    def ball_m(self, positions_m: FloatArray, world: FloatArray) -> FloatArray:
        """Return the positions of the ball, (N, 3).

        The arguments are positions (N, J, 3) and world_from_joint (N, J, 4) of all joints.
        """
        return _point(positions_m, world, self.ball, self.ball_in_joint_m)

    def lowest_m(self, positions_m: FloatArray, world: FloatArray) -> FloatArray:
        """Return the height of the foot's lowest point, (N,)."""
        heights = [_point(positions_m, world, joint, at)[..., 1] for joint, at in self.sole]
        return np.asarray(np.min(heights, axis=0))


@dataclass(frozen=True)
class Legs:
    """Both legs of a rig, and the hips between them."""

    left: Leg
    right: Leg
    hips: int

    @property
    def both(self) -> tuple[Leg, Leg]:
        """The left leg, then the right one."""
        return self.left, self.right

    def balls_m(self, positions_m: FloatArray, world: FloatArray) -> FloatArray:
        """Return the positions of both balls, (2, N, 3).

        The arguments are positions (N, J, 3) and world_from_joint (N, J, 4) of all joints.
        """
        return np.stack([leg.ball_m(positions_m, world) for leg in self.both])

    @property
    def length_m(self) -> float:
        """Thigh plus shin, the mean of both legs."""
        return (self.left.length_m + self.right.length_m) / 2.0


def has_legs(joint_map: JointMap) -> bool:
    """Return whether both legs are mapped from the hips to the ankles."""
    sides = ("Left", "Right")
    return all(f"{s}{p}" in joint_map for s in sides for p in _PARTS) and "Hips" in joint_map


def legs_of(rig: Rig, joint_map: JointMap) -> Legs:
    """Return the legs of a rig.

    Raises:
        RigError: a joint of a leg or the hips is not mapped, or a leg has no length.
    """
    if not has_legs(joint_map):
        required = ["Hips", *(f"{s}{p}" for s in ("Left", "Right") for p in _PARTS)]
        missing = ", ".join(name for name in required if name not in joint_map)
        raise RigError(
            f"The joint map has no {missing}: walking can be measured only if both legs are"
            " mapped. Map them, or use a capture of the whole body."
        )
    positions, _ = rig.rest_world()
    left, right = (_leg(rig, joint_map, side, positions) for side in SIDES)
    return Legs(left, right, rig.index(joint_map["Hips"]))


def _leg(rig: Rig, joint_map: JointMap, side: Side, rest_m: FloatArray) -> Leg:
    prefix = side.capitalize()
    thigh, shin, foot = (rig.index(joint_map[f"{prefix}{part}"]) for part in _PARTS)
    upper = float(np.linalg.norm(rest_m[shin] - rest_m[thigh]))
    lower = float(np.linalg.norm(rest_m[foot] - rest_m[shin]))
    if upper < 1e-6 or lower < 1e-6:
        raise RigError(f"The {side} leg has a bone without length: check its joints in the map.")
    found = _own_ball(rig, joint_map, prefix, rest_m, upper + lower)
    ball, within = found or (foot, _usual_ball(rig, joint_map, foot, upper + lower))
    below = [joint for joint in range(rig.joint_count) if is_below(rig, joint, foot)]
    sole = [(joint, _HERE) for joint in sorted({foot, *below})]
    sole += [(joint, end) for joint, end in rig.ends if joint in {foot, *below}]
    if found is None:
        sole.append((foot, within))
    share = upper / (upper + lower)
    return Leg(side, thigh, shin, foot, ball, within, upper + lower, share, tuple(sole))


def has_ball(rig: Rig, joint_map: JointMap) -> bool:
    """Return whether both feet of a rig with legs have a toe joint or a free end off the ankle."""
    rest_m, _ = rig.rest_world()
    length_m = legs_of(rig, joint_map).length_m
    return all(
        _own_ball(rig, joint_map, side.capitalize(), rest_m, length_m) is not None for side in SIDES
    )


def _own_ball(
    rig: Rig, joint_map: JointMap, prefix: str, rest_m: FloatArray, leg_m: float
) -> tuple[int, Place] | None:
    """Return the joint of a foot's ball and the place in it; None if the foot has no extent."""
    foot, shortest_m = rig.index(joint_map[f"{prefix}Foot"]), _SHORTEST_FOOT * leg_m
    if f"{prefix}Toes" in joint_map:
        toes = rig.index(joint_map[f"{prefix}Toes"])
        if float(np.linalg.norm(rest_m[toes] - rest_m[foot])) >= shortest_m:
            return toes, _HERE
    for joint, end in rig.ends:
        if joint == foot and float(np.linalg.norm(end)) >= shortest_m:
            return foot, end
    return None


def _usual_ball(rig: Rig, joint_map: JointMap, foot: int, leg_m: float) -> Place:
    """Return where a flat foot of a person with such legs has its ball, in the foot's frame."""
    usual = build_skeleton(1.0)
    ball = usual.offsets_m[JOINT_INDEX["LeftToes"]] * (leg_m / usual.leg_length_m)
    ahead = rotate(rest_facing(rig, joints_of(rig, joint_map), CANONICAL), ball)
    x, y, z = rotate(conjugate(rig.rest_world()[1][foot]), ahead).tolist()
    return x, y, z


def _point(positions_m: FloatArray, world: FloatArray, joint: int, place_m: Place) -> FloatArray:
    place = positions_m[..., joint, :]
    if place_m == _HERE:
        return place
    return np.asarray(place + rotate(world[..., joint, :], np.array(place_m)))
