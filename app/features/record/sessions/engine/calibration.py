"""Decide what concerns the participant inside the headset: calibrations, trackers, stopping.

A calibration measures the participant's body anew and loses nothing: the step stays, and a running
phase is paused until the operator resumes it. Between calibrations the operator can shift single
joints by hand; a new calibration starts without shifts. The lab's trackers can be chosen before
the session starts, too, so that they are there when the participant comes.
"""

from dataclasses import asdict
from typing import TypedDict

from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.commands import Refused
from app.features.record.sessions.engine.state import PhaseStatus, SessionState, SessionStatus


def decide_calibration(
    state: SessionState, command: c.RequestCalibration | c.ShiftTracker
) -> list[e.Event]:
    """Return the events of an operator's order; none if it is already in force."""
    _require_headset(command.headset_can)
    before, phase = state.calibration, state.phase
    ref = {} if command.content is None else vars(command.content)
    phase_id = None if phase is None else phase.phase_id
    if isinstance(command, c.RequestCalibration):
        if before is not None and before.wanted:
            return []
        return [e.CalibrationRequested(phase_id=phase_id, **ref), *pause_running(state)]
    if (before.shifts_m if before else {}).get(command.goal, (0.0, 0.0, 0.0)) == command.shift_m:
        return []
    return [
        e.TrackerShifted(
            goal=command.goal,
            shift_m=command.shift_m,
            phase_id=phase_id,
            deviation=phase is not None,
            **ref,
        )
    ]


def decide_participant(state: SessionState, command: c.Command) -> list[e.Event] | None:
    """Return the events of what concerns the participant at any time; None for other commands."""
    match command:
        case c.ReportCalibration():
            return _report(state, command)
        case c.ChooseTrackers():
            return _choose_trackers(state, command)
        case c.ChooseCompanion():
            return _choose_companion(state, command)
        case c.ReportAlignment():
            is_running = state.status in (SessionStatus.PLANNED, SessionStatus.ACTIVE)
            # It may have been computed while the trackers were changed or the session ended.
            return [e.TrackersAligned(**asdict(command))] if is_running and state.trackers else []
        case c.AskToStop():
            if state.status is not SessionStatus.ACTIVE or state.stop_asked:
                return []
            asked = e.StopAsked(
                client_t_s=command.client_t_s,
                step=state.current,
                phase_id=None if state.phase is None else state.phase.phase_id,
            )
            return [asked, *pause_running(state)]
        case c.CloseStop(outcome=outcome):
            return [e.StopClosed(outcome=outcome)] if state.stop_asked else []
        case _:
            return None


def pause_running(state: SessionState) -> list[e.Event]:
    """Request a pause of a running phase, unless one was requested already."""
    phase = state.phase
    if phase is None or phase.status is not PhaseStatus.RUNNING or phase.pausing:
        return []
    return [e.PauseRequested(phase_id=phase.phase_id)]


def _choose_trackers(state: SessionState, command: c.ChooseTrackers) -> list[e.Event]:
    """Return the event of a choice of trackers; none if they are those already in use."""
    _require_open(state, "It has ended, so its headset uses no trackers any more.")
    before = None if state.trackers is None else (state.trackers.door, state.trackers.source)
    wish = None if command.door is None else (command.door, command.source)
    if before == wish:
        return []
    return [e.TrackersChosen(door=command.door, source=command.source, **_at(state))]


def _choose_companion(state: SessionState, command: c.ChooseCompanion) -> list[e.Event]:
    """Return the event of a choice of whom the participant sees; none if it changes nothing."""
    _require_open(state, "It has ended, so its participant sees nobody any more.")
    if state.companion == command.companion:
        return []
    return [e.CompanionChosen(companion=command.companion, **_at(state))]


def _require_open(state: SessionState, remedy: str) -> None:
    if state.status not in (SessionStatus.PLANNED, SessionStatus.ACTIVE):
        raise Refused(
            f"the session is {state.status}",
            value=state.status,
            valid=[SessionStatus.PLANNED, SessionStatus.ACTIVE],
            remedy=remedy,
        )


class _At(TypedDict):
    phase_id: int | None
    deviation: bool


def _at(state: SessionState) -> _At:
    """Return the phase in which something is changed that should not change in one."""
    phase = state.phase
    return {"phase_id": None if phase is None else phase.phase_id, "deviation": phase is not None}


def _report(state: SessionState, command: c.ReportCalibration) -> list[e.Event]:
    """Return the event of a calibration; one that answers an unknown order is refused."""
    known = 0 if state.calibration is None else state.calibration.revision
    if command.revision is not None and command.revision > known:
        raise Refused(
            f"no calibration was ordered with the revision {command.revision}",
            value=command.revision,
            valid=[known] if known else [],
            remedy="Report the revision of the newest state message, or null.",
        )
    return [
        e.CalibrationReported(
            revision=command.revision,
            cause=command.cause,
            client_t_s=command.client_t_s,
            **vars(command.content),
        )
    ]


def _require_headset(headset_can: bool | None) -> None:  # noqa: FBT001 - the command's own field
    if headset_can is None:
        raise Refused(
            "no headset is connected, so it cannot be calibrated",
            value="headset not connected",
            valid=["headset connected"],
            remedy="Wake the headset, or wait until it is connected again.",
        )
    if not headset_can:
        raise Refused(
            "the program on the headset does not calibrate when asked",
            value="calibrates: false",
            valid=["calibrates: true"],
            remedy="Calibrate in that program, or use the page of this server (/vr).",
        )
