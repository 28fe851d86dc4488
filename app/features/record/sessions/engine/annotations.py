"""Decide the commands that do not advance the session: notes, questions, corrections, erasure.

They are possible in (almost) any state. Once the participant's data are erased, nothing more can be
added, since a text might contain the data again.
"""

from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.calibration import decide_participant
from app.features.record.sessions.engine.commands import Refused
from app.features.record.sessions.engine.state import SessionState, SessionStatus


def decide_annotation(state: SessionState, command: c.Command) -> list[e.Event] | None:
    """Return the events of a command that does not advance the session; None for other commands."""
    if isinstance(command, c.EraseData):
        return _erase(state, command)
    if state.erased:
        raise Refused(
            "the data of this session were erased",
            value="erased",
            valid=[],
            remedy="Nothing can be added to it. Create a new session.",
        )
    match command:
        case c.AddNote(content=content):
            return [e.NoteAdded(**_ref(content))]
        case c.LiftBlinding(content=content):
            return [e.BlindingLifted(**_ref(content))]
        case c.RecordAvatar(configuration_hash=configuration_hash, content=content, body=body):
            built = e.AvatarBuilt(configuration_hash=configuration_hash, body=body, **_ref(content))
            return [built]
        case c.OverrideCheck(check=check, content=content):
            return [e.CheckOverridden(check=check, **_ref(content))]
        case c.KeepRefusedForm(submission_id=submission_id, content=content):
            return [e.FormRefused(submission_id=submission_id, **_ref(content))]
        case c.AskQuestion() | c.CloseQuestion():
            return _question(state, command)
        case c.CorrectAnswers(submission_id=submission_id, content=content):
            return [e.AnswersCorrected(submission_id=submission_id, **_ref(content))]
        case _:
            return decide_participant(state, command)


def _question(state: SessionState, command: c.AskQuestion | c.CloseQuestion) -> list[e.Event]:
    """Open or close a question; while one is open, asking again adds no event."""
    if isinstance(command, c.CloseQuestion):
        return [e.QuestionClosed(outcome=command.outcome)] if state.question_open else []
    if state.status not in (SessionStatus.PLANNED, SessionStatus.ACTIVE):
        raise Refused(
            f"the session is {state.status}",
            value=state.status,
            valid=[SessionStatus.PLANNED, SessionStatus.ACTIVE],
            remedy="Speak to the experimenter.",
        )
    return [] if state.question_open else [e.QuestionAsked(step=state.current)]


def _erase(state: SessionState, command: c.EraseData) -> list[e.Event]:
    """Erase a session's data: a planned session ends with it, an active one must be ended first."""
    if state.erased:
        return []
    if state.status is SessionStatus.ACTIVE and not command.even_though_active:
        raise Refused(
            "the session is active",
            value=state.status,
            valid=[SessionStatus.COMPLETED, SessionStatus.ABORTED, SessionStatus.WITHDRAWN],
            remedy="Withdraw or abort it first; that stops the recording.",
        )
    erased = e.DataErased(erasure_id=command.erasure_id, reason_code=command.reason_code)
    if state.status not in (SessionStatus.PLANNED, SessionStatus.ACTIVE):
        return [erased]
    voided: list[e.Event] = []
    if state.phase is not None:
        voided = [e.PhaseVoided(phase_id=state.phase.phase_id, cause="withdrawn")]
    return [*voided, e.SessionEnded(status=SessionStatus.WITHDRAWN), erased]


def _ref(content: c.ContentRef) -> dict[str, str]:
    return {"content_id": content.content_id, "content_hash": content.content_hash}
