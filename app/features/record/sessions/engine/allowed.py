"""Determine which commands a session's state allows, so that pages offer only those."""

from collections.abc import Sequence

from app.features.record.sessions.engine.state import PhaseStatus, SessionState, SessionStatus
from app.protocol import TIMED_KINDS, Step


def allowed_commands(
    plan: Sequence[Step], state: SessionState, *, is_physics: bool = False
) -> list[str]:
    """Return the allowed command types in display order, the next action first.

    `is_physics`: whether the session has a physics avatar, which can be changed while it runs.
    """
    allowed = _of_the_session(plan, state)
    is_held = state.held is not None or state.refused_consent is not None
    if state.status is not SessionStatus.ACTIVE or state.erased:
        return allowed
    changeable = ["change_avatar"] if is_physics and state.materialised else []
    return [*allowed, *changeable, *([] if is_held else ["calibrate", "shift_tracker"])]


def _of_the_session(plan: Sequence[Step], state: SessionState) -> list[str]:
    if state.erased:
        return []
    if state.status is SessionStatus.PLANNED:
        return ["start", "note"]
    if state.status is not SessionStatus.ACTIVE or state.current is None:
        return ["note"]
    if state.refused_consent is not None:
        return ["withdraw", "reopen_consent", "abort", "note"]
    if state.held is not None:
        return ["abort", "withdraw", "override_stop", "note"]
    step = plan[state.current]
    allowed = _next_actions(step, state)
    if state.phase is not None or step.kind in TIMED_KINDS or state.current > 0:
        allowed.append("redo")
    return [*allowed, "skip", "note", "abort", "withdraw"]


def _next_actions(step: Step, state: SessionState) -> list[str]:
    phase = state.phase
    if phase is not None:
        if phase.status is PhaseStatus.RUNNING and not phase.pausing:
            return ["pause"]
        if phase.status is PhaseStatus.PAUSED and not phase.resuming:
            return ["resume"]
        return []
    return [step.spec.command]
