"""A timed phase on the headset's clock: preparation, active time, freeze, and its reports.

The headset runs the phase by itself and reports each change to the server with its own monotonic
time and the active time so far. The clock is stopped during pauses, during walks back, and while
the connection is lost, so both sides agree on what counts.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from app.science.tasks import ActiveClock, CommandKind
from app.wire import PhaseOrder, PhaseReport, ReportBody

Bools = NDArray[np.bool_]
Touches = Callable[[], tuple[Bools, Bools]]
"""Returns, by surface and joint (S, P), what is touched and what is near enough to keep a touch."""
Awaited = Literal["start", "traffic"]
"""What the clock waits for: that the participant stands at the start, or that cars drive."""


class TimedRun(ABC):
    """One phase from its preparation to the end of its freeze.

    A client that takes over in mid-phase continues with the active time in the order: it waits for
    the operator to resume, since it cannot know where the participant stands.
    """

    def __init__(self, order: PhaseOrder, t_s: float) -> None:
        self.order = order
        self.ended = False
        self._spent_s = order.active_s
        self._begins_s = t_s + order.preparation_s
        self._frozen_until_s: float | None = None
        self._paused = False
        self._takes_over = order.status != "preparing"

    @property
    @abstractmethod
    def clock(self) -> ActiveClock:
        """The active clock of this run, which starts at zero."""

    @abstractmethod
    def command(self, kind: CommandKind, t_s: float) -> None:
        """Start, pause, resume or freeze the clock."""

    @abstractmethod
    def touch(self, t_s: float, touches: Touches) -> None:
        """Process what the avatar touches in one frame."""

    @abstractmethod
    def news(self, t_s: float) -> list[ReportBody]:
        """Return reports of what has happened since the last call."""

    @property
    def clock_runs(self) -> bool:
        """Whether the active clock is running."""
        return self.clock.running_since_s is not None

    @property
    def awaits(self) -> Awaited | None:
        """What the clock waits for before it starts or goes on; None: nothing."""
        return None

    @property
    def ends_early(self) -> bool:
        """Whether the phase ends before its time is up: a practice with its tasks completed."""
        return False

    def active_s(self, t_s: float) -> float:
        """Return the active time at `t_s`, at most the phase's duration."""
        clock = self.clock
        if clock.last_s is None:
            return self._spent_s
        return min(self._spent_s + clock.active_s(max(t_s, clock.last_s)), self.order.duration_s)

    def follow(self, order: PhaseOrder, t_s: float) -> list[ReportBody]:
        """Pause or resume as the operator has ordered, and return the reports.

        `order` must reflect every report of this run: in response to an older one, the run would
        pause again and again.
        """
        self.order = order
        if order.pausing and self.clock_runs:
            return self._pause(t_s, "operator")
        reports: list[ReportBody] = []
        if order.status == "paused" and self.clock_runs:
            # The server lost the connection for a moment too short to be noticed here.
            reports = self._pause(t_s, "disconnected")
        if self._paused and self.clock.active_before_s == 0.0:
            # Taken over, and the earlier run had used more active time than was known then.
            self._spent_s = max(self._spent_s, order.active_s)
        if self._paused and order.status == "running":
            return [self.report("paused", t_s, "restarted")]
        if order.resuming and self._paused and self.awaits is None:
            self._paused = False
            self.command(CommandKind.RESUME, t_s)
            reports += [*self.news(t_s), self.report("resumed", t_s)]
        return reports

    def frame(self, t_s: float, touches: Touches, *, connected: bool) -> list[ReportBody]:
        """Advance by one frame and return its reports.

        `touches` is called while the clock may run.
        """
        if self._takes_over:
            self._takes_over = False
            return self._take_over(t_s)
        if self._frozen_until_s is not None:
            return self._thaw(t_s)
        if not connected:
            self._begins_s = max(self._begins_s, t_s)
            return self._pause(t_s, "disconnected") if self.clock_runs else []
        if self.clock.last_s is None and self.awaits is not None:
            # Whoever has just come to the start gets the whole preparation.
            left_s = self.order.preparation_s if self.awaits == "start" else 0.0
            self._begins_s = max(self._begins_s, t_s + left_s)
            return []
        reports: list[ReportBody] = []
        if self.clock.last_s is None and t_s >= self._begins_s:
            self.command(CommandKind.START, t_s)
            reports.append(self.report("started", t_s))
        end_s = self.clock.reaches_s(self.order.duration_s - self._spent_s)
        if end_s is not None and t_s >= end_s:
            # The phase ends when its time is up, not when the next frame is drawn.
            return [*reports, *self._freeze(max(end_s, self.clock.last_s or end_s))]
        if self.clock.last_s is not None:
            self.touch(t_s, touches)
        reports += self.news(t_s)
        return [*reports, *self._freeze(t_s)] if self.ends_early else reports

    def report(self, what: str, t_s: float, cause: str = "headset") -> PhaseReport:
        """Make a report of this phase's clock."""
        return PhaseReport.model_validate(
            {
                "phase_id": self.order.phase_id,
                "what": what,
                "t_s": t_s,
                "active_s": self.active_s(t_s),
                "cause": cause,
            }
        )

    def _take_over(self, t_s: float) -> list[ReportBody]:
        """Continue where another run of the client was lost, frozen or paused.

        If the server has not noticed the loss yet, `follow` reports the pause.
        """
        if self.order.status == "freezing":
            self._frozen_until_s = t_s + self.order.freeze_s
            return []
        self.command(CommandKind.START, t_s)
        self.command(CommandKind.PAUSE, t_s)
        self._paused = True
        reports: list[ReportBody] = list(self.news(t_s))
        if self.order.status == "walk_back":
            reports.append(self.report("walk_back_ended", t_s))
        return reports

    def _pause(self, t_s: float, cause: str) -> list[ReportBody]:
        self._paused = True
        self.command(CommandKind.PAUSE, t_s)
        return [*self.news(t_s), self.report("paused", t_s, cause)]

    def _freeze(self, t_s: float) -> list[ReportBody]:
        self.command(CommandKind.FREEZE, t_s)
        self._frozen_until_s = t_s + self.order.freeze_s
        return [*self.news(t_s), self.report("time_up", t_s)]

    def _thaw(self, t_s: float) -> list[ReportBody]:
        if self.ended or self._frozen_until_s is None or t_s < self._frozen_until_s:
            return []
        self.ended = True
        return [self.report("ended", t_s)]


class FreeRun(TimedRun):
    """A phase of free movement: a clock, and nothing to touch."""

    def __init__(self, order: PhaseOrder, t_s: float) -> None:
        super().__init__(order, t_s)
        self._clock = ActiveClock()

    @property
    def clock(self) -> ActiveClock:
        """The active clock of this run."""
        return self._clock

    def command(self, kind: CommandKind, t_s: float) -> None:
        """Start, pause, resume or freeze the clock."""
        match kind:
            case CommandKind.START:
                self._clock = self._clock.begin(t_s)
            case CommandKind.RESUME:
                self._clock = self._clock.resume(t_s)
            case _:
                self._clock = self._clock.pause(t_s)

    def touch(self, t_s: float, touches: Touches) -> None:
        """Ignore touches."""

    def news(self, _t_s: float) -> list[ReportBody]:
        """Return an empty list: free movement has nothing to report."""
        return []
