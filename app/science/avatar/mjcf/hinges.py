"""Compute the inertia that each hinge moves, and the armature and damping added to the hinge.

Armature is inertia of the hinge itself: it resists only the turning of a part against its parent.
It keeps motors stable. A joint between two light neighbours that are free to give way moves only
`J`, a small part of the inertia `I` of the limb: a hundredth in the spine. Its damping `kd` is
chosen for the whole limb. Once such a motor has reached its torque limit, it would throw the joint
back and forth at every step, without end, if for a step of length h

    kd h > 2 J,

as each throw then demands the torque limit in the other direction. With an armature of .15 I the
joint of a critically damped motor, kd = 2 w I, stays clear of this up to w = .15 / h = 75 rad/s,
which is 12 Hz, even where J is zero. Turning a limb at the same rate takes 15 % more torque.

Locked axes become part of the body's fixed rotation, and the hinges around them are turned
accordingly (`with_locks`). A part's rotation is a product of rotations about its axes, R1 R2 R3. A
locked axis is a constant L in that product. As R(a, q) L = L R(L^-1 a, q), all constants can be
moved to the front, where they turn the whole body, if every axis that preceded one is rotated by
its inverse.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, sin, sqrt
from types import MappingProxyType

from app.science.avatar.body import AXES, AXES_OF, Axis, Body, BodyMasses, Inertial, combined
from app.science.rotations import IDENTITY, Quaternion, Vector, q_multiply, q_rotate, v_scale

ARMATURE_SHARE = 0.15
"""Armature of a hinge as a fraction of the inertia of its limb; see the module docstring."""
ARMATURE_KG_M2 = 1e-4
"""Armature added to that: without it, a fingertip of 2 g on a hand of 300 g would need a shorter
time step."""
DAMPING_PER_S = 1.0
"""Passive damping of a hinge, as a fraction of its inertia: an undriven limb comes to rest within
seconds. A relay experiment needs some damping to end in a limit cycle."""
_BENT: Mapping[str, Quaternion] = MappingProxyType(
    {
        axis.part: (sqrt(0.5), *v_scale(axis.direction, sqrt(0.5)))
        for axis in AXES
        if axis.movement == "bend" and axis.part.endswith(("LowerArm", "LowerLeg"))
    }
)


@dataclass(frozen=True)
class Hinge:
    """The inertia of one axis, and the armature and damping that follow from it.

    Attributes:
        limb_kg_m2: moment of inertia about the axis of the part and of all parts attached to it:
            the larger of two values, one in the T-pose and one with elbows and knees bent by 90
            degrees. In the T-pose alone, an axis along a straight limb would have almost no
            inertia, although it carries much once the limb is bent.
    """

    limb_kg_m2: float

    @property
    def armature_kg_m2(self) -> float:
        """Return the inertia of the hinge itself."""
        return ARMATURE_KG_M2 + ARMATURE_SHARE * self.limb_kg_m2

    @property
    def inertia_kg_m2(self) -> float:
        """Return the inertia that the motor turns: limb and armature."""
        return self.limb_kg_m2 + self.armature_kg_m2

    @property
    def damping_nm_s(self) -> float:
        """Return the torque of the passive damping per rad/s."""
        return DAMPING_PER_S * self.inertia_kg_m2


def hinges_of(body: Body, masses: BodyMasses) -> dict[str, Hinge]:
    """Return the hinge of every axis of the parts of `body`, axis name -> hinge."""
    straight, bent = _limbs(body, masses, {}), _limbs(body, masses, _BENT)
    places = body.places_m()
    return {
        axis.name: Hinge(
            max(limbs[part].about_axis(places[part], axis.direction) for limbs in (straight, bent))
        )
        for part in body.parts
        for axis in AXES_OF[part]
    }


def _limbs(
    body: Body, masses: BodyMasses, turns: Mapping[str, Quaternion]
) -> Mapping[str, Inertial]:
    """Return each part combined with all parts attached to it, in the world frame of the T-pose.

    `turns` rotates a part, and everything attached to it, about its joint, but only in the totals
    of the parts above it: this is how elbows and knees are bent.
    """
    places = body.places_m()
    attached: dict[str, list[Inertial]] = {part: [] for part in body.parts}
    for name in reversed(tuple(body.parts)):
        attached[name].append(masses.parts[name].moved(places[name]))
        parent = body.parts[name].parent
        if parent is not None:
            turn = turns.get(name)
            attached[parent] += (
                attached[name]
                if turn is None
                else [inertial.turned(turn, places[name]) for inertial in attached[name]]
            )
    return {part: combined(inertials) for part, inertials in attached.items()}


def with_locks(
    axes: Sequence[Axis], locked_rad: Sequence[float | None]
) -> tuple[Quaternion, list[tuple[Axis, Vector]]]:
    """Return the combined rotation of all locked axes, and each free axis with its new direction.

    The new direction is the one in the frame that is already turned by the locked axes.

    Args:
        axes: the axes of one part, outermost first.
        locked_rad: for each axis, the angle it is locked at; None where it is free.
    """
    turn: Quaternion = IDENTITY
    turning: list[tuple[Axis, Vector]] = []
    for axis, angle in zip(axes, locked_rad, strict=True):
        if angle is None:
            turning.append((axis, axis.direction))
        elif angle != 0.0:
            turn = q_multiply(turn, _about(axis.direction, angle))
            back = _about(axis.direction, -angle)
            turning = [(outer, q_rotate(back, direction)) for outer, direction in turning]
    return turn, turning


def _about(direction: Vector, angle: float) -> Quaternion:
    x, y, z = direction
    half = sin(angle / 2.0)
    return (cos(angle / 2.0), x * half, y * half, z * half)
