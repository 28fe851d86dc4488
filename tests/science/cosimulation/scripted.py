"""Partners with scripted movements and answers that come late, on a clock that the test sets."""

import threading
import time
from collections.abc import Callable

import numpy as np

from app.science.cosimulation import Clocks, InProcess, Request, State
from app.science.rotations import FloatArray

Movement = Callable[[float], tuple[float, float, float, float]]
"""From scene time to x, y, speed and turn rate; the heading is that of the turn rate from 0."""


def state(name: str, time_s: float, move: Movement) -> State:
    """Return a person's state in a scripted movement."""
    x_m, y_m, speed, turn = move(time_s)
    return State(name, "person", time_s, x_m, y_m, turn * time_s, speed, turn, 0.5, 0.5)


def straight(time_s: float) -> tuple[float, float, float, float]:
    """Walk along x at 1.5 m/s."""
    return 1.5 * time_s, 0.0, 1.5, 0.0


class Scripted(InProcess):
    """Moves as scripted and keeps what it was asked."""

    def __init__(self, name: str, move: Movement, step_s: float = 0.02) -> None:
        super().__init__(name, step_s)
        self.asked: list[Request] = []
        self._move = move

    def start(self) -> tuple[State, ...]:
        """Say the state at 0 s."""
        return (state(self.name, 0.0, self._move),)

    def advance(self, request: Request) -> tuple[State, ...]:
        """Say the scripted state."""
        self.asked.append(request)
        return (state(self.name, request.to_s, self._move),)


class Follower(InProcess):
    """Moves by what it is told of others, so that any difference in it shows in the record."""

    def start(self) -> tuple[State, ...]:
        """Stand at the origin."""
        self._x_m = 0.0
        return (self._state(0.0),)

    def advance(self, request: Request) -> tuple[State, ...]:
        """Go a part of the way to everybody."""
        self._x_m += sum(0.01 * (other.x_m - self._x_m) for other in request.others)
        return (self._state(request.to_s),)

    def _state(self, time_s: float) -> State:
        return State(self.name, "person", time_s, self._x_m, 1.0, 0.0, 0.0, 0.0, 0.5, 0.5)


class TestClock:
    """A clock that only partners advance, by waiting."""

    __test__ = False

    def __init__(self) -> None:
        self.now_s = 0.0

    def clocks(self) -> Clocks:
        """Return it as the conductor's clocks; a step begins 20 ms after the one before."""

        def pace(scene_s: float) -> None:
            self.now_s = max(self.now_s, scene_s)

        return Clocks(lambda: self.now_s, pace)


class Late:
    """Answers each request of a partner after a scripted real time; infinity is never."""

    def __init__(self, inner: Scripted, clock: TestClock, delays_s: dict[int, float]) -> None:
        self.name, self.step_s = inner.name, inner.step_s
        self._inner, self._clock, self._delays_s, self._ready_s = inner, clock, delays_s, 0.0

    def start(self) -> tuple[State, ...]:
        """Start the partner, in time."""
        return self._inner.start()

    def begin(self, request: Request) -> None:
        """Compute, but keep the answer back."""
        self._inner.begin(request)
        self._ready_s = self._clock.now_s + self._delays_s.get(len(self._inner.asked), 0.0)

    def answer(self, timeout_s: float) -> tuple[State, ...] | None:
        """Return the answer if its time comes before the timeout."""
        until = self._clock.now_s + timeout_s
        if self._ready_s > until:
            self._clock.now_s = until
            return None
        self._clock.now_s = max(self._clock.now_s, self._ready_s)
        return self._inner.answer(timeout_s)


class Threaded:
    """Lets a partner compute in a thread of its own, after random real delays."""

    def __init__(self, inner: InProcess, delays_s: FloatArray) -> None:
        self.name, self.step_s = inner.name, inner.step_s
        self._inner, self._delays_s = inner, iter(delays_s)
        self._done = threading.Event()

    def start(self) -> tuple[State, ...]:
        """Start the inner partner."""
        return self._inner.start()

    def begin(self, request: Request) -> None:
        """Compute in a thread."""
        self._done.clear()
        threading.Thread(target=self._compute, args=(request,)).start()

    def _compute(self, request: Request) -> None:
        time.sleep(float(next(self._delays_s, 0.0)))
        self._inner.begin(request)
        self._done.set()

    def answer(self, timeout_s: float) -> tuple[State, ...] | None:
        """Wait for the thread."""
        return self._inner.answer(0.0) if self._done.wait(timeout_s) else None


def delays(seed: int, count: int) -> FloatArray:
    """Return delays of up to 3 ms, most of them none."""
    rng = np.random.default_rng(seed)
    return np.where(rng.random(count) < 0.2, rng.random(count) * 0.003, 0.0)
