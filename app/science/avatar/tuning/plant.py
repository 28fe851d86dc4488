"""One axis alone: the whole body, of which everything else is rigid.

It is the avatar's own model with all other axes locked, compiled anew, so its one degree of freedom
has exactly the inertia that the motor of this axis would turn if all others held still. There is no
gravity, nothing to touch and no limit: the experiment finds what the axis is, not what is in its
way, and a knee that is straight at its limit can swing about it.

What hangs on a straight limb weighs nothing about an axis along it. So the arms' and the legs' axes
can be tried with elbows and knees bent, in which the body is heavier about some of them.
"""

from collections.abc import Mapping
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING, Literal

from app.science.avatar.body import AXES, Body, BodyMasses
from app.science.avatar.configuration import AxisSettings, ModelOptions
from app.science.avatar.mjcf import Scene, build_mjcf

if TYPE_CHECKING:
    import mujoco

Pose = Literal["straight", "bent"]
"""Elbows and knees as in the T-pose, or bent by 90 degrees."""
BENDING_AXES = frozenset(
    axis.name
    for axis in AXES
    if axis.movement == "bend" and axis.part.endswith(("LowerArm", "LowerLeg"))
)
_BENT_LIMBS = ("UpperArm", "UpperLeg")
_ALONE = ModelOptions(gravity=False, self_collision=False, longest_delay_s=0.0)
_NOWHERE = Scene(floor=False)


def poses_of(axis: str) -> tuple[Pose, ...]:
    """The poses in which an axis is tried; the heavier one counts."""
    return ("straight", "bent") if axis[:-1].endswith(_BENT_LIMBS) else ("straight",)


def bare(body: Body) -> Body:
    """The body without shapes, as heavy as it was: three times as fast to simulate."""
    parts = {name: replace(part, shapes=()) for name, part in body.parts.items()}
    return replace(body, parts=parts)


class AxisPlant:
    """A hinge and what hangs on it, driven by a torque; angles in rad from where it began."""

    def __init__(self, model: "mujoco.MjModel") -> None:
        import mujoco

        self._model = model
        off = mujoco.mjtDisableBit
        model.opt.disableflags |= off.mjDSBL_CONTACT | off.mjDSBL_LIMIT | off.mjDSBL_ACTUATION
        self._data = mujoco.MjData(model)
        self._step = mujoco.mj_step
        self._reset = mujoco.mj_resetData

    def prepare(self, step_s: float, damping_nm_s: float) -> None:
        """Return to the start, at rest, with this step and this damping of the hinge."""
        self._model.opt.timestep = step_s
        self._model.dof_damping[0] = damping_nm_s
        self._reset(self._model, self._data)
        self._torque, self._angle = self._data.qfrc_applied, self._data.qpos

    def step(self, torque_nm: float) -> float:
        """Apply a torque for one step; return the angle after it."""
        self._torque[0] = torque_nm
        self._step(self._model, self._data)
        return float(self._angle[0])


def axis_plant(
    body: Body,
    masses: BodyMasses,
    settings: Mapping[str, AxisSettings],
    axis: str,
    *,
    pose: Pose = "straight",
) -> AxisPlant:
    """Compile the plant of a free axis.

    Args:
        body: the whole body; `bare` makes it faster.
        masses: of its parts.
        settings: of every axis; locked ones stay at their angle, the others at rest.
        axis: name of the one that turns.
        pose: of elbows and knees, as far as their limits let them.
    """
    import mujoco

    alone: dict[str, AxisSettings] = {}
    for name, own in settings.items():
        if name == axis:
            alone[name] = replace(own, low_rad=-pi, high_rad=pi)
        else:
            bent = pose == "bent" and name in BENDING_AXES
            alone[name] = own.held_at(pi / 2.0 if bent else own.rest_rad)
    text = build_mjcf(body, masses, alone, scene=_NOWHERE, options=_ALONE)
    return AxisPlant(mujoco.MjModel.from_xml_string(text))
