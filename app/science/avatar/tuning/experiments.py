"""Run the experiments on one axis of a body, in each pose that matters for the axis.

The laboratory has the body only to simulate it. What the experiments are told of an axis is its
torque limit and how fast it shall respond, as a natural frequency (`natural_hz`); all else is
measured.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from app.science.avatar.body import FINGER_PARTS, Body, BodyMasses
from app.science.avatar.configuration import AxisSettings
from app.science.avatar.mjcf import NATURAL_HZ
from app.science.avatar.tuning.plant import AxisPlant, axis_plant, poses_of, without_shapes
from app.science.avatar.tuning.ramp import Push, chosen_push, ramp
from app.science.avatar.tuning.relay import NoOscillation, run_relay
from app.science.avatar.tuning.results import Experiment, TuningOptions

RELAY_PER_NATURAL: Final = 1.083
"""Ratio of the relay's frequency to the natural frequency of the gains by the `critical` rule."""
RETRY_SHARE: Final = 0.8
"""Each attempt aims at this share of the previous frequency, with 64 % of the previous torque."""


def natural_hz(axis: str) -> float:
    """Return the natural frequency that an axis shall have, chosen for each body part.

    Light parts have to be fast, since a limb's own weight deflects it by an angle of about
    g / (w^2 l); the trunk's has to stay below the rate at which its joints chatter (`gains`).
    """
    part = axis[:-1]
    if part in FINGER_PARTS:
        return NATURAL_HZ["Finger"]
    return NATURAL_HZ[part.removeprefix("Left").removeprefix("Right")]


@dataclass(frozen=True)
class Laboratory:
    """One body for experiments; several threads may use it.

    Attributes:
        body: the body without shapes; see `without_shapes`.
        masses: the masses of its parts.
        settings: the settings of every axis, in force; their limits bound the torques.
        options: the options of the tuning.
        wall_s: a monotonic clock.
        cancelled: function that returns whether the tuning was cancelled.
    """

    body: Body
    masses: BodyMasses
    settings: Mapping[str, AxisSettings]
    options: TuningOptions
    wall_s: Callable[[], float]
    cancelled: Callable[[], bool]

    def experiment(self, axis: str, attempt: int) -> Experiment | NoOscillation:
        """Run an attempt on an axis, in the pose that is harder to move.

        `attempt` counts from 1; each aims at a lower frequency than the previous one.
        """
        heaviest: tuple[float, Experiment] | None = None
        for pose in poses_of(axis):
            plant = axis_plant(self.body, self.masses, self.settings, axis, pose=pose)
            push = self._push(plant, axis, attempt)
            if isinstance(push, NoOscillation):
                return push
            relay = push.relay(
                longest_s=self.options.longest_s, longest_wall_s=self.options.longest_wall_s
            )
            found = run_relay(plant, relay, wall_s=self.wall_s, cancelled=self.cancelled)
            if isinstance(found, NoOscillation):
                return found
            if heaviest is None or found.inertia_kg_m2 > heaviest[0]:
                aimed_hz = push.relay_hz / RELAY_PER_NATURAL
                one = Experiment(push, relay, found, pose, aimed_hz)
                heaviest = found.inertia_kg_m2, one
        return heaviest[1] if heaviest else NoOscillation("there is no pose to measure it in")

    def _push(self, plant: AxisPlant, axis: str, attempt: int) -> Push | NoOscillation:
        limit_nm = self.settings[axis].max_torque_nm
        eased = RETRY_SHARE ** (attempt - 1)
        chosen_nm = self.options.relay_torque_of(axis)
        if chosen_nm is not None:
            return chosen_push(plant, limit_nm, chosen_nm, share=eased**2)
        relay_hz = RELAY_PER_NATURAL * natural_hz(axis) * eased
        return ramp(plant, limit_nm, 1.0 / (4.0 * relay_hz))


def laboratory(
    body: Body,
    masses: BodyMasses,
    settings: Mapping[str, AxisSettings],
    options: TuningOptions,
    *,
    wall_s: Callable[[], float],
    cancelled: Callable[[], bool],
) -> Laboratory:
    """Return a `Laboratory` for a body."""
    return Laboratory(without_shapes(body), masses, settings, options, wall_s, cancelled)
