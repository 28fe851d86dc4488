"""Answers that came too late or twice: refused, and kept for the record."""

import hashlib
from typing import NoReturn

from sqlalchemy.orm import Session

from app.errors import KeptConflict
from app.features.record.questionnaires.schemas import SubmissionRequest
from app.features.record.sessions import (
    KeepRefusedForm,
    apply_command,
    canonical,
    content_body,
    contents_of,
    store_content,
)
from app.models import StudySession, Submission
from app.platform.context import AppContext

CONTENT = "refused_form"


def request_hash(request: SubmissionRequest) -> str:
    """What makes two requests the same: the form and its answers, not when they were sent."""
    covered = canonical([request.administration, request.answers, request.shown_order])
    return hashlib.sha256(covered.encode()).hexdigest()


def keep_refused(
    db: Session,
    context: AppContext,
    session: StudySession,
    request: SubmissionRequest,
    *,
    stands: Submission,
    actor: str,
) -> NoReturn:
    """Keep answers that differ from the stored ones, once however often they come, and refuse them.

    Raises KeptConflict, with which this transaction is committed.
    """
    hash_ = request_hash(request)
    if hash_ not in (stands.request_hash, *_known(db, session)):
        body = {
            "request_hash": hash_,
            "idempotency_key": request.idempotency_key,
            "administration": request.administration,
            "answers": dict(request.answers),
        }
        now = context.clock.utc_now()
        content = store_content(
            db, session_id=session.id, kind=CONTENT, body=body, by=actor, now=now
        )
        kept = KeepRefusedForm(submission_id=stands.id, content=content)
        apply_command(db, context, session, kept, actor=actor)
    raise KeptConflict(
        "other answers to this form are stored already",
        value=request.administration,
        remedy="The first answers stand; these were kept beside them. The experimenter can open "
        "the form again.",
    )


def _known(db: Session, session: StudySession) -> set[str]:
    bodies = [content_body(row) for row in contents_of(db, session.id, CONTENT)]
    return {str(body["request_hash"]) for body in bodies if isinstance(body, dict)}
