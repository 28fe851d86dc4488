"""Run the relay experiment on one axis of a body, in each pose that matters for the axis."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

from app.science.avatar.body import FINGER_PARTS, Body, BodyMasses
from app.science.avatar.configuration import AxisSettings
from app.science.avatar.mjcf import NATURAL_HZ, Hinge, hinges_of
from app.science.avatar.tuning.plant import axis_plant, poses_of, without_shapes
from app.science.avatar.tuning.relay import NoOscillation, relay_for, run_relay
from app.science.avatar.tuning.results import Experiment, TuningOptions

RELAY_PER_NATURAL: Final = 1.083
"""Ratio of the relay's frequency to the natural frequency of the gains by the `critical` rule."""
RETRY_SHARE: Final = 0.8
"""Each attempt aims at this share of the previous frequency, with 64 % of the previous torque."""


def natural_hz(axis: str) -> float:
    """Return the natural frequency of an axis in the default configuration, where tuning starts."""
    part = axis[:-1]
    if part in FINGER_PARTS:
        return NATURAL_HZ["Finger"]
    return NATURAL_HZ[part.removeprefix("Left").removeprefix("Right")]


@dataclass(frozen=True)
class Laboratory:
    """One body for relay experiments; several threads may use it.

    Attributes:
        body: the body without shapes; see `without_shapes`.
        masses: the masses of its parts.
        settings: the settings of every axis, in force.
        hinges: the hinges of every axis; their inertia determines the relay's torque.
        options: the options of the tuning.
        wall_s: a monotonic clock.
        cancelled: function that returns whether the tuning was cancelled.
    """

    body: Body
    masses: BodyMasses
    settings: Mapping[str, AxisSettings]
    hinges: Mapping[str, Hinge]
    options: TuningOptions
    wall_s: Callable[[], float]
    cancelled: Callable[[], bool]

    def experiment(self, axis: str, attempt: int) -> Experiment | NoOscillation:
        """Run an attempt on an axis and return the experiment in the pose with the larger inertia.

        `attempt` counts from 1; each aims at a lower frequency than the previous one.
        """
        aimed_hz = natural_hz(axis) * RETRY_SHARE ** (attempt - 1)
        chosen = relay_for(self.hinges[axis].inertia_kg_m2, RELAY_PER_NATURAL * aimed_hz)
        relay = replace(
            chosen,
            longest_s=self.options.longest_s,
            longest_wall_s=self.options.longest_wall_s,
        )
        best: Experiment | None = None
        for pose in poses_of(axis):
            plant = axis_plant(self.body, self.masses, self.settings, axis, pose=pose)
            found = run_relay(plant, relay, wall_s=self.wall_s, cancelled=self.cancelled)
            if isinstance(found, NoOscillation):
                return found
            if best is None or found.inertia_kg_m2 > best.found.inertia_kg_m2:
                best = Experiment(relay, found, pose, aimed_hz)
        return best if best is not None else NoOscillation("there is no pose to measure it in")


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
    hinges = hinges_of(body, masses)
    return Laboratory(without_shapes(body), masses, settings, hinges, options, wall_s, cancelled)
