"""Correct an answer: add a new value to the first one, with its reason, and log it.

The event log has a salted hash of the values and the reason; the texts are stored separately, so
that they can be erased.
"""

from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotFound, NotNow
from app.features.people.audit import record
from app.features.record.questionnaires import AnswerValue, correct_answer
from app.features.record.sessions import CorrectAnswers, apply_command, state_of, store_content
from app.models import AnswerCorrection, StudySession, Submission
from app.platform.context import AppContext

CONTENT = "correction"


def correct(
    db: Session,
    context: AppContext,
    session: StudySession,
    submission_id: str,
    *,
    item: str,
    value: AnswerValue,
    reason: str,
    actor: str,
) -> AnswerCorrection:
    """Replace the valid answer to `item` by `value`, or by no answer for None.

    `session` must be locked. Raises NotFound for a form that is not of this session, InvalidInput
    for an impossible answer or without a reason, NotNow if the data were erased.
    """
    submission = db.get(Submission, submission_id)
    if submission is None or submission.session_id != session.id:
        raise NotFound("this session has no such form", value=submission_id)
    if state_of(session).erased:
        raise NotNow("the data of this session were erased", remedy="There is nothing to correct.")
    if not reason.strip():
        raise InvalidInput(
            "a correction needs a reason",
            value=reason,
            valid="1 to 2000 characters",
            remedy="Write in a few words why it is wrong; this becomes part of the record.",
        )
    now = context.clock.utc_now()
    row = correct_answer(
        db, submission, item=item, value=value, reason=reason.strip(), by=actor, now=now
    )
    body = {
        "submission_id": submission.id,
        "item": item,
        "previous": row.previous_number if row.previous_text is None else row.previous_text,
        "value": row.value_number if row.value_text is None else row.value_text,
        "reason": row.reason,
    }
    content = store_content(db, session_id=session.id, kind=CONTENT, body=body, by=actor, now=now)
    command = CorrectAnswers(submission_id=submission.id, content=content)
    apply_command(db, context, session, command, actor=actor)
    record(
        db,
        actor=actor,
        action="answer.corrected",
        subject=f"session:{session.id}",
        details={"submission": submission.id},
        now=now,
    )
    return row
