"""What each hinge moves, and the armature and damping that the model adds to it.

Armature is inertia of the hinge itself: it resists only the turning of a part against the one it
hangs on. It keeps motors calm. A joint between two light neighbours that are free to give way moves
only `J`, a small part of the inertia `I` of the limb: a hundredth in the spine. Its damper `kd` is
chosen for the whole limb. Once such a motor is at its greatest torque, it would throw the joint to
and fro at each step for ever if in one step of length h

    kd h > 2 J,

as each throw then asks for the greatest torque the other way. With an armature of .15 I the joint
of a critically damped motor, kd = 2 w I, stays clear of this up to w = .15 / h = 75 rad/s, which is
12 Hz, even where J is zero. It costs 15 % more torque to turn a limb at the same rate.

Locked axes become part of a body's place, as a cast turns the hinges around it (`with_locks`). A
part's rotation is a product of turns about its axes, R1 R2 R3. A locked axis is a constant L in
it. As R(a, q) L = L R(L^-1 a, q), all constants can stand in front, where they turn the whole body,
if each axis that stood before one is turned back by it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, sin, sqrt
from types import MappingProxyType

from app.science.avatar.body import AXES, AXES_OF, Axis, Body, BodyMasses, Inertial, combined
from app.science.rotations import IDENTITY, Quaternion, Vector, q_multiply, q_rotate, v_scale

ARMATURE_SHARE = 0.15
"""Armature of a hinge as a fraction of the inertia of its limb; see the module."""
ARMATURE_KG_M2 = 1e-4
"""Added to that: a fingertip of 2 g on a hand of 300 g would need a shorter step without it."""
DAMPING_PER_S = 1.0
"""Passive damping of a hinge, as a fraction of its inertia: a limb that nothing drives comes to
rest within seconds. A relay experiment needs some damping to end in a limit cycle."""
_BENT: Mapping[str, Quaternion] = MappingProxyType(
    {
        axis.part: (sqrt(0.5), *v_scale(axis.direction, sqrt(0.5)))
        for axis in AXES
        if axis.movement == "bend" and axis.part.endswith(("LowerArm", "LowerLeg"))
    }
)


@dataclass(frozen=True)
class Hinge:
    """One axis.

    Attributes:
        limb_kg_m2: moment of inertia about the axis of the part and all that hangs on it: the
            larger one of the T-pose and of the same with elbows and knees bent by 90 degrees. An
            axis along a straight limb would know nothing of what it carries when the limb is bent.
    """

    limb_kg_m2: float

    @property
    def armature_kg_m2(self) -> float:
        """Inertia of the hinge itself."""
        return ARMATURE_KG_M2 + ARMATURE_SHARE * self.limb_kg_m2

    @property
    def inertia_kg_m2(self) -> float:
        """What the motor turns: limb and armature."""
        return self.limb_kg_m2 + self.armature_kg_m2

    @property
    def damping_nm_s(self) -> float:
        """Torque of the passive damping per rad/s."""
        return DAMPING_PER_S * self.inertia_kg_m2


def hinges_of(body: Body, masses: BodyMasses) -> dict[str, Hinge]:
    """Return the hinge of every axis of the present parts, axis name -> hinge."""
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
    """Each part with everything that hangs on it, in the world of the T-pose.

    Limbs are seen by what they hang on: `turns` bends them at their joints.
    """
    places = body.places_m()
    hanging: dict[str, list[Inertial]] = {part: [] for part in body.parts}
    for name in reversed(tuple(body.parts)):
        hanging[name].append(masses.parts[name].moved(places[name]))
        parent = body.parts[name].parent
        if parent is not None:
            turn = turns.get(name)
            hanging[parent] += (
                hanging[name]
                if turn is None
                else [thing.turned(turn, places[name]) for thing in hanging[name]]
            )
    return {part: combined(things) for part, things in hanging.items()}


def with_locks(
    axes: Sequence[Axis], locked_rad: Sequence[float | None]
) -> tuple[Quaternion, list[tuple[Axis, Vector]]]:
    """Return the turn of all locked axes, and each other axis with its direction behind that turn.

    Args:
        axes: of one part, outermost first.
        locked_rad: for each, the angle it is locked at; None where it turns.
    """
    turn: Quaternion = IDENTITY
    turning: list[tuple[Axis, Vector]] = []
    for axis, angle in zip(axes, locked_rad, strict=True):
        if angle is None:
            turning.append((axis, axis.direction))
        elif angle != 0.0:
            turn = q_multiply(turn, _about(axis.direction, angle))
            back = _about(axis.direction, -angle)
            turning = [(before, q_rotate(back, way)) for before, way in turning]
    return turn, turning


def _about(direction: Vector, angle: float) -> Quaternion:
    x, y, z = direction
    half = sin(angle / 2.0)
    return (cos(angle / 2.0), x * half, y * half, z * half)
