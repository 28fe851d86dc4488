"""The relay experiment on one axis of a body: which torque, in which pose, and what came of it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

from app.science.avatar.body import FINGER_PARTS, Body, BodyMasses
from app.science.avatar.configuration import AxisSettings
from app.science.avatar.mjcf import NATURAL_HZ, Hinge, hinges_of
from app.science.avatar.tuning.plant import axis_plant, bare, poses_of
from app.science.avatar.tuning.relay import NoOscillation, relay_for, run_relay
from app.science.avatar.tuning.results import Experiment, TuningOptions

RELAY_PER_NATURAL: Final = 1.083
"""Relay frequency per natural frequency of the gains that come of it by the `critical` rule."""
RETRY_SHARE: Final = 0.8
"""Each attempt aims at this share of the frequency of the one before, so at half its torque."""


def natural_hz(axis: str) -> float:
    """The natural frequency that is aimed at first, as for the gains that come with the product."""
    part = axis[:-1]
    if part in FINGER_PARTS:
        return NATURAL_HZ["Finger"]
    return NATURAL_HZ[part.removeprefix("Left").removeprefix("Right")]


@dataclass(frozen=True)
class Laboratory:
    """One body on which experiments are done; several threads may use it.

    Attributes:
        body: without shapes, see `bare`.
        masses: of its parts.
        settings: of every axis, in force.
        hinges: of every axis; their inertia chooses the relay's torque.
        options: of the tuning.
        wall_s: a clock that only goes forward.
        cancelled: whether nobody wants the result any more.
    """

    body: Body
    masses: BodyMasses
    settings: Mapping[str, AxisSettings]
    hinges: Mapping[str, Hinge]
    options: TuningOptions
    wall_s: Callable[[], float]
    cancelled: Callable[[], bool]

    def experiment(self, axis: str, attempt: int) -> Experiment | NoOscillation:
        """Do attempt 1, 2, ... on an axis, in each pose it is tried in; the heavier one counts."""
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
        return best if best is not None else NoOscillation("there is no pose to try it in")


def laboratory(
    body: Body,
    masses: BodyMasses,
    settings: Mapping[str, AxisSettings],
    options: TuningOptions,
    *,
    wall_s: Callable[[], float],
    cancelled: Callable[[], bool],
) -> Laboratory:
    """Prepare a body for experiments."""
    hinges = hinges_of(body, masses)
    return Laboratory(bare(body), masses, settings, hinges, options, wall_s, cancelled)
