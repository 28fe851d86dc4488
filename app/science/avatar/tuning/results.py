"""What a tuning is asked for, and what it answers, axis by axis."""

from dataclasses import dataclass, field
from typing import Final, Literal

from app.science.avatar.configuration import Configuration
from app.science.avatar.tuning.heuristics import HEURISTICS
from app.science.avatar.tuning.plant import Pose
from app.science.avatar.tuning.relay import Oscillation, RelaySettings
from app.science.avatar.tuning.step_response import StepFigures

USUAL_HEURISTIC: Final = "critical"
MAX_ATTEMPTS: Final = 10
Phase = Literal["relay", "steps"]


class TuningError(ValueError):
    """A tuning that cannot be done as it was asked for."""


class TuningCancelled(Exception):
    """It was cancelled before it ended; nothing came of it."""


@dataclass(frozen=True)
class TuningOptions:
    """How a tuning is done; nothing in it is drawn by chance.

    Attributes:
        heuristic: a key of `HEURISTICS`.
        mirror: tune the left side, copy its gains to the right.
        attempts: relay experiments per axis at most, each aiming at a lower frequency.
        accepted_overshoot_percent: of the trial's step; more is tried again.
        longest_s: simulated time after which an axis is said not to oscillate.
        longest_wall_s: the same by the clock.
        workers: threads; 1 to 64.

    Raises:
        TuningError: an unknown heuristic, or a number out of range.
    """

    heuristic: str = USUAL_HEURISTIC
    mirror: bool = False
    attempts: int = 3
    accepted_overshoot_percent: float = 5.0
    longest_s: float = 10.0
    longest_wall_s: float = 20.0
    workers: int = 2

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


@dataclass(frozen=True)
class TuningProgress:
    """How far a tuning is: `done` of `total` axes of this attempt's phase; `axis` ended last."""

    attempt: int
    phase: Phase
    axis: str
    done: int
    total: int


@dataclass(frozen=True)
class Experiment:
    """The relay experiment whose gains an axis got.

    Attributes:
        relay: settings it was done with.
        found: what was measured.
        pose: of elbows and knees.
        aimed_hz: natural frequency that the relay was chosen for.
    """

    relay: RelaySettings
    found: Oscillation
    pose: Pose
    aimed_hz: float


@dataclass(frozen=True)
class AxisTuning:
    """One axis.

    Attributes:
        name: of the axis.
        kp, kd: gains it has now, N m/rad and N m s/rad.
        status: `tuned`, `retried`, `locked`, or `flagged: ` and why. What is locked, and what did
            not oscillate, keeps the gains it had.
        note: more about the status.
        attempts: relay experiments on it.
        experiment: behind the gains; None where there is none.
        mirrored_from: the axis it was copied from.
        step: the trial of these gains; None for a locked axis.
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

    @property
    def flagged(self) -> bool:
        """Whether somebody should look at it."""
        return self.status.startswith("flagged")


@dataclass(frozen=True)
class TuningReport:
    """A whole tuning.

    Attributes:
        configuration: the one that was given, with the new gains.
        stature_m: of the body it was tuned on.
        options: how.
        axes: every axis of the configuration, in its order.
        wall_s: how long it took by the clock that was given.
    """

    configuration: Configuration
    stature_m: float
    options: TuningOptions
    axes: tuple[AxisTuning, ...] = field(repr=False)
    wall_s: float
