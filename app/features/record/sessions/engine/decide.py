"""Decide what may happen next: a command against the state gives events or is rejected."""

from collections.abc import Sequence

from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.annotations import decide_annotation
from app.features.record.sessions.engine.avatar_changes import (
    changes_of_study,
    decide_avatar,
)
from app.features.record.sessions.engine.calibration import (
    decide_calibration,
    pause_running,
)
from app.features.record.sessions.engine.commands import Refused
from app.features.record.sessions.engine.phases import decide_headset_lost, decide_report
from app.features.record.sessions.engine.state import (
    PhaseState,
    PhaseStatus,
    SessionState,
    SessionStatus,
)
from app.protocol import FORM_KINDS, TIMED_KINDS, Step, kinds_with_command

GOES_ON = (c.BeginPhase, c.CompleteStep, c.Materialise, c.Redo, c.Resume, c.Skip)
"""Commands that advance the session; rejected while a stop rule or a refused consent holds it."""

__all__ = ["Refused", "decide"]


def decide(plan: Sequence[Step], state: SessionState, command: c.Command) -> list[e.Event]:
    """Return the events of `command` in `state`; raises Refused if it cannot be carried out now.

    A rejected command changes nothing. Ending the last step also ends the session.
    """
    annotation = decide_annotation(state, command)
    if annotation is not None:
        return annotation
    if isinstance(command, c.Start):
        return _start(state)
    if state.status is not SessionStatus.ACTIVE or state.current is None:
        raise Refused(
            f"the session is {state.status}",
            value=state.status,
            valid=[SessionStatus.ACTIVE],
            remedy="Start the session first."
            if state.status is SessionStatus.PLANNED
            else "It has ended; only notes can be added.",
        )
    require_not_held(state, command)
    match command:
        case c.RefuseConsent() | c.RetractRefusal() | c.OverrideStop():
            return _decide_hold(plan, state, command)
        case c.Report():
            return _then_end(plan, state, _report(plan, state, command))
        case c.ChangeAvatar() | c.ReportAvatarChange() | c.RequestCalibration() | c.ShiftTracker():
            return _decide_headset(state, command)
        case c.HeadsetLost():
            return decide_headset_lost(plan, state, command)
        case c.Redo():
            return _redo(plan, state, command)
        case c.Stop():
            ended = e.SessionEnded(status=command.status, **_ref(command.content))
            return [*_void_running(state, command.status), ended]
        case _:
            return _then_end(plan, state, _decide_step(plan[state.current], state, command))


def _decide_headset(
    state: SessionState,
    command: c.ChangeAvatar | c.ReportAvatarChange | c.RequestCalibration | c.ShiftTracker,
) -> list[e.Event]:
    """Decide what the headset should do with the body besides running phases."""
    if isinstance(command, c.RequestCalibration | c.ShiftTracker):
        return decide_calibration(state, command)
    return decide_avatar(state, command)


def _report(plan: Sequence[Step], state: SessionState, command: c.Report) -> list[e.Event]:
    """Decide a headset's report; if it started a clock against a refusal, also request a pause.

    So it is if a headset resumes although the participant asked to stop after the operator's
    request, which has lapsed: a resumption closes every earlier wish.
    """
    decided = decide_report(plan, state, command)
    starts = isinstance(decided[0], e.PhaseStarted | e.PhaseResumed | e.WalkBackEnded)
    is_refused = starts and state.refused_consent is not None
    is_overrun = state.stop_asked and isinstance(decided[0], e.PhaseResumed)
    if not is_refused and not is_overrun:
        return decided
    return [*decided, e.PauseRequested(phase_id=command.phase_id)]


def _start(state: SessionState) -> list[e.Event]:
    if state.status is not SessionStatus.PLANNED:
        raise Refused(
            f"the session is already {state.status}",
            value=state.status,
            valid=[SessionStatus.PLANNED],
            remedy="Check its current step; somebody else may have started it.",
        )
    return [e.SessionStarted()]


def _decide_step(step: Step, state: SessionState, command: c.Command) -> list[e.Event]:
    match command:
        case c.CompleteStep():
            return _complete(step, command)
        case c.SubmitForm():
            return _submit(step, command)
        case c.Materialise():
            _require_kind(step, kinds_with_command("materialise"), "materialise the avatar")
            _require_headset(
                "no headset could show or record the body", connected=command.headset_connected
            )
            return [
                e.AvatarMaterialised(step=step.index, by=command.by, client_t_s=command.client_t_s)
            ]
        case c.BeginPhase():
            return _begin(step, state, command)
        case c.Pause():
            return _pause(state, command)
        case c.Resume():
            return _resume(state, command)
        case c.Skip():
            skipped = e.StepSkipped(step=step.index, **_ref(command.content))
            return [*_void_running(state, "skip"), skipped]
        case _:
            raise Refused(f"unknown command {type(command).__name__}", value=None, valid=None)


def _complete(step: Step, command: c.CompleteStep) -> list[e.Event]:
    _require_kind(step, kinds_with_command("complete_step"), "mark the step as done")
    if command.step is not None and command.step != step.index:
        raise Refused(
            f"step {command.step} is not the current one",
            value=command.step,
            valid=[step.index],
            remedy="The session has moved on; the page shows the current step.",
        )
    if step.kind == "consent" and command.content is None:
        raise Refused(
            "a consent needs a record of how it was given",
            value=None,
            valid=["the form on the tablet", "a sheet signed on paper"],
            remedy="Let the participant agree on the tablet, or record a consent on paper.",
        )
    ref = _ref(command.content) if command.content else {}
    return [e.StepCompleted(step=step.index, by=command.by, **ref)]


def _submit(step: Step, command: c.SubmitForm) -> list[e.Event]:
    _require_kind(step, FORM_KINDS, "submit a form")
    if command.step != step.index:
        raise Refused(
            f"the form of step {command.step} is not the current one",
            value=command.step,
            valid=[step.index],
            remedy="The answers are kept on the tablet; tell the experimenter.",
        )
    return [
        e.FormSubmitted(
            step=step.index,
            submission_id=command.submission_id,
            content_hash=command.content_hash,
        ),
        *rules_met(command),
    ]


def _begin(step: Step, state: SessionState, command: c.BeginPhase) -> list[e.Event]:
    _require_kind(step, TIMED_KINDS, "begin a phase")
    if state.phase is not None:
        raise Refused(
            f"the phase is already {state.phase.status}",
            value=state.phase.status,
            valid=["no phase in progress"],
            remedy="Somebody else may have started it.",
        )
    _require_headset("no headset could run the phase", connected=command.headset_connected)
    _require_feet(step, tracked=command.feet_tracked)
    prepared = e.PhasePrepared(
        step=step.index,
        phase_id=state.next_phase_id,
        attempt=state.steps[step.index].attempt,
        latency_ms=step.latency_ms or 0.0,
        body=step.body,
    )
    return [prepared, *changes_of_study(step, state)]


def _pause(state: SessionState, command: c.Pause) -> list[e.Event]:
    phase = _require_phase(state, (PhaseStatus.RUNNING,), "pause")
    if phase.pausing:
        return []
    ref = _ref(command.content) if command.content else {}
    return [e.PauseRequested(phase_id=phase.phase_id, **ref)]


def _resume(state: SessionState, command: c.Resume) -> list[e.Event]:
    phase = _require_phase(state, (PhaseStatus.PAUSED,), "resume")
    _require_headset("no headset could run the phase", connected=command.headset_connected)
    if phase.resuming:
        return []
    # Whoever lets the phase continue has spoken to the participant.
    closed = [e.StopClosed(outcome="answered")] if state.stop_asked else []
    return [*closed, e.ResumeRequested(phase_id=phase.phase_id)]


def _redo(plan: Sequence[Step], state: SessionState, command: c.Redo) -> list[e.Event]:
    current = state.current if state.current is not None else 0
    target = current if command.step is None else command.step
    if not 0 <= target <= current:
        raise Refused(
            f"step {target} has not been reached yet",
            value=target,
            valid=list(range(current + 1)),
            remedy="Only the current step or an earlier one can be repeated.",
        )
    if target == current and state.phase is None and plan[target].kind not in TIMED_KINDS:
        raise Refused(
            "the current step has not been done yet",
            value=target,
            valid=list(range(current)),
            remedy="Do it, or choose an earlier step to repeat.",
        )
    voided: list[e.Event] = [
        e.PhaseVoided(phase_id=past.phase_id, cause="redo")
        for past in state.ended_phases
        if past.step >= target and past.status is not PhaseStatus.VOIDED
    ]
    reopened = e.StepReopened(step=target, **_ref(command.content))
    return [*voided, *_void_running(state, "redo"), reopened]


def _void_running(state: SessionState, cause: str) -> list[e.Event]:
    if state.phase is None:
        return []
    return [e.PhaseVoided(phase_id=state.phase.phase_id, cause=cause)]


def _then_end(plan: Sequence[Step], state: SessionState, decided: list[e.Event]) -> list[e.Event]:
    """Append the end of the session if the events complete its last step."""
    leaves = (e.StepCompleted, e.FormSubmitted, e.StepSkipped, e.AvatarMaterialised, e.PhaseEnded)
    last = state.current == len(plan) - 1
    if last and any(isinstance(event, leaves) for event in decided):
        return [*decided, e.SessionEnded(status=SessionStatus.COMPLETED)]
    return decided


def _require_kind(step: Step, kinds: Sequence[str], wish: str) -> None:
    if step.kind not in kinds:
        raise Refused(
            f"cannot {wish} in step {step.key!r}, which is of kind {step.kind!r}",
            value=step.kind,
            valid=list(kinds),
            remedy="Finish or skip the current step first.",
        )


def _require_phase(state: SessionState, statuses: Sequence[PhaseStatus], wish: str) -> PhaseState:
    if state.phase is None or state.phase.status not in statuses:
        status = state.phase.status if state.phase else "no phase in progress"
        raise Refused(
            f"cannot {wish}: {status}",
            value=status,
            valid=list(statuses),
            remedy="The page shows what can be done now.",
        )
    return state.phase


def _require_headset(consequence: str, *, connected: bool) -> None:
    if not connected:
        raise Refused(
            f"no headset is connected, so {consequence}",
            value="headset not connected",
            valid=["headset connected"],
            remedy="Pair or wake the headset, or skip the step with a reason.",
        )


def _require_feet(step: Step, *, tracked: bool | None) -> None:
    if step.limb == "foot" and tracked is False:
        raise Refused(
            "the headset does not measure the participant's feet, so contacts with them would be "
            "guesses",
            value="feet not tracked",
            valid=["feet tracked"],
            remedy="Put trackers on the shins and let the headset calibrate again, or skip the "
            "step. To try it without, continue at the pre-flight check of the feet, with a reason.",
        )


def _ref(content: c.ContentRef) -> dict[str, str]:
    return {"content_id": content.content_id, "content_hash": content.content_hash}


def _decide_hold(
    plan: Sequence[Step],
    state: SessionState,
    command: c.RefuseConsent | c.RetractRefusal | c.OverrideStop,
) -> list[e.Event]:
    """Decide a command that holds a session, or lets it continue."""
    if isinstance(command, c.OverrideStop):
        return decide_override(state, command)
    return _decide_refusal(plan, state, command)


def _decide_refusal(
    plan: Sequence[Step], state: SessionState, command: c.RefuseConsent | c.RetractRefusal
) -> list[e.Event]:
    """Decide a refusal or its retraction; repeating one changes nothing.

    A refusal also requests a pause of a running phase.
    """
    if isinstance(command, c.RetractRefusal):
        return _retract_refusal(state, command)
    if state.refused_consent is not None:
        return []
    reached = plan[: (state.current or 0) + 1]
    consents = [step.index for step in reached if step.kind == "consent"]
    if command.step not in consents:
        raise Refused(
            f"step {command.step} is not a consent that the session has reached",
            value=command.step,
            valid=consents,
            remedy="Tell the experimenter.",
        )
    return [
        e.ConsentRefused(step=command.step, by=command.by),
        *pause_running(state),
    ]


def _retract_refusal(state: SessionState, command: c.RetractRefusal) -> list[e.Event]:
    if state.refused_consent is None:
        if command.content is None:
            return []
        raise Refused(
            "consent was not refused, or the refusal has already been taken back",
            value="not refused",
            valid=["a refused consent"],
            remedy="Continue with the current step.",
        )
    ref = _ref(command.content) if command.content else {}
    return [e.RefusalRetracted(step=state.refused_consent, by=command.by, **ref)]


def require_not_held(state: SessionState, command: c.Command) -> None:
    """Raise Refused if the session is held and `command` would advance it."""
    if state.refused_consent is not None and isinstance(command, (*GOES_ON, c.SubmitForm)):
        raise Refused(
            "the session is held: the participant does not want to take part",
            value=f"consent refused at step {state.refused_consent + 1}",
            valid=["withdraw", "abort", "reopen_consent"],
            remedy="Speak to the participant. Then end the session, or show the consent again if "
            "they have changed their mind.",
        )
    if state.held is not None and isinstance(command, GOES_ON):
        raise Refused(
            "the session is held: an answer met a stop rule of the study",
            value=f"stop rule {state.held.rule + 1}",
            valid=["withdraw", "abort", "override_stop"],
            remedy="See how the participant is. Then end the session, or continue with a reason.",
        )


def decide_override(state: SessionState, command: c.OverrideStop) -> list[e.Event]:
    """Override the stop rule that holds the session; raises Refused if none does."""
    if state.held is None:
        raise Refused(
            "the session is not held by a stop rule",
            value="not held",
            valid=["held by a stop rule"],
            remedy="Somebody else may have decided already; continue with the current step.",
        )
    ref = command.content
    return [e.StopRuleOverridden(content_id=ref.content_id, content_hash=ref.content_hash)]


def rules_met(command: c.SubmitForm) -> list[e.Event]:
    """Return one event for each stop rule that the submitted form meets."""
    return [
        e.StopRuleMet(rule=rule, submission_id=command.submission_id) for rule in command.rules_met
    ]
