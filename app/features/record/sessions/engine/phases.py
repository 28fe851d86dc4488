"""Decide what a headset's reports about a phase's clock mean for the session.

The headset runs the phase on its own monotonic clock and reports each change with its active time;
here the report is checked against the state. Active time never runs backwards, and a phase cannot
end before its duration is over; only a practice may, once enough tasks are completed.

When the headset is lost, the server assumes that the clock is paused. What the headset did before
it noticed is still in its journal and arrives first when it reconnects. These reports correct the
assumption; otherwise the two sides would wait for each other forever.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.commands import Refused
from app.features.record.sessions.engine.state import PhaseState, PhaseStatus, SessionState
from app.protocol import Step

FRAME_TOLERANCE_S = 0.05
"""How far the end of a phase may be off its duration: a few frames of the slowest headset."""

ASSUMED_CAUSES = ("headset_lost", "headset_silent", "server_restarted")
"""Causes of pauses that the server assumed, which the headset's own reports may contradict."""

_EXPECTED: dict[str, tuple[PhaseStatus, ...]] = {
    "started": (PhaseStatus.PREPARING,),
    # A pause report may confirm a pause that the server assumed when the headset was lost.
    "paused": (PhaseStatus.RUNNING, PhaseStatus.PAUSED),
    "resumed": (PhaseStatus.PAUSED,),
    "walk_back_started": (PhaseStatus.RUNNING,),
    "walk_back_ended": (PhaseStatus.WALK_BACK,),
    "time_up": (PhaseStatus.RUNNING,),
    "ended": (PhaseStatus.FREEZING,),
}

_BEFORE_THE_LOSS = ("walk_back_started", "time_up")


def decide_report(plan: Sequence[Step], state: SessionState, report: c.Report) -> list[e.Event]:
    """Return the event of a headset's report; raises Refused if it does not fit the state."""
    phase = state.phase
    if phase is None or phase.phase_id != report.phase_id:
        raise Refused(
            f"phase {report.phase_id} is not in progress",
            value=report.phase_id,
            valid=[phase.phase_id] if phase else [],
            remedy="Follow the newest state message.",
        )
    if report.what not in _EXPECTED:
        raise Refused(f"unknown report {report.what!r}", value=report.what, valid=list(_EXPECTED))
    if phase.status not in _EXPECTED[report.what] and not _corrects(phase, report):
        raise Refused(
            f"report {report.what!r} does not fit a phase that is {phase.status}",
            value=phase.status,
            valid=list(_EXPECTED[report.what]),
            remedy="Follow the newest state message.",
        )
    _require_active_time(phase, report, plan[phase.step])
    # A decrease within the tolerance is a rounding error: keep the value that is already known.
    return [_event(replace(report, active_s=max(phase.active_s, report.active_s)), phase)]


def _has_enough(step: Step, report: c.Report) -> bool:
    """Return whether a practice may end early, since it has the completions the study requires."""
    required = step.until_completions
    return required is not None and report.completions >= required


def _corrects(phase: PhaseState, report: c.Report) -> bool:
    """Return whether the report is a late one, from before a pause that the server assumed."""
    assumed = phase.status is PhaseStatus.PAUSED and phase.pause_cause in ASSUMED_CAUSES
    return assumed and report.what in _BEFORE_THE_LOSS


def _event(report: c.Report, phase: PhaseState) -> e.Event:
    match report.what:
        case "started":
            return e.PhaseStarted(phase_id=report.phase_id, client_t_s=report.client_t_s)
        case "paused":
            cause = "operator" if phase.pausing else report.cause
            if phase.status is PhaseStatus.PAUSED and phase.pause_cause is not None:
                cause = phase.pause_cause
            return e.PhasePaused(
                phase_id=report.phase_id,
                active_s=report.active_s,
                client_t_s=report.client_t_s,
                cause=cause,
            )
        case "resumed":
            return _stamped(e.PhaseResumed, report)
        case "walk_back_started":
            return _stamped(e.WalkBackStarted, report)
        case "walk_back_ended":
            return _stamped(e.WalkBackEnded, report)
        case "time_up":
            return _stamped(e.PhaseFrozen, report)
        case _:
            return _stamped(e.PhaseEnded, report)


_Stamped = TypeVar(
    "_Stamped", e.PhaseResumed, e.WalkBackStarted, e.WalkBackEnded, e.PhaseFrozen, e.PhaseEnded
)


def _stamped(event: type[_Stamped], report: c.Report) -> _Stamped:
    return event(phase_id=report.phase_id, active_s=report.active_s, client_t_s=report.client_t_s)


def decide_headset_lost(
    plan: Sequence[Step], state: SessionState, command: c.HeadsetLost
) -> list[e.Event]:
    """Pause a running phase at its last known active time; other phases are left as they are.

    There is no headset that could be sent an error, so an impossible time is limited to the phase's
    duration.
    """
    phase = state.phase
    if phase is None or phase.status is not PhaseStatus.RUNNING:
        return []
    duration_s = plan[phase.step].duration_s or 0.0
    return [
        e.PhasePaused(
            phase_id=phase.phase_id,
            active_s=max(phase.active_s, min(command.active_s, duration_s)),
            cause=command.cause,
        )
    ]


def _require_active_time(phase: PhaseState, report: c.Report, step: Step) -> None:
    duration_s = step.duration_s or 0.0
    low = max(0.0, phase.active_s - 1e-6)
    high = duration_s + FRAME_TOLERANCE_S
    if report.what == "time_up" and not _has_enough(step, report):
        low = max(low, duration_s - FRAME_TOLERANCE_S)
    if report.what == "started":
        high = FRAME_TOLERANCE_S
    if not low <= report.active_s <= high:
        raise Refused(
            f"active time {report.active_s:.3f} s does not fit {report.what!r}",
            value=report.active_s,
            valid=[low, high],
            remedy="Report the phase's active time in seconds: pauses and walk-backs do not count.",
        )
