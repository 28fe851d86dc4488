"""The master clock: lets all partners of a scene advance, step by step.

At each step of the scene's clock, every partner that is due gets the states of all others at that
time and computes its own next step; nobody sees what others compute in the same step (the parallel,
or Jacobi, scheme). So the order of arrival has no effect, and a slow partner that is waited for
gives the same record as a fast one. Between two answers of a partner with longer steps the others
get interpolated states, which it had computed without knowing of them.

A late partner that is extrapolated gets every step that it missed afterwards, with the states of
that time, as the others saw them. What it says then is compared with what was guessed; the record
keeps both, and nothing in it is changed afterwards.

Source of the scheme: Kübler and Schiehlen (2000), "Two methods of simulator coupling".
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from app.science.cosimulation.partners import (
    Lateness,
    Partner,
    PartnerLostError,
    Request,
    SceneOverError,
)
from app.science.cosimulation.record import Guess, Record, Row, time_of
from app.science.cosimulation.states import (
    CosimulationError,
    State,
    extrapolated,
    interpolated,
    sorted_by_name,
)

_TOLERANCE_S = 1e-6


@dataclass(frozen=True)
class Timing:
    """How long a run really took; no part of the record.

    Attributes:
        steps_s: real time of every step, including the waiting.
        waited_s: real time that each partner was waited for.
    """

    steps_s: tuple[float, ...]
    waited_s: Mapping[str, float]


@dataclass(frozen=True)
class Clocks:
    """Real time, as arguments.

    Attributes:
        now_s: a monotonic clock.
        pace: called before each step with its scene time; returns when it may begin.
    """

    now_s: Callable[[], float]
    pace: Callable[[float], None] = lambda _: None


Noted = Callable[[int, tuple[Row, ...]], None]
"""Called with the number of a step and all its rows as soon as it is part of the record."""


@dataclass(eq=False)
class _Course:
    """One partner during a run.

    Attributes:
        said: its actors at the last two times at which it said them, by name.
        said_from, said_to: these times, in steps of the scene.
        busy: whether it was asked and has not answered.
        open_guesses: guesses that wait for what it will say, by step.
    """

    partner: Partner
    lateness: Lateness
    stride: int
    said: tuple[dict[str, State], dict[str, State]]
    said_from: int = 0
    said_to: int = 0
    busy: bool = False
    waited_s: float = 0.0
    open_guesses: dict[int, list[Guess]] = field(default_factory=dict)


class Conductor:
    """Runs one scene once.

    Args:
        partners: in a fixed order, each with what is done when it is late.
        step_s: step of the scene's clock, whole microseconds.
        clocks: real time.

    Raises:
        CosimulationError: a step is not a multiple of the scene's, or two partners have one name.
    """

    def __init__(
        self, partners: Sequence[tuple[Partner, Lateness]], step_s: float, clocks: Clocks
    ) -> None:
        names = [partner.name for partner, _ in partners]
        if twice := {name for name in names if names.count(name) > 1}:
            raise CosimulationError(f"Two partners are called {sorted(twice)[0]!r}.")
        self._step_s, self._clocks = step_s, clocks
        self._courses = [
            _Course(partner, lateness, _stride(partner, step_s), ({}, {}))
            for partner, lateness in partners
        ]
        self._steps: list[tuple[Row, ...]] = []
        self._guesses: list[Guess] = []
        self._took_s: list[float] = []

    def run(
        self, steps: int, header: Mapping[str, Any], noted: Noted = lambda _, __: None
    ) -> tuple[Record, Timing]:
        """Advance all partners by a number of steps, until one is lost or says that it is over.

        What is found to be invalid in the middle of a run ends it as a lost partner does, so that
        the record until then is kept.

        Raises:
            CosimulationError: the scene is invalid from its beginning, such as two partners with an
                actor of the same name; nothing is recorded.
        """
        lost = ""
        try:
            for course in self._courses:
                self._accept(course, course.partner.start(), 0)
            self._note(0)
            noted(0, self._steps[0])
            for step in range(steps):
                self._clocks.pace(self._time(step))
                began_s = self._clocks.now_s()
                self._advance(step, began_s)
                noted(step + 1, self._steps[-1])
                self._took_s.append(self._clocks.now_s() - began_s)
        except CosimulationError as error:
            if not self._steps:
                raise
            lost = str(error)
        except PartnerLostError as error:
            lost = str(error)
        except SceneOverError:
            pass  # as complete as one of all steps
        return self._finished(header, lost)

    def _finished(self, header: Mapping[str, Any], lost: str) -> tuple[Record, Timing]:
        for course in self._courses:
            for step, guesses in course.open_guesses.items():
                if step < len(self._steps):  # else its step broke off, and is no part of the record
                    self._guesses.extend(guesses)
        guesses = sorted(self._guesses, key=lambda one: (one.guessed.time_s, one.guessed.name))
        record = Record(dict(header), self._step_s, tuple(self._steps), tuple(guesses), lost)
        waited = {course.partner.name: course.waited_s for course in self._courses}
        return record, Timing(tuple(self._took_s), waited)

    def _advance(self, step: int, began_s: float) -> None:
        for course in self._courses:
            if course.said_to == step and not course.busy:
                self._ask(course)
        for course in self._courses:
            self._settle(course, step + 1, began_s)
        self._note(step + 1)

    def _ask(self, course: _Course) -> None:
        step = course.said_to
        others = [row.state for row in self._steps[step] if row.partner != course.partner.name]
        request = Request(
            self._time(step), self._time(step + course.stride), sorted_by_name(others)
        )
        course.partner.begin(request)
        course.busy = True

    def _settle(self, course: _Course, until: int, began_s: float) -> None:
        """Get a partner's answers up to a step, or leave the rest to be extrapolated."""
        while course.said_to < until:
            if not course.busy:
                self._ask(course)
            answer = self._answer(course, until, began_s)
            if answer is None:
                return
            course.busy = False
            self._accept(course, answer, course.said_to + course.stride)

    def _answer(self, course: _Course, until: int, began_s: float) -> tuple[State, ...] | None:
        rule, asked_s = course.lateness, self._clocks.now_s()
        guessed_s = self._time(until) - self._time(course.said_to)
        # Actors that are not there yet cannot be extrapolated, but nothing is lost by that.
        may_guess = rule.rule == "extrapolate" and guessed_s <= rule.at_most_s + _TOLERANCE_S
        timeout_s = max(0.0, began_s + rule.patience_s - asked_s) if may_guess else rule.give_up_s
        answer = course.partner.answer(timeout_s)
        course.waited_s += self._clocks.now_s() - asked_s
        if answer is None and not may_guess:
            raise PartnerLostError(
                f"{course.partner.name!r} did not answer for {rule.give_up_s:g} s; its last state"
                f" is of {self._time(course.said_to):g} s."
            )
        return answer

    def _accept(self, course: _Course, answer: tuple[State, ...], step: int) -> None:
        """Take over what a partner said, and compare it with what was guessed."""
        time_s, name = self._time(step), course.partner.name
        said: dict[str, State] = {}
        for state in answer:
            if abs(state.time_s - time_s) > _TOLERANCE_S:
                raise PartnerLostError(
                    f"{name!r} said where {state.name!r} is at {state.time_s:g} s; it was asked for"
                    f" {time_s:g} s."
                )
            if state.name in said:
                raise PartnerLostError(f"{name!r} said twice where {state.name!r} is.")
            said[state.name] = state
        course.said = (course.said[1], said)
        course.said_from, course.said_to = course.said_to, step
        for at in [at for at in course.open_guesses if at <= step]:
            truth = {state.name: state for _, state in self._said_at(course, at)}
            for guess in course.open_guesses.pop(at):
                came = truth.get(guess.guessed.name)
                self._guesses.append(Guess(name, guess.said_s, guess.guessed, came))

    def _note(self, step: int) -> None:
        """Add a step to the record: all actors, as the partners will get them."""
        rows: dict[str, Row] = {}
        for course in self._courses:
            name = course.partner.name
            if course.said_to >= step:
                found = [Row(name, origin, state) for origin, state in self._said_at(course, step)]
            else:
                found = [Row(name, "guessed", state) for state in self._guess(course, step)]
            for row in found:
                if row.state.name in rows:
                    both = f"{rows[row.state.name].partner!r} and {name!r}"
                    raise CosimulationError(f"{both} both have an actor {row.state.name!r}.")
                rows[row.state.name] = row
        self._steps.append(tuple(rows[name] for name in sorted(rows)))

    def _said_at(self, course: _Course, step: int) -> list[tuple[Any, State]]:
        """Return the actors of a step that lies within the partner's last step."""
        earlier, later = course.said
        if step == course.said_to:
            return [("said", state) for state in later.values()]
        time_s = self._time(step)
        return [
            (
                "between",
                interpolated(state, later[name], time_s)
                if name in later
                else extrapolated(state, time_s),
            )
            for name, state in earlier.items()
        ]

    def _guess(self, course: _Course, step: int) -> list[State]:
        time_s, said_s = self._time(step), self._time(course.said_to)
        states = [extrapolated(state, time_s) for state in course.said[1].values()]
        name = course.partner.name
        course.open_guesses[step] = [Guess(name, said_s, state, None) for state in states]
        return states

    def _time(self, step: int) -> float:
        return time_of(step, self._step_s)


def _stride(partner: Partner, step_s: float) -> int:
    """Return a partner's step as a number of the scene's steps."""
    stride = round(partner.step_s / step_s)
    if stride < 1 or abs(stride * step_s - partner.step_s) > _TOLERANCE_S:
        raise CosimulationError(
            f"{partner.name!r} has a step of {partner.step_s:g} s; it must be a multiple of the"
            f" scene's, {step_s:g} s."
        )
    return stride
