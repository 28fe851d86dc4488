"""Compute the state after an event; defined for every event, so that any log can be folded."""

from dataclasses import replace

from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.state import (
    AvatarChangesState,
    CalibrationState,
    Hold,
    PhaseState,
    PhaseStatus,
    SessionState,
    SessionStatus,
    StepState,
    StepStatus,
    TrackersState,
)


def initial_state(step_count: int) -> SessionState:
    """Return the state of a session that was created and not started."""
    return SessionState(
        version=0,
        status=SessionStatus.PLANNED,
        steps=tuple(StepState() for _ in range(step_count)),
    )


def evolve(state: SessionState, event: e.Event) -> SessionState:
    """Return the state after `event`."""
    return replace(_applied(state, event), version=state.version + 1)


def _applied(state: SessionState, event: e.Event) -> SessionState:
    match event:
        case e.SessionStarted():
            return _enter(replace(state, status=SessionStatus.ACTIVE), 0)
        case e.StepCompleted(step=step) | e.FormSubmitted(step=step):
            return _leave(state, step, StepStatus.DONE)
        case e.AvatarMaterialised(step=step):
            return replace(_leave(state, step, StepStatus.DONE), materialised=True)
        case e.StepSkipped(step=step):
            return _leave(state, step, StepStatus.SKIPPED)
        case e.StepReopened(step=step):
            return _reopen(state, step)
        case e.PhaseEnded():
            return _end_phase(state, event)
        case e.PhaseVoided():
            return _void_phase(state, event)
        case e.SessionEnded(status=status):
            return replace(
                state,
                status=SessionStatus(status),
                current=None,
                held=None,
                question_open=False,
                avatar_changes=None,
                calibration=None,
                stop_asked=False,
                trackers=None,
                companion=None,
            )
        case _ if isinstance(event, MARKS):
            return _marked(state, event)
        case _:
            return replace(state, phase=_clocked(state.phase, event))


MARKS = (
    e.StopRuleMet,
    e.StopRuleOverridden,
    e.ConsentRefused,
    e.RefusalRetracted,
    e.QuestionAsked,
    e.QuestionClosed,
    e.AvatarChanged,
    e.AvatarChangeReported,
    e.CalibrationRequested,
    e.TrackerShifted,
    e.CalibrationReported,
    e.TrackersChosen,
    e.CompanionChosen,
    e.StopAsked,
    e.StopClosed,
    e.DataErased,
)


def _marked(state: SessionState, event: e.Event) -> SessionState:
    """Apply an event that does not advance the session, such as a hold, a question, an erasure."""
    match event:
        case e.StopRuleMet(rule=rule, submission_id=submission_id):
            # If one form meets several rules, the first one holds the session.
            return replace(state, held=state.held or Hold(rule, submission_id))
        case e.StopRuleOverridden():
            return replace(state, held=None)
        case e.ConsentRefused(step=step):
            return replace(state, refused_consent=step)
        case e.RefusalRetracted():
            return replace(state, refused_consent=None)
        case e.QuestionAsked() | e.QuestionClosed():
            return replace(state, question_open=isinstance(event, e.QuestionAsked))
        case e.AvatarChanged() | e.AvatarChangeReported():
            return replace(state, avatar_changes=_avatar_changed(state, event))
        case e.CalibrationRequested() | e.TrackerShifted() | e.CalibrationReported():
            return replace(state, calibration=_calibration(state, event))
        case e.TrackersChosen() | e.CompanionChosen():
            return _chosen(state, event)
        case e.StopAsked() | e.StopClosed():
            return _stop_wish(state, is_open=isinstance(event, e.StopAsked))
        case _:
            return replace(state, erased=True)


def _chosen(state: SessionState, event: e.TrackersChosen | e.CompanionChosen) -> SessionState:
    """Take what somebody chose of the doors: the headset's trackers, or whom it shows."""
    if isinstance(event, e.CompanionChosen):
        return replace(state, companion=event.companion)
    door, source = event.door, event.source
    trackers = None if door is None or source is None else TrackersState(door, source)
    return replace(state, trackers=trackers)


def _stop_wish(state: SessionState, *, is_open: bool) -> SessionState:
    """Open or close the participant's wish to stop.

    A request to resume that the headset has not confirmed yet lapses: whoever made it did not know
    of the wish.
    """
    phase = state.phase
    if is_open and phase is not None:
        phase = replace(phase, resuming=False)
    return replace(state, stop_asked=is_open, phase=phase)


def _avatar_changed(
    state: SessionState, event: e.AvatarChanged | e.AvatarChangeReported
) -> AvatarChangesState | None:
    """Apply a change of the avatar, or the headset's report on one."""
    before = state.avatar_changes
    if isinstance(event, e.AvatarChanged):
        new = replace(before or AvatarChangesState(0), revision=state.version + 1)
        if event.by == "study":
            return replace(new, study=event.changes or None)
        return replace(new, operator=event.changes or None)
    if before is None or event.revision != before.revision:
        return before
    return replace(
        before, reported=event.revision, applied=event.applied, content_id=event.content_id
    )


def _calibration(
    state: SessionState, event: e.CalibrationRequested | e.TrackerShifted | e.CalibrationReported
) -> CalibrationState | None:
    """Apply an order about the calibration, or a calibration that the headset has completed."""
    before, revision = state.calibration, state.version + 1
    match event:
        case e.CalibrationRequested():
            new = before or CalibrationState(revision)
            return replace(new, revision=revision, asked=revision)
        case e.TrackerShifted(goal=goal, shift_m=shift_m):
            new = before or CalibrationState(revision)
            shifts_m = {**new.shifts_m, goal: shift_m}
            return replace(new, revision=revision, shifts_m=shifts_m)
    if before is None or state.status is not SessionStatus.ACTIVE:
        return before
    # A calibration that was begun before the request does not answer it.
    is_answer = before.asked is not None and (event.revision or 0) >= before.asked
    return CalibrationState(revision, None if is_answer else before.asked)


def _without_study_changes(state: SessionState) -> SessionState:
    """End the changes that the study makes for a phase, which has ended or was voided."""
    changes = state.avatar_changes
    if changes is None or changes.study is None:
        return state
    ended = replace(changes, study=None, revision=state.version + 1)
    return replace(state, avatar_changes=ended)


def _clocked(phase: PhaseState | None, event: e.Event) -> PhaseState | None:
    """Apply an event of the phase's clock to the phase."""
    if isinstance(event, e.PhasePrepared):
        return PhaseState(event.phase_id, event.step, event.attempt, PhaseStatus.PREPARING)
    if phase is None:
        return None
    match event:
        case e.PhaseStarted():
            return replace(phase, status=PhaseStatus.RUNNING)
        case e.PauseRequested():
            return replace(phase, pausing=True)
        case e.PhasePaused(active_s=active_s, cause=cause):
            return replace(
                phase,
                status=PhaseStatus.PAUSED,
                active_s=active_s,
                pausing=False,
                # The report of a pause that is known already takes nothing back: the operator's
                # request to resume is newer than it.
                resuming=phase.resuming and phase.status is PhaseStatus.PAUSED,
                pause_cause=cause,
            )
        case e.ResumeRequested():
            return replace(phase, resuming=True)
        case e.PhaseResumed(active_s=active_s) | e.WalkBackEnded(active_s=active_s):
            return _running(phase, active_s)
        case e.WalkBackStarted(active_s=active_s):
            # A pending resume request lapses, because the walk back ends without one.
            return replace(
                phase,
                status=PhaseStatus.WALK_BACK,
                active_s=active_s,
                resuming=False,
                pause_cause=None,
            )
        case e.PhaseFrozen(active_s=active_s):
            return replace(
                phase, status=PhaseStatus.FREEZING, active_s=active_s, pausing=False, resuming=False
            )
        case _:
            return phase


def _running(phase: PhaseState, active_s: float) -> PhaseState:
    return replace(
        phase, status=PhaseStatus.RUNNING, active_s=active_s, resuming=False, pause_cause=None
    )


def _end_phase(state: SessionState, event: e.PhaseEnded) -> SessionState:
    phase = state.phase
    if phase is None:
        return state
    ended = replace(phase, status=PhaseStatus.DONE, active_s=event.active_s)
    left = _leave(_without_study_changes(state), phase.step, StepStatus.DONE)
    return replace(left, phase=None, ended_phases=(*state.ended_phases, ended))


def _void_phase(state: SessionState, event: e.PhaseVoided) -> SessionState:
    if state.phase is not None and state.phase.phase_id == event.phase_id:
        voided = replace(
            state.phase,
            status=PhaseStatus.VOIDED,
            active_s=state.phase.active_s if event.active_s is None else event.active_s,
            pausing=False,
            resuming=False,
        )
        left = _without_study_changes(state)
        return replace(left, phase=None, ended_phases=(*state.ended_phases, voided))
    return replace(
        state,
        ended_phases=tuple(
            replace(past, status=PhaseStatus.VOIDED) if past.phase_id == event.phase_id else past
            for past in state.ended_phases
        ),
    )


def _leave(state: SessionState, step: int, status: StepStatus) -> SessionState:
    left = _with_step(state, step, replace(state.steps[step], status=status))
    return _enter(left, step + 1)


def _enter(state: SessionState, step: int) -> SessionState:
    if step >= len(state.steps):
        return replace(state, current=None)
    entered = replace(state.steps[step], status=StepStatus.CURRENT)
    return replace(_with_step(state, step, entered), current=step)


def _reopen(state: SessionState, step: int) -> SessionState:
    last = state.current if state.current is not None else len(state.steps) - 1
    steps = tuple(
        StepState(StepStatus.PENDING, past.attempt + 1) if step <= index <= last else past
        for index, past in enumerate(state.steps)
    )
    return _enter(replace(state, steps=steps), step)


def _with_step(state: SessionState, step: int, value: StepState) -> SessionState:
    return replace(state, steps=(*state.steps[:step], value, *state.steps[step + 1 :]))
