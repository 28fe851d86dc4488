"""What a partner of a co-simulation is, and what happens when its answer is late."""

from dataclasses import dataclass
from typing import Literal, Protocol

from app.science.cosimulation.states import CosimulationError, State

Rule = Literal["wait", "extrapolate"]


@dataclass(frozen=True)
class Request:
    """One step that a partner is asked to compute.

    Attributes:
        from_s, to_s: scene time at its beginning and its end.
        others: all actors of other partners at `from_s`, sorted by name.
    """

    from_s: float
    to_s: float
    others: tuple[State, ...]


@dataclass(frozen=True)
class Lateness:
    """What is done about a partner that has not answered in time.

    Attributes:
        rule: `wait` stops the scene's clock until it answers, which changes no state;
            `extrapolate` goes on with its actors' speeds and turn rates.
        patience_s: real time after a step's beginning from which `extrapolate` calls it late.
        at_most_s: scene time that is extrapolated at most; then the clock waits after all.
        give_up_s: real time of waiting after which the partner counts as lost.

    Raises:
        CosimulationError: a time is negative, or give_up_s is not positive.
    """

    rule: Rule = "wait"
    patience_s: float = 0.02
    at_most_s: float = 0.5
    give_up_s: float = 10.0

    def __post_init__(self) -> None:
        """Validate the times."""
        if not (self.patience_s >= 0.0 and self.at_most_s >= 0.0 and self.give_up_s > 0.0):
            raise CosimulationError(
                f"patience_s {self.patience_s}, at_most_s {self.at_most_s} and give_up_s"
                f" {self.give_up_s}: none may be negative, and the last must be positive."
            )


class PartnerLostError(Exception):
    """A partner can no longer be asked; the message says why. The record up to here is kept."""


class SceneOverError(Exception):
    """A partner says that the scene is over: its record ends here, and is complete."""


class Partner(Protocol):
    """A simulation that takes part: a person's path, traffic, or any other process.

    `begin` returns at once where a partner computes elsewhere, so that partners compute at the same
    time; `answer` returns None if there is none within `timeout_s` of real time. Both raise
    PartnerLostError, or SceneOverError.
    """

    @property
    def name(self) -> str:
        """Key of the partner in the scene and in the record."""
        ...

    @property
    def step_s(self) -> float:
        """Its fixed step; a multiple of the scene's."""
        ...

    def start(self) -> tuple[State, ...]:
        """Return its actors at 0 s."""
        ...

    def begin(self, request: Request) -> None:
        """Ask for one step."""
        ...

    def answer(self, timeout_s: float) -> tuple[State, ...] | None:
        """Return its actors at the end of the step it was asked for."""
        ...


class InProcess:
    """A partner that computes at once, in `begin`; subclasses define `start` and `advance`."""

    def __init__(self, name: str, step_s: float) -> None:
        self.name, self.step_s = name, step_s
        self._answer: tuple[State, ...] = ()

    def start(self) -> tuple[State, ...]:
        """Return its actors at 0 s."""
        raise NotImplementedError

    def advance(self, request: Request) -> tuple[State, ...]:
        """Return its actors at the end of the step."""
        raise NotImplementedError

    def begin(self, request: Request) -> None:
        """Compute the step."""
        self._answer = self.advance(request)

    def answer(self, timeout_s: float) -> tuple[State, ...]:
        """Return what `begin` computed; never late."""
        del timeout_s
        return self._answer
