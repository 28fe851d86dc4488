"""Forms: which one is due, storing it once, scoring it."""

import hashlib
import json
import secrets
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotNow
from app.features.context import AppContext
from app.features.questionnaires.refused import keep_refused, request_hash
from app.features.questionnaires.schemas import (
    Administration,
    AnswerValue,
    SubmissionRequest,
)
from app.features.questionnaires.stop_rules import judge, tell
from app.features.questionnaires.stored import (
    answers_of,
    correct_answer,
    newest_corrections,
    stored_answers,
    stored_scores,
)
from app.features.sessions.capture import require_capture
from app.features.sessions.engine import SessionState
from app.features.sessions.engine.commands import SubmitForm
from app.features.sessions.journal import canonical
from app.features.sessions.service import apply_command, plan_of, state_of
from app.features.studies.service import instrument_for, instrument_of
from app.models import Answer, InstrumentVersion, ScoreValue, StudySession, StudyVersion, Submission
from app.models.types import new_id
from app.protocol.plan import Step
from app.science.instruments import Instrument, item_order, score_answers, validate_answers

__all__ = [
    "administration_key",
    "answers_of",
    "correct_answer",
    "current_administration",
    "newest_corrections",
    "stored_answers",
    "stored_scores",
    "submit",
]
FORM_KINDS = ("form", "questionnaire")


def administration_key(step: Step, state: SessionState) -> str:
    """The name of one filling-in of a step: doing the step over makes another."""
    return f"{step.key}#{state.steps[step.index].attempt}"


def current_administration(db: Session, session: StudySession) -> Administration | None:
    """The form that is due now, or None."""
    state = state_of(session)
    if state.current is None:
        return None
    step = plan_of(db, session)[state.current]
    if step.kind not in FORM_KINDS or step.instrument is None:
        return None
    row = _instrument_version(db, session, step.instrument)
    instrument = instrument_of(row)
    seed = _item_seed(session, step, state)
    return Administration(
        key=administration_key(step, state),
        step_index=step.index,
        instrument=_as_json(row),
        item_order=list(item_order(instrument, seed)),
        seed=seed,
        language=session.language,
        languages=list(instrument.languages),
    )


def submit(
    db: Session,
    context: AppContext,
    session: StudySession,
    request: SubmissionRequest,
    *,
    mode: str,
    actor: str,
) -> tuple[Submission, bool]:
    """Store a form and move the session on; the submission and whether it was stored before.

    `session` must be locked. Raises InvalidInput with every answer that does not fit, NotNow when
    this form is not due, KeptConflict when other answers are stored already; these are then kept
    beside them.
    """
    require_capture(db, session.id)
    hash_ = request_hash(request)
    known = _stored(db, session, request)
    if known is not None:
        if known.idempotency_key == request.idempotency_key and known.request_hash == hash_:
            return known, True
        keep_refused(db, context, session, request, stands=known, actor=actor)
    due = current_administration(db, session)
    if due is None or due.key != request.administration:
        raise NotNow(
            f"the form {request.administration!r} is not due now",
            value=request.administration,
            valid=due.key if due else None,
            remedy="The answers are still on this device; tell the experimenter.",
        )
    state = state_of(session)
    step = plan_of(db, session)[due.step_index]
    row = _instrument_version(db, session, step.instrument or "")
    instrument = instrument_of(row)
    _check_answers(instrument, request, allow_missing=mode == "operator")
    now = context.clock.utc_now()
    salt = secrets.token_hex(32)
    submission = Submission(
        id=new_id(),
        session_id=session.id,
        administration=due.key,
        step_index=step.index,
        attempt=state.steps[step.index].attempt,
        instrument_version_id=row.id,
        instrument=instrument.key,
        idempotency_key=request.idempotency_key,
        request_hash=hash_,
        salt=salt,
        mode=mode,
        entered_by=actor,
        language=request.language,
        item_seed=request.seed,
        shown_order=request.shown_order,
        timings=request.timings,
        started_at=request.started_at_utc,
        submitted_at=now,
    )
    db.add(submission)
    db.flush()
    db.add_all(_answer_rows(submission, instrument, request.answers))
    db.add_all(_score_rows(submission, instrument, request.answers))
    db.flush()
    judgement = judge(db, session, submission)
    tell(db, session, judgement, now)
    digest = hashlib.sha256(f"{salt}{canonical(request.answers)}".encode()).hexdigest()
    apply_command(
        db,
        context,
        session,
        SubmitForm(
            step=step.index,
            submission_id=submission.id,
            content_hash=digest,
            rules_met=judgement.met,
        ),
        actor=actor,
    )
    return submission, False


def _stored(db: Session, session: StudySession, request: SubmissionRequest) -> Submission | None:
    same_key = Submission.idempotency_key == request.idempotency_key
    same_form = Submission.administration == request.administration
    return db.scalar(
        select(Submission).where(Submission.session_id == session.id, same_key | same_form).limit(1)
    )


def _check_answers(
    instrument: Instrument, request: SubmissionRequest, *, allow_missing: bool
) -> None:
    problems = [
        problem
        for problem in validate_answers(instrument, request.answers)
        if not (allow_missing and problem.value is None)
    ]
    if problems:
        raise InvalidInput(
            f"{len(problems)} answer{'s do' if len(problems) != 1 else ' does'} not fit",
            value=[problem.item for problem in problems],
            remedy="Mend the answers named below; nothing was stored.",
            details=[
                {
                    "item": problem.item,
                    "message": problem.message,
                    "value": problem.value,
                    "valid": problem.valid,
                    "remedy": problem.remedy,
                }
                for problem in problems
            ],
        )
    if sorted(request.shown_order) != sorted(instrument.by_key):
        raise InvalidInput(
            "shown_order must name every item once",
            value=request.shown_order,
            valid=sorted(instrument.by_key),
        )
    if request.language not in instrument.languages:
        raise InvalidInput(
            f"the form is not written in {request.language!r}",
            value=request.language,
            valid=list(instrument.languages),
        )


def _answer_rows(
    submission: Submission, instrument: Instrument, answers: Mapping[str, AnswerValue]
) -> Sequence[Answer]:
    shown = {item: at for at, item in enumerate(submission.shown_order)}
    rows = []
    for item in instrument.items:
        value = answers.get(item.key)
        text = value.strip() if isinstance(value, str) else None
        number = float(value) if isinstance(value, bool | int | float) else None
        rows.append(
            Answer(
                submission_id=submission.id,
                item=item.key,
                position=shown[item.key],
                value_number=number,
                value_text=text or None,
            )
        )
    return rows


def _score_rows(
    submission: Submission, instrument: Instrument, answers: Mapping[str, AnswerValue]
) -> Sequence[ScoreValue]:
    return [
        ScoreValue(submission_id=submission.id, score=key, value=value)
        for key, value in score_answers(instrument, answers).items()
    ]


def _item_seed(session: StudySession, step: Step, state: SessionState) -> int:
    sequence = np.random.SeedSequence([session.seed, step.index, state.steps[step.index].attempt])
    return int(sequence.generate_state(1)[0])


def _instrument_version(db: Session, session: StudySession, key: str) -> InstrumentVersion:
    return instrument_for(db, db.get_one(StudyVersion, session.study_version_id), key)


def _as_json(row: InstrumentVersion) -> dict[str, Any]:
    loaded: dict[str, Any] = json.loads(row.canonical_json)
    return loaded
