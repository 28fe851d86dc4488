"""What can be put on record whatever the session is doing: words, questions, corrections, an
erasure.

Once the participant's data are erased nothing is added any more, or they would come back in words.
"""

from app.features.record.sessions.engine import commands as c
from app.features.record.sessions.engine import events as e
from app.features.record.sessions.engine.commands import Refused
from app.features.record.sessions.engine.state import SessionState, SessionStatus


def decide_annotation(state: SessionState, command: c.Command) -> list[e.Event] | None:
    """The events of a command that does not move the session on; None for every other one."""
    if isinstance(command, c.EraseData):
        return _erase(state, command)
    if state.erased:
        raise Refused(
            "the data of this session were erased",
            value="erased",
            valid=[],
            remedy="Nothing can be added to it. Use a new session.",
        )
    match command:
        case c.AddNote(content=content):
            return [e.NoteAdded(**_ref(content))]
        case c.LiftBlinding(content=content):
            return [e.BlindingLifted(**_ref(content))]
        case c.RecordAvatar(configuration_hash=configuration_hash, content=content):
            return [e.AvatarBuilt(configuration_hash=configuration_hash, **_ref(content))]
        case c.OverrideCheck(check=check, content=content):
            return [e.CheckOverridden(check=check, **_ref(content))]
        case c.KeepRefusedForm(submission_id=submission_id, content=content):
            return [e.FormRefused(submission_id=submission_id, **_ref(content))]
        case c.AskQuestion() | c.CloseQuestion():
            return _question(state, command)
        case c.CorrectAnswers(submission_id=submission_id, content=content):
            return [e.AnswersCorrected(submission_id=submission_id, **_ref(content))]
        case _:
            return None


def _question(state: SessionState, command: c.AskQuestion | c.CloseQuestion) -> list[e.Event]:
    """A question while nobody has answered the one before is the same question."""
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
    """A session that has not begun is over with it; one that is running must be ended first."""
    if state.erased:
        return []
    if state.status is SessionStatus.ACTIVE and not command.even_though_active:
        raise Refused(
            "the session is active",
            value=state.status,
            valid=[SessionStatus.COMPLETED, SessionStatus.ABORTED, SessionStatus.WITHDRAWN],
            remedy="Withdraw or abort it first: that stops the recording.",
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
