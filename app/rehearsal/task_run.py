"""A hand or foot phase on the headset: apply the task rules to the avatar, and make reports."""

from collections.abc import Sequence
from dataclasses import replace

from app.rehearsal.timed_run import TimedRun, Touches
from app.science.tasks import (
    ActiveClock,
    CommandKind,
    ContactInterval,
    EventKind,
    SurfaceKind,
    TaskEvent,
    TaskRules,
    TaskRun,
    TaskState,
    completions,
)
from app.wire import CompletionReport, ContactReport, PhaseOrder, ReportBody

_EFFECTS = {
    EventKind.PANEL_GREEN: "green",
    EventKind.OUT_OF_ORDER: "out_of_order",
    EventKind.WRONG_PART: "wrong_part",
    EventKind.TARGET_EARLY: "early",
    EventKind.TASK_COMPLETED: "completed",
}


class BoxRun(TimedRun):
    """One phase at the boxes: contact intervals and completions become reports."""

    def __init__(
        self, order: PhaseOrder, rules: TaskRules, parts: Sequence[str], t_s: float
    ) -> None:
        super().__init__(order, t_s)
        self._run = TaskRun(rules, tuple(parts))
        if rules.layout.reverse_after_task and order.completions % 2:
            # An earlier run of the client has already reversed the order.
            state = self._run.state
            self._run.state = replace(state, order=state.order[::-1])
        self._completed_before = order.completions
        self._reported_events = 0
        self._reported_intervals = 0
        self._reported_completions = 0

    @property
    def state(self) -> TaskState:
        """The current state of the task."""
        return self._run.state

    @property
    def clock(self) -> ActiveClock:
        """The active clock of the task rules."""
        return self._run.state.clock

    @property
    def ends_early(self) -> bool:
        """Whether a practice has as many completed tasks as it requires."""
        required = self.order.until_completions
        done = self._completed_before + self._reported_completions
        return required is not None and self.clock_runs and done >= required

    def command(self, kind: CommandKind, t_s: float) -> None:
        """Start, pause, resume or freeze the task."""
        self._run.command(kind, t_s)

    def touch(self, t_s: float, touches: Touches) -> None:
        """Apply the rules to the touches of one frame."""
        touched, near = touches()
        self._run.frame(t_s, touched, near)

    def news(self, _t_s: float) -> list[ReportBody]:
        """Return reports of contacts and walks back that ended or started, and tasks completed."""
        events = self._run.events[self._reported_events :]
        intervals = self._run.intervals[self._reported_intervals :]
        self._reported_events += len(events)
        self._reported_intervals += len(intervals)
        reports: list[ReportBody] = [self._contact(interval) for interval in intervals]
        if any(event.kind is EventKind.TASK_COMPLETED for event in events):
            reports += self._new_completions()
        return [*reports, *self._walks_back(events)]

    def _walks_back(self, events: Sequence[TaskEvent]) -> list[ReportBody]:
        what = {
            EventKind.WALK_BACK_BEGUN: "walk_back_started",
            EventKind.WALK_BACK_ENDED: "walk_back_ended",
        }
        return [
            self.report(what[event.kind], event.time_s) for event in events if event.kind in what
        ]

    def _new_completions(self) -> list[CompletionReport]:
        done = completions(self._run.events)
        new = done[self._reported_completions :]
        self._reported_completions = len(done)
        boxes = {surface.key: surface.box for surface in self.state.rules.layout.surfaces}
        return [
            CompletionReport(
                phase_id=self.order.phase_id,
                number=self._completed_before + one.number,
                t_s=one.completed_s,
                active_s=self._spent_s + one.completed_active_s,
                duration_s=one.duration_s,
                order=tuple(boxes[key] or 0 for key in one.order),
                out_of_order_touches=one.out_of_order,
            )
            for one in new
        ]

    def _contact(self, interval: ContactInterval) -> ContactReport:
        surface = self.state.rules.layout.by_key[interval.surface]
        return ContactReport(
            phase_id=self.order.phase_id,
            surface=surface.key,
            surface_kind=surface.kind.value,
            box=surface.box,
            side=None if surface.side is None else surface.side.value,
            body_part=interval.part,
            begin_s=interval.begin_s,
            end_s=interval.end_s,
            begin_active_s=self._spent_s + interval.begin_active_s,
            end_active_s=self._spent_s + interval.end_active_s,
            effect=self._effect(interval, surface.kind),
        )

    def _effect(self, interval: ContactInterval, kind: SurfaceKind) -> str:
        """Return how the task counted the touch that began the interval."""
        if kind in (SurfaceKind.SIDE, SurfaceKind.START):
            return kind.value
        for event in reversed(self._run.events):
            if event.time_s < interval.begin_s:
                break
            same = event.surface == interval.surface and event.part == interval.part
            if same and event.time_s == interval.begin_s and event.kind in _EFFECTS:
                return _EFFECTS[event.kind]
        return "none"
