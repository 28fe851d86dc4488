"""A session that a stop rule holds: what waits until the operator has decided.

Nothing may move the participant on. What has happened is still recorded: forms and the headset's
reports come in, notes can be written, and the session can be ended at any moment.
"""

from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.commands import Refused
from app.features.record.sessions.engine.state import SessionState

GOES_ON = (c.BeginPhase, c.CompleteStep, c.Materialise, c.Redo, c.Resume, c.Skip)


def require_not_held(state: SessionState, command: c.Command) -> None:
    """Raise Refused where `command` would move on a session that is held."""
    if state.held is not None and isinstance(command, GOES_ON):
        raise Refused(
            "the session is held: an answer met a stop rule of the study",
            value=f"stop rule {state.held.rule + 1}",
            valid=["withdraw", "abort", "override_stop"],
            remedy="See how the participant is. Then end the session, or go on with a reason.",
        )


def decide_override(state: SessionState, command: c.OverrideStop) -> list[e.Event]:
    """Going on although the rule was met; raises Refused where nothing is held."""
    if state.held is None:
        raise Refused(
            "no stop rule holds the session",
            value="not held",
            valid=["held by a stop rule"],
            remedy="Somebody else may have decided already; go on with the current step.",
        )
    ref = command.content
    return [e.StopRuleOverridden(content_id=ref.content_id, content_hash=ref.content_hash)]


def rules_met(command: c.SubmitForm) -> list[e.Event]:
    """One event for each rule that the form meets."""
    return [
        e.StopRuleMet(rule=rule, submission_id=command.submission_id) for rule in command.rules_met
    ]
