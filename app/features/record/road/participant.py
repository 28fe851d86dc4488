"""The participant as a partner of the scene: the headset's socket says, the scene's thread asks."""

import threading
import time
from collections.abc import Callable, Sequence

from app.protocol import PARTICIPANT
from app.science.cosimulation import Request, SceneOverError, State
from app.wire import FloorPlace

BODY_M = 0.5
"""Diameter of a person on the floor, as of the persons of `app.science.cosimulation`."""
LOOK_S = 1.0
"""How often a scene asks whether its phase still goes on, whether it waits or has much to do."""
Send = Callable[[int, tuple[State, ...]], None]


class Participant:
    """Where the participant is, step by step.

    During the warm-up they stand where the headset first said that they are.

    Args:
        step_s: step of the scene.
        warm_up: steps before the phase's clock starts.
        place: where they stand at first.
        time_scale: of the session; above 1 only for simulated ones.
        is_paced: whether a step begins when its time has come, so that a headset can be late; else
            as soon as the headset has said where the participant is.
        is_current: whether the phase still goes on; asked once a second. What it raises if nothing
            more may be recorded goes through the scene.
    """

    name = PARTICIPANT

    def __init__(
        self,
        step_s: float,
        warm_up: int,
        place: FloorPlace,
        *,
        time_scale: float,
        is_paced: bool,
        is_current: Callable[[], bool],
    ) -> None:
        self.step_s = step_s
        self._warm_up, self._place = warm_up, place
        self._time_scale, self._is_paced, self._is_current = time_scale, is_paced, is_current
        self._news = threading.Condition()
        self._places: dict[int, FloorPlace] = {}
        self._next = 0
        self._wanted = 0
        self._is_over = False
        self._asked_s = time.monotonic()
        self._is_running = False
        self._began_s: float | None = None
        self._send: Send | None = None
        self._others: tuple[int, tuple[State, ...]] | None = None

    @property
    def next_step(self) -> int:
        """The first step, counted from the end of the warm-up, of which no place has come."""
        with self._news:
            return self._next

    @property
    def is_heard(self) -> bool:
        """Whether a headset says where the participant is, or may do so at any time."""
        return self._send is not None

    def attach(self, send: Send) -> None:
        """Say to this headset from now on where the others are, beginning with what is known."""
        with self._news:
            self._send, others = send, self._others
        if others is not None and others[0] >= 0:
            send(*others)

    def detach(self, send: Send) -> None:
        """Say nothing more to this headset, and wait for it; nothing changes if another came."""
        with self._news:
            if self._send == send:
                self._send, self._is_running, self._began_s = None, False, None

    def put(self, first_step: int, places: Sequence[FloorPlace]) -> None:
        """Take places from the headset; those that are known already, or too late, are ignored.

        Raises:
            ValueError: places are missing before the first one.
        """
        with self._news:
            if first_step > self._next:
                raise ValueError(f"the place at step {self._next} is missing")
            if self._is_over:
                return
            for step, place in enumerate(places, start=first_step):
                if step >= self._next:
                    self._places[step] = place
                    self._next = step + 1
            if self._is_running and self._next:
                due_s = (self._next - 1) * self.step_s / self._time_scale
                began_s = time.monotonic() - due_s
                self._began_s = began_s if self._began_s is None else min(self._began_s, began_s)
            self._news.notify_all()

    def run_clock(self, *, is_running: bool) -> None:
        """Say whether the phase's clock runs: while it stands, the participant is not late."""
        with self._news:
            self._is_running, self._began_s = is_running, None
            self._news.notify_all()

    def end(self) -> None:
        """Let the scene be over at the first step whose place has not come."""
        with self._news:
            self._is_over = True
            self._news.notify_all()

    def is_over(self) -> bool:
        """Whether the scene is to end; a scene whose partners are not there yet ends at once."""
        self._look()
        return self._is_over

    def pace(self, scene_s: float) -> None:
        """Wait until a step may begin: its place is there, or its time has come."""
        step = round(scene_s / self.step_s) + 1 - self._warm_up
        while self._is_paced and step > 0:
            self._look()
            with self._news:
                if step in self._places or self._is_over:
                    return
                wait_s = LOOK_S
                if self._is_running and self._began_s is not None:
                    due_s = self._began_s + step * self.step_s / self._time_scale
                    wait_s = min(wait_s, due_s - time.monotonic())
                    if wait_s <= 0.0:
                        return
                self._news.wait(wait_s)

    def start(self) -> tuple[State, ...]:
        """Return the participant where they stand at first."""
        return (self._state(-self._warm_up, self._place),)

    def begin(self, request: Request) -> None:
        """Tell the headset where the others are."""
        now = round(request.from_s / self.step_s) - self._warm_up
        with self._news:
            self._wanted = now + 1
            self._others = (now, request.others)
            send = self._send
        if send is not None and now >= 0:
            send(now, request.others)

    def answer(self, timeout_s: float) -> tuple[State, ...] | None:
        """Return where the participant is at the step that was asked for."""
        if self._wanted <= 0:
            if self.is_over() and not self._places:
                raise SceneOverError
            return (self._state(self._wanted, self._place),)
        left_s = timeout_s
        while True:
            self._look()
            with self._news:
                place = self._places.pop(self._wanted, None)
                if place is not None:
                    return (self._state(self._wanted, place),)
                if self._is_over:
                    raise SceneOverError
                if self._is_running and left_s <= 0.0:
                    return None
                asked_s = time.monotonic()
                self._news.wait(min(LOOK_S, left_s) if self._is_running else LOOK_S)
                # A clock that stands makes nobody late.
                left_s -= time.monotonic() - asked_s if self._is_running else 0.0

    def _look(self) -> None:
        """Ask once a second whether the phase goes on; what was said until it ended counts."""
        now_s = time.monotonic()
        if now_s - self._asked_s < LOOK_S or self._is_over:
            return
        self._asked_s = now_s
        if not self._is_current():
            self.end()

    def _state(self, step: int, place: FloorPlace) -> State:
        x_m, y_m, heading_rad, speed_m_s = place
        time_s = round((step + self._warm_up) * self.step_s, 6)
        moving = (x_m, y_m, heading_rad, speed_m_s)
        return State(PARTICIPANT, "person", time_s, *moving, 0.0, BODY_M, BODY_M)
