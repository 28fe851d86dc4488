"""Options, progress and results of a tuning, axis by axis."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from math import isfinite
from typing import Final, Literal, Protocol

from app.science.avatar.body import AXIS_NAMES, mirrored_name
from app.science.avatar.configuration import Configuration
from app.science.avatar.tuning.heuristics import HEURISTICS
from app.science.avatar.tuning.plant import Pose
from app.science.avatar.tuning.ramp import Push
from app.science.avatar.tuning.relay import Oscillation, RelaySettings
from app.science.avatar.tuning.step_response import StepFigures

DEFAULT_HEURISTIC: Final = "critical"
MAX_ATTEMPTS: Final = 10
Phase = Literal["relay", "steps"]


class TuningError(ValueError):
    """A tuning is impossible with the given options or movement."""


class TuningCancelled(Exception):
    """The tuning was cancelled before it ended; there is no result."""


class TuningJournal(Protocol):
    """Keeps what a tuning has measured, so that it can go on after an interruption.

    A tuning is a sequence of runs: in each, all axes concerned are measured in one way. The same
    input gives the same runs with the same results, so a result is identified by the number of its
    run, from 0, and its axis.
    """

    def known(self, run: int, axis: str) -> object | None:
        """Return the result of an axis in a run that was kept earlier; None if there is none."""
        ...

    def keep(self, run: int, attempt: int, phase: Phase, axis: str, result: object) -> None:
        """Keep a result: an `Experiment` or `NoOscillation`, or `StepFigures`."""
        ...


@dataclass(frozen=True)
class TuningOptions:
    """Options of a tuning, which uses no random numbers.

    Attributes:
        heuristic: a key of `HEURISTICS`.
        mirror: whether to tune only the left side and copy its gains to the right.
        attempts: maximum number of relay experiments per axis, each aiming at a lower frequency.
        accepted_overshoot_percent: the accepted overshoot of the step response; an axis that
            exceeds it is retried.
        longest_s: simulated time after which an axis counts as not oscillating.
        longest_wall_s: the same in wall-clock time.
        workers: number of threads, 1 to 64.
        relay_torque_nm: the relay's torque in the first attempt, for every axis; None: a ramp
            finds it, axis by axis (`ramp`).
        relay_torques_nm: the same by axis, for axes that shall have a torque of their own.
        axes: the axes to tune; None: all that are free. With `mirror`, a left axis includes its
            right counterpart.

    Raises:
        TuningError: an unknown heuristic or axis, no axis, or a number out of range.
    """

    heuristic: str = DEFAULT_HEURISTIC
    mirror: bool = False
    attempts: int = 3
    accepted_overshoot_percent: float = 5.0
    longest_s: float = 10.0
    longest_wall_s: float = 20.0
    workers: int = 2
    relay_torque_nm: float | None = None
    relay_torques_nm: Mapping[str, float] = field(default_factory=dict)
    axes: tuple[str, ...] | None = None

    def __post_init__(self) -> None:
        if self.heuristic not in HEURISTICS:
            raise TuningError(
                f"there is no heuristic {self.heuristic!r}; {', '.join(HEURISTICS)} are valid"
            )
        ranges = (
            ("attempts", 1, MAX_ATTEMPTS),
            ("accepted_overshoot_percent", 0, 100),
            ("longest_s", 0.01, 600),
            ("longest_wall_s", 0.001, 600),
            ("workers", 1, 64),
        )
        for name, least, most in ranges:
            value = getattr(self, name)
            if not least <= value <= most:
                raise TuningError(f"{name} is {value:g}: from {least} to {most} is valid")
        self._check_axes("a relay torque is given for", self.relay_torques_nm)
        if self.axes is not None:
            self._check_axes("the axes to tune include", self.axes)
            if not self.axes:
                raise TuningError("no axis is chosen: name at least one, or leave 'axes' out")
        for torque_nm in (self.relay_torque_nm, *self.relay_torques_nm.values()):
            if torque_nm is not None and not (isfinite(torque_nm) and torque_nm > 0.0):
                raise TuningError(
                    f"a relay torque is {torque_nm:g} N m: a number above 0 is valid, up to 70 %"
                    " of the torque limit of the axis"
                )

    def relay_torque_of(self, axis: str) -> float | None:
        """Return the torque that the user chose for an axis; None if a ramp shall find it."""
        return self.relay_torques_nm.get(axis, self.relay_torque_nm)

    def includes(self, axis: str) -> bool:
        """Return whether an axis is to be tuned, if it is free."""
        if self.axes is None or axis in self.axes:
            return True
        return self.mirror and axis.startswith("Right") and mirrored_name(axis) in self.axes

    @staticmethod
    def _check_axes(given: str, axes: Iterable[str]) -> None:
        unknown = [name for name in axes if name not in AXIS_NAMES]
        if unknown:
            raise TuningError(
                f"{given} {unknown[0]!r}, which is no axis; valid are"
                f" {AXIS_NAMES[0]} to {AXIS_NAMES[-1]}, as `reembody tune` lists them"
            )

    def without_torques(self) -> "TuningOptions":
        """Return the same options with every torque left to the ramp."""
        return replace(self, relay_torque_nm=None, relay_torques_nm={})


@dataclass(frozen=True)
class TuningProgress:
    """Progress of a tuning: `done` of `total` axes in the attempt's phase, most recently `axis`."""

    attempt: int
    phase: Phase
    axis: str
    done: int
    total: int


@dataclass(frozen=True)
class Experiment:
    """The relay experiment from which the gains of an axis were computed.

    Attributes:
        push: the push from which torque, damping and hysteresis of the relay follow.
        relay: the settings of the experiment.
        found: the oscillation that was measured.
        pose: the pose of elbows and knees.
        aimed_hz: natural frequency that the relay was chosen for.
    """

    push: Push
    relay: RelaySettings
    found: Oscillation
    pose: Pose
    aimed_hz: float


@dataclass(frozen=True)
class AxisTuning:
    """The result of tuning one axis.

    Attributes:
        name: the name of the axis.
        kp, kd: its resulting gains, N m/rad and N m s/rad.
        status: `tuned`, `retried`, `locked`, `kept`, or `flagged: ` and the reason. An axis that is
            locked, was not chosen or did not oscillate keeps its previous gains.
        note: further information about the status.
        attempts: number of relay experiments on it.
        experiment: the one that gave the gains; None if there was none.
        mirrored_from: the axis whose gains were copied.
        step: the step response with these gains; None for an axis that is locked or kept.
        warning: what a torque that the user chose makes far worse than the ramp's; else empty.
    """

    name: str
    kp: float
    kd: float
    status: str
    note: str = ""
    attempts: int = 0
    experiment: Experiment | None = None
    mirrored_from: str | None = None
    step: StepFigures | None = None
    warning: str = ""

    @property
    def flagged(self) -> bool:
        """Return whether the result needs a person's attention."""
        return self.status.startswith("flagged")


@dataclass(frozen=True)
class TuningReport:
    """The result of tuning a whole avatar.

    Attributes:
        configuration: the given one with the new gains.
        stature_m: the stature of the body it was tuned on.
        options: the options of the tuning.
        axes: every axis of the configuration, in its order.
        wall_s: elapsed time by the given clock.
    """

    configuration: Configuration
    stature_m: float
    options: TuningOptions
    axes: tuple[AxisTuning, ...] = field(repr=False)
    wall_s: float
