"""Simulate one axis alone: the whole body, with all other axes rigid.

It is the avatar's own model, compiled with all other axes locked, so its one degree of freedom has
exactly the inertia that the motor of this axis would turn if no other axis moved. There is no
gravity, no obstacle and no limit: the experiment measures the axis and not its surroundings, and a
knee that is straight at its limit can still swing about it.

The parts attached to a straight limb have almost no inertia about the limb's own axis. So the axes
of the upper arms and upper legs can also be tested with elbows and knees bent, which gives some of
them a larger inertia.
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
_OPTIONS = ModelOptions(gravity=False, self_collision=False, longest_delay_s=0.0)
_EMPTY_SCENE = Scene(floor=False)


def poses_of(axis: str) -> tuple[Pose, ...]:
    """Return the poses in which an axis is measured; the result with the larger inertia is used."""
    return ("straight", "bent") if axis[:-1].endswith(_BENT_LIMBS) else ("straight",)


def without_shapes(body: Body) -> Body:
    """Return the body without shapes and with the same masses: three times as fast to simulate."""
    parts = {name: replace(part, shapes=()) for name, part in body.parts.items()}
    return replace(body, parts=parts)


class AxisPlant:
    """A hinge and the parts attached to it, driven by a torque; angles in rad from its start."""

    def __init__(self, model: "mujoco.MjModel") -> None:
        import mujoco

        self._model = model
        disable = mujoco.mjtDisableBit
        model.opt.disableflags |= (
            disable.mjDSBL_CONTACT | disable.mjDSBL_LIMIT | disable.mjDSBL_ACTUATION
        )
        self._data = mujoco.MjData(model)
        self._own_damping = float(model.dof_damping[0])
        self._step = mujoco.mj_step
        self._reset = mujoco.mj_resetData

    def prepare(self, step_s: float, damping_nm_s: float) -> None:
        """Reset to the start, at rest, with this time step and damping added to the hinge's own."""
        self._model.opt.timestep = step_s
        self._model.dof_damping[0] = self._own_damping + damping_nm_s
        self._reset(self._model, self._data)
        self._torque, self._angle = self._data.qfrc_applied, self._data.qpos

    def step(self, torque_nm: float) -> float:
        """Apply a torque for one step and return the angle after it."""
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
    """Return the plant of a single free axis; it takes the same arguments as `axis_model`."""
    return AxisPlant(axis_model(body, masses, settings, axis, pose=pose))


def axis_model(
    body: Body,
    masses: BodyMasses,
    settings: Mapping[str, AxisSettings],
    axis: str,
    *,
    pose: Pose = "straight",
) -> "mujoco.MjModel":
    """Compile the model of a single free axis.

    Args:
        body: the whole body; `without_shapes` makes it faster.
        masses: the masses of its parts.
        settings: the settings of every axis; locked ones stay at their angle, the others at their
            rest angle.
        axis: name of the axis that turns.
        pose: the pose of elbows and knees, as far as their limits allow.
    """
    import mujoco

    single: dict[str, AxisSettings] = {}
    for name, own in settings.items():
        if name == axis:
            single[name] = replace(own, low_rad=-pi, high_rad=pi)
        else:
            bent = pose == "bent" and name in BENDING_AXES
            single[name] = own.locked_at(pi / 2.0 if bent else own.rest_rad)
    text = build_mjcf(body, masses, single, scene=_EMPTY_SCENE, options=_OPTIONS)
    return mujoco.MjModel.from_xml_string(text)
