"""Gains on trial: the whole body, one axis after the other asked to jump by 30 degrees.

All axes are driven, so a limb leans on neighbours that give way, as it will. Gravity is that of
the configuration. There is no floor and parts pass through each other: the trial asks how an axis
moves, not what is in its way. Hips are carried.

An axis starts where its body stands, and jumps to the side where it turns farther. If there is not
enough room for that it jumps through the middle of its range, at most by eight tenths of it, so
that a limit never hides an overshoot.
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
_ROOM = 1.25
_SHARE_OF_RANGE = 0.8
_STAND_S, _LEAN_S, _WATCH_S = 1.0, 0.3, 0.8


@dataclass(frozen=True)
class Jump:
    """From one angle to another, rad."""

    start_rad: float
    target_rad: float


def jump_of(settings: AxisSettings) -> Jump:
    """The jump an axis is tried with."""
    rest = settings.rest_rad
    up, down = settings.high_rad - rest, rest - settings.low_rad
    if max(up, down) >= _ROOM * STEP_RAD:
        return Jump(rest, rest + (STEP_RAD if up >= down else -STEP_RAD))
    middle = (settings.low_rad + settings.high_rad) / 2.0
    half = min(STEP_RAD, _SHARE_OF_RANGE * settings.range_rad) / 2.0
    return Jump(middle - half, middle + half)


class Trial:
    """One body with its gains, standing at rest; `names` are the axes that can be tried."""

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
        mujoco.mj_step(self._model, data, nstep=round(_STAND_S / TIMESTEP_S))
        self._rest, self._stood = rest, data.qpos.copy()
        self._moved_at_once = self._effective_inertias(data)

    def step(self, axis: str) -> StepFigures:
        """Try one axis. Several threads may do so at once."""
        row = self.names.index(axis)
        jump = jump_of(self._settings[axis])
        data: mujoco.MjData = self._mujoco.MjData(self._model)
        data.qpos[:] = self._stood
        data.ctrl[0::2] = self._rest
        if jump.start_rad != self._rest[row]:
            data.qpos[row] = jump.start_rad
            data.ctrl[2 * row] = jump.start_rad
            self._mujoco.mj_step(self._model, data, nstep=round(_LEAN_S / TIMESTEP_S))
        start = float(data.qpos[row])
        data.ctrl[2 * row] = jump.target_rad
        angles = self._watch(data, row)
        return step_figures(angles, start, jump.target_rad, TIMESTEP_S)

    def clearance(self, axis: str) -> float:
        """How far the damper of an axis stays clear of chatter: 2 J / (kd h), more than 1.

        J is what the motor moves at once while all neighbours are free to give way (see `hinges`),
        in the pose in which the body stands; infinite without a damper.
        """
        row = self.names.index(axis)
        kd = self._settings[axis].kd
        if kd == 0.0:
            return float("inf")
        return float(2.0 * self._moved_at_once[row] / (kd * TIMESTEP_S))

    def _effective_inertias(self, data: "mujoco.MjData") -> FloatArray:
        self._mujoco.mj_forward(self._model, data)
        inertia = np.zeros((self._model.nv, self._model.nv))
        self._mujoco.mj_fullM(self._model, data, inertia)
        found: FloatArray = 1.0 / np.diagonal(np.linalg.inv(inertia))
        return found

    def _watch(self, data: "mujoco.MjData", row: int) -> FloatArray:
        from mujoco import rollout  # many steps in one call let another thread work meanwhile

        kind = self._mujoco.mjtState.mjSTATE_FULLPHYSICS
        begin = np.empty(self._mujoco.mj_stateSize(self._model, kind))
        self._mujoco.mj_getState(self._model, data, begin, kind)
        controls = data.ctrl[np.newaxis, np.newaxis].copy()
        steps = round(_WATCH_S / TIMESTEP_S)
        states, _ = rollout.rollout(self._model, data, begin, controls, nstep=steps)
        # A state begins with the time, then come the angles.
        angles: FloatArray = states[0, :, 1 + row].copy()
        return angles
