"""Options, progress and results of a tuning, axis by axis."""

from dataclasses import dataclass, field
from typing import Final, Literal

from app.science.avatar.configuration import Configuration
from app.science.avatar.tuning.heuristics import HEURISTICS
from app.science.avatar.tuning.plant import Pose
from app.science.avatar.tuning.relay import Oscillation, RelaySettings
from app.science.avatar.tuning.step_response import StepFigures

DEFAULT_HEURISTIC: Final = "critical"
MAX_ATTEMPTS: Final = 10
Phase = Literal["relay", "steps"]


class TuningError(ValueError):
    """A tuning is impossible with the given options or movement."""


class TuningCancelled(Exception):
    """The tuning was cancelled before it ended; there is no result."""


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

    Raises:
        TuningError: an unknown heuristic, or a number out of range.
    """

    heuristic: str = DEFAULT_HEURISTIC
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
        relay: the settings of the experiment.
        found: the oscillation that was measured.
        pose: the pose of elbows and knees.
        aimed_hz: natural frequency that the relay was chosen for.
    """

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
        status: `tuned`, `retried`, `locked`, or `flagged: ` and the reason. An axis that is locked
            or did not oscillate keeps its previous gains.
        note: further information about the status.
        attempts: number of relay experiments on it.
        experiment: the one that gave the gains; None if there was none.
        mirrored_from: the axis whose gains were copied.
        step: the step response with these gains; None for a locked axis.
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
