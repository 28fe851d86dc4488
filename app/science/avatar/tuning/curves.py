"""Repeat an experiment of a tuning and record its course, to be drawn as curves.

A tuning keeps the settings of its experiments and the figures, not the angles at every moment. The
simulation gives the same course each time, so it is repeated for the axis that somebody looks at.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from app.science.avatar.body import Figure
from app.science.avatar.configuration import TIMESTEP_S, Configuration
from app.science.avatar.mjcf import AvatarModel, avatar_model
from app.science.avatar.tuning.evaluation import Trial
from app.science.avatar.tuning.plant import AxisPlant, Pose, axis_model, without_shapes
from app.science.avatar.tuning.relay import RelaySettings, run_relay
from app.science.rotations import FloatArray

if TYPE_CHECKING:
    import mujoco


@dataclass(frozen=True, eq=False)
class RelayCurve:
    """The course of a relay experiment, from rest until the oscillation was measured.

    Attributes:
        times_s: (N,) since the start.
        angles_rad: (N,) the angle, from where the axis started.
        torques_nm: (N,) the relay's torque; where it switches within a step, the step's mean.
    """

    times_s: FloatArray
    angles_rad: FloatArray
    torques_nm: FloatArray


@dataclass(frozen=True, eq=False)
class StepCurve:
    """The course of a step response on the whole body.

    Attributes:
        times_s: (N,) since the target jumped; the first is zero.
        angles_rad: (N,) the angle of the axis.
        torques_nm: (N,) the torque of its motor, within its limit.
        target_rad: the target after the jump.
        saturated_share: share of the samples in which the motor is at its torque limit.
    """

    times_s: FloatArray
    angles_rad: FloatArray
    torques_nm: FloatArray
    target_rad: float
    saturated_share: float


def relay_curve(
    configuration: Configuration,
    stature_m: float,
    axis: str,
    relay: RelaySettings,
    *,
    pose: Pose,
    wall_s: Callable[[], float],
    figure: Figure | None = None,
) -> RelayCurve:
    """Repeat a relay experiment that a tuning of this configuration made.

    Args:
        configuration: the one that was tuned, with any gains.
        stature_m: the stature of the body that was tuned.
        axis: the axis of the experiment.
        relay, pose: its settings, as recorded with its result.
        wall_s: a monotonic clock, for the time-out.
        figure: the model that the configuration names.

    Raises:
        BodyError: the body cannot be built.
    """
    built = avatar_model(configuration, stature_m, figure=figure)
    model = axis_model(
        without_shapes(built.body), built.masses, configuration.in_force, axis, pose=pose
    )
    plant = _RecordedPlant(model)
    run_relay(plant, relay, wall_s=wall_s)
    return plant.curve(relay.step_s)


def step_curve(
    configuration: Configuration, stature_m: float, axis: str, *, figure: Figure | None = None
) -> StepCurve:
    """Repeat the step response of a free axis, with the gains of this configuration.

    Raises:
        BodyError: the body cannot be built.
    """
    built: AvatarModel = avatar_model(configuration, stature_m, figure=figure)
    settings = configuration.in_force
    body = without_shapes(built.body)
    found = Trial(body, built.masses, settings, gravity=configuration.gravity).response(axis)
    angles = np.concatenate(([found.start_rad], found.angles_rad))
    speeds = np.concatenate(([0.0], found.speeds_rad_s))
    own = settings[axis]
    wanted = own.kp * (found.jump.target_rad - angles) - own.kd * speeds
    return StepCurve(
        times_s=np.arange(len(angles), dtype=np.float64) * TIMESTEP_S,
        angles_rad=angles,
        torques_nm=np.clip(wanted, -own.max_torque_nm, own.max_torque_nm),
        target_rad=found.jump.target_rad,
        saturated_share=float(np.mean(np.abs(wanted) >= own.max_torque_nm)),
    )


class _RecordedPlant(AxisPlant):
    """An axis that remembers the torques that were applied and the angles that followed."""

    def __init__(self, model: "mujoco.MjModel") -> None:
        super().__init__(model)
        self._torques: list[float] = []
        self._angles: list[float] = []

    def step(self, torque_nm: float) -> float:
        """Apply a torque for one step and return the angle after it."""
        angle = super().step(torque_nm)
        self._torques.append(torque_nm)
        self._angles.append(angle)
        return angle

    def curve(self, step_s: float) -> RelayCurve:
        """Return what was recorded, with a step of this length."""
        times = np.arange(1, len(self._angles) + 1, dtype=np.float64) * step_s
        return RelayCurve(times, np.array(self._angles), np.array(self._torques))
