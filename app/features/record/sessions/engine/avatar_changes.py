"""Decide changes to the running avatar: by the study for a phase, or by the operator.

The changes of a study hold from the preparation of a phase until it ends or is voided. Those of an
operator are added to them, hold until the operator changes them or takes them back, and end with
the session.
"""

from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.commands import Refused
from app.features.record.sessions.engine.state import SessionState
from app.protocol import Step


def changes_of_study(step: Step, state: SessionState) -> list[e.Event]:
    """Return the event of the study's changes for the phase being prepared."""
    if step.avatar_changes is None or step.avatar_changes.is_empty:
        return []
    changes = step.avatar_changes.as_json()
    return [e.AvatarChanged(by="study", changes=changes, phase_id=state.next_phase_id)]


def decide_avatar(
    state: SessionState, command: c.ChangeAvatar | c.ReportAvatarChange
) -> list[e.Event]:
    """Return the event of an operator's change, or of the headset's report on the changes."""
    if isinstance(command, c.ChangeAvatar):
        return _change(state, command)
    return _report(state, command)


def _change(state: SessionState, command: c.ChangeAvatar) -> list[e.Event]:
    """Return the event of an operator's change; none if the same changes are in force already."""
    _require_avatar(state, command)
    before = state.avatar_changes
    if dict(command.changes) == ((before and before.operator) or {}):
        return []
    phase = state.phase
    ref = {} if command.content is None else vars(command.content)
    return [
        e.AvatarChanged(
            by="operator",
            changes=dict(command.changes),
            phase_id=None if phase is None else phase.phase_id,
            deviation=phase is not None,
            **ref,
        )
    ]


def _require_avatar(state: SessionState, command: c.ChangeAvatar) -> None:
    """Refuse a change that could not take effect; taking changes back needs no headset."""
    if not command.is_physics:
        raise Refused(
            "the avatar of this session is a delayed copy, which cannot be changed",
            value="delayed_copy",
            valid=["physics"],
            remedy="Use a version of the study whose avatar is moved by physics.",
        )
    if not state.materialised:
        raise Refused(
            "the avatar has not appeared yet",
            value="not materialised",
            valid=["materialised"],
            remedy="Let the participant enter the body first.",
        )
    if not command.changes:
        return
    if command.headset_can is None:
        raise Refused(
            "no headset is connected, so the avatar cannot be changed",
            value="headset not connected",
            valid=["headset connected"],
            remedy="Wake the headset, or wait until it is connected again.",
        )
    if not command.headset_can:
        raise Refused(
            "the program on the headset cannot change an avatar while it runs",
            value="changes_avatar: false",
            valid=["changes_avatar: true"],
            remedy="Use a program that can, and says so with changes_avatar in its hello message.",
        )


def _report(state: SessionState, command: c.ReportAvatarChange) -> list[e.Event]:
    """Return the event of a headset's report; an unknown revision is refused."""
    changes = state.avatar_changes
    if changes is None or not 1 <= command.revision <= changes.revision:
        raise Refused(
            f"no change of the avatar has the revision {command.revision}",
            value=command.revision,
            valid=[] if changes is None else [changes.revision],
            remedy="Report the revision of the newest state message.",
        )
    ref = {} if command.content is None else vars(command.content)
    return [
        e.AvatarChangeReported(
            revision=command.revision,
            applied=command.applied,
            client_t_s=command.client_t_s,
            **ref,
        )
    ]
