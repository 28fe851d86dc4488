"""Test gains on the whole body by the step response of one axis after another.

All axes are driven, so a limb pushes against neighbours that give way, as it will in use. Gravity
is that of the configuration. There is no floor and parts pass through each other: the test is about
how an axis moves, not about obstacles. The hips are carried.

The target of an axis jumps by 30 degrees from its rest angle, to the side where it has more range.
Where that range is too small, it jumps across the middle of its range, by at most eight tenths of
it, so that a limit never hides an overshoot.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import radians
from typing import TYPE_CHECKING, Final

import numpy as np

from app.science.avatar.body import Body, BodyMasses
from app.science.avatar.configuration import TIMESTEP_S, AxisSettings, ModelOptions
from app.science.avatar.mjcf import Scene, build_mjcf, driven_axes
from app.science.avatar.tuning.step_response import StepFigures, step_figures
from app.science.rotations import FloatArray

if TYPE_CHECKING:
    import mujoco

STEP_RAD: Final = radians(30.0)
_MIN_RANGE_PER_STEP = 1.25
_SHARE_OF_RANGE = 0.8
_SETTLE_S, _PREPARE_S, _RECORD_S = 1.0, 0.3, 0.8


@dataclass(frozen=True)
class Jump:
    """A step of a target from one angle to another, in rad."""

    start_rad: float
    target_rad: float


def jump_of(settings: AxisSettings) -> Jump:
    """Return the step that an axis with these settings is tested with."""
    rest = settings.rest_rad
    up, down = settings.high_rad - rest, rest - settings.low_rad
    if max(up, down) >= _MIN_RANGE_PER_STEP * STEP_RAD:
        return Jump(rest, rest + (STEP_RAD if up >= down else -STEP_RAD))
    middle = (settings.low_rad + settings.high_rad) / 2.0
    half = min(STEP_RAD, _SHARE_OF_RANGE * settings.range_rad) / 2.0
    return Jump(middle - half, middle + half)


@dataclass(frozen=True, eq=False)
class StepResponse:
    """The recorded step response of one axis.

    Attributes:
        jump: the step of the target.
        start_rad: the angle at the jump.
        angles_rad: (N,) the angle after each time step since then.
        speeds_rad_s: (N,) likewise its speed.
    """

    jump: Jump
    start_rad: float
    angles_rad: FloatArray
    speeds_rad_s: FloatArray


class Trial:
    """Step responses of one body with its gains; `names` are the axes that can be tested."""

    def __init__(
        self,
        body: Body,
        masses: BodyMasses,
        settings: Mapping[str, AxisSettings],
        *,
        gravity: bool = True,
    ) -> None:
        import mujoco

        options = ModelOptions(gravity=gravity, self_collision=False, longest_delay_s=0.0)
        scene = Scene(floor=False)
        text = build_mjcf(body, masses, settings, scene=scene, options=options)
        self._mujoco = mujoco
        self._model = mujoco.MjModel.from_xml_string(text)
        self._model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
        self._settings = settings
        self.names = tuple(axis.name for axis in driven_axes(body, settings))
        data = mujoco.MjData(self._model)
        rest = np.array([settings[name].rest_rad for name in self.names])
        data.qpos[:] = rest
        data.ctrl[0::2] = rest
        mujoco.mj_step(self._model, data, nstep=round(_SETTLE_S / TIMESTEP_S))
        self._rest, self._standing = rest, data.qpos.copy()
        self._free_inertias = self._effective_inertias(data)

    def step(self, axis: str) -> StepFigures:
        """Return the figures of one axis' step response; this method is thread-safe."""
        found = self.response(axis)
        target = found.jump.target_rad
        return step_figures(found.angles_rad, found.start_rad, target, TIMESTEP_S)

    def response(self, axis: str) -> StepResponse:
        """Return one axis' step response; this method is thread-safe."""
        row = self.names.index(axis)
        jump = jump_of(self._settings[axis])
        data: mujoco.MjData = self._mujoco.MjData(self._model)
        data.qpos[:] = self._standing
        data.ctrl[0::2] = self._rest
        if jump.start_rad != self._rest[row]:
            data.qpos[row] = jump.start_rad
            data.ctrl[2 * row] = jump.start_rad
            self._mujoco.mj_step(self._model, data, nstep=round(_PREPARE_S / TIMESTEP_S))
        start = float(data.qpos[row])
        data.ctrl[2 * row] = jump.target_rad
        angles, speeds = self._after(data, row)
        return StepResponse(jump, start, angles, speeds)

    def clearance(self, axis: str) -> float:
        """Return the margin of an axis' damping against chatter: 2 J / (kd h), stable above 1.

        J is what the motor moves immediately while all neighbours are free to give way (see
        `hinges`), in the pose in which the body stands; infinite without damping.
        """
        row = self.names.index(axis)
        kd = self._settings[axis].kd
        if kd == 0.0:
            return float("inf")
        return float(2.0 * self._free_inertias[row] / (kd * TIMESTEP_S))

    def _effective_inertias(self, data: "mujoco.MjData") -> FloatArray:
        self._mujoco.mj_forward(self._model, data)
        inertia = np.zeros((self._model.nv, self._model.nv))
        self._mujoco.mj_fullM(self._model, data, inertia)
        inertias: FloatArray = 1.0 / np.diagonal(np.linalg.inv(inertia))
        return inertias

    def _after(self, data: "mujoco.MjData", row: int) -> tuple[FloatArray, FloatArray]:
        from mujoco import rollout  # one call for many steps lets other threads run meanwhile

        kind = self._mujoco.mjtState.mjSTATE_FULLPHYSICS
        initial = np.empty(self._mujoco.mj_stateSize(self._model, kind))
        self._mujoco.mj_getState(self._model, data, initial, kind)
        controls = data.ctrl[np.newaxis, np.newaxis].copy()
        steps = round(_RECORD_S / TIMESTEP_S)
        states, _ = rollout.rollout(self._model, data, initial, controls, nstep=steps)
        # A state begins with the time, followed by the angles and the speeds.
        first_speed = 1 + self._model.nq
        return states[0, :, 1 + row].copy(), states[0, :, first_speed + row].copy()
