"""The record of a co-simulation: every state as the partners saw it, every guess, how it ended."""

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

from app.science.cosimulation.states import State, distance_m

Origin = Literal["said", "between", "guessed"]
"""Whether a partner said a state, or it lies between two that it said, or it was extrapolated."""
VERSION = 1


@dataclass(frozen=True)
class Row:
    """One actor at one step of the scene's clock, as all other partners got it."""

    partner: str
    origin: Origin
    state: State


@dataclass(frozen=True)
class Guess:
    """A state that was extrapolated, and what the partner said of the same time later.

    Attributes:
        partner: whose answer was late.
        said_s: scene time of its last answer, from which it was extrapolated.
        guessed: what the others got.
        came: what it said later; None if the run ended before, or the actor had left.
    """

    partner: str
    said_s: float
    guessed: State
    came: State | None

    @property
    def error_m(self) -> float | None:
        """Distance between guess and truth."""
        return None if self.came is None else distance_m(self.guessed, self.came)


@dataclass(frozen=True)
class Record:
    """A whole run; equal runs have equal bytes, since nothing in it depends on real time.

    Attributes:
        header: what was run: scene, seed, steps of the partners.
        step_s: step of the scene's clock.
        steps: for each step from 0 s on, its rows, sorted by actor.
        guesses: in the order of their times and names.
        lost: why the run ended early; empty if it did not.
    """

    header: Mapping[str, Any]
    step_s: float
    steps: tuple[tuple[Row, ...], ...]
    guesses: tuple[Guess, ...]
    lost: str

    def lines(self) -> Iterator[str]:
        """Yield the record as JSON lines: the header, one line a step, the guesses, the end."""
        yield header_line(self.header, self.step_s)
        for number, rows in enumerate(self.steps):
            yield step_line(number, rows, self.step_s)
        yield from self.last_lines()

    def last_lines(self) -> Iterator[str]:
        """Yield what comes after the steps: the guesses, and the end."""
        for guess in self.guesses:
            came = None if guess.came is None else _values(guess.came)
            told = {"partner": guess.partner, "said_s": guess.said_s, "error_m": guess.error_m}
            yield _line({**told, "guessed": _values(guess.guessed), "came": came})
        yield _line({"ended": "partner lost" if self.lost else "complete", "reason": self.lost})

    @cached_property
    def content(self) -> bytes:
        """All lines as UTF-8."""
        return "".join(self.lines()).encode()

    @property
    def sha256(self) -> str:
        """The hash of the bytes, in hexadecimal digits."""
        return hashlib.sha256(self.content).hexdigest()


def header_line(header: Mapping[str, Any], step_s: float) -> str:
    """Return the first line of a record."""
    return _line({"version": VERSION, "step_s": step_s, **header})


def step_line(number: int, rows: tuple[Row, ...], step_s: float) -> str:
    """Return the line of one step."""
    actors = [{"partner": row.partner, "origin": row.origin, **_values(row.state)} for row in rows]
    return _line({"time_s": time_of(number, step_s), "actors": actors})


def steps_of(lines: Iterable[str]) -> tuple[tuple[Row, ...], ...]:
    """Return the steps of a record's lines, which may break off; all other lines are skipped."""
    steps: list[tuple[Row, ...]] = []
    for line in lines:
        content = json.loads(line)
        if "actors" in content:
            steps.append(tuple(_row(one) for one in content["actors"]))
    return tuple(steps)


def _row(told: dict[str, Any]) -> Row:
    return Row(told.pop("partner"), told.pop("origin"), State(**told))


def time_of(step: int, step_s: float) -> float:
    """Return a step's time, to the microsecond: 29 x 0.02 s is 0.58 s, not 0.5800000000000001."""
    return round(step * step_s, 6)


def _values(state: State) -> dict[str, Any]:
    # As `asdict`, which copies each number and takes ten times as long.
    return dict(vars(state))


def _line(content: dict[str, Any]) -> str:
    return json.dumps(content, ensure_ascii=False, separators=(",", ":"), allow_nan=False) + "\n"
