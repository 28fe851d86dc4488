"""Forms: determine which one is due, store and score it once, and advance the session.

Answers that arrive late or conflict with stored ones are rejected; conflicting ones are stored
separately for the record.
"""

import hashlib
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NoReturn, cast

import numpy as np
from sqlalchemy import Table, bindparam, insert, select
from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotNow, RecordedConflict
from app.features.design.studies import UsedInstrument, used_instrument
from app.features.record.doubts import judge_with_doubts
from app.features.record.questionnaires.schemas import (
    Administration,
    AnswerValue,
    Receipt,
    SubmissionRequest,
)
from app.features.record.questionnaires.stop_rules import judge, update_alarms
from app.features.record.sessions import (
    KeepRefusedForm,
    SubmitForm,
    apply_command,
    canonical,
    content_body,
    contents_of,
    plan_of,
    require_capture_of,
    state_of,
    store_content,
)
from app.models import Answer, ScoreValue, StudySession, Submission, new_id
from app.platform.context import AppContext
from app.protocol import FORM_KINDS, Step
from app.rows import insert_rows
from app.science.instruments import Instrument, item_order, score_answers, validate_answers

CONTENT = "refused_form"
Row = dict[str, Any]
ANSWERS = cast("Table", Answer.__table__)
SCORES = cast("Table", ScoreValue.__table__)
_STORED = (
    select(Submission)
    .where(
        Submission.session_id == bindparam("session_id"),
        (Submission.idempotency_key == bindparam("idempotency_key"))
        | (Submission.administration == bindparam("administration")),
    )
    .limit(1)
)


@dataclass(frozen=True)
class DueForm:
    """A step that requires a form, with the instrument to use; `attempt` counts from 1."""

    step: Step
    attempt: int
    used: UsedInstrument

    @property
    def key(self) -> str:
        """Return the key of this administration; repeating the step gives a new key."""
        return f"{self.step.key}#{self.attempt}"


def due_form(db: Session, session: StudySession) -> DueForm | None:
    """Return the form that is due now, or None."""
    state = state_of(session)
    if state.current is None:
        return None
    step = plan_of(db, session)[state.current]
    if step.kind not in FORM_KINDS or step.instrument is None:
        return None
    used = used_instrument(db, session.study_version_id, step.instrument)
    return DueForm(step, state.steps[step.index].attempt, used)


def current_administration(db: Session, session: StudySession) -> Administration | None:
    """Return the form that is due now in the format in which pages receive it, or None."""
    due = due_form(db, session)
    if due is None:
        return None
    instrument, seed = due.used.instrument, _item_seed(session, due)
    return Administration(
        key=due.key,
        step_index=due.step.index,
        instrument=dict(due.used.definition),
        item_order=list(item_order(instrument, seed)),
        seed=seed,
        language=session.language,
        languages=list(instrument.languages),
    )


def _item_seed(session: StudySession, due: DueForm) -> int:
    sequence = np.random.SeedSequence([session.seed, due.step.index, due.attempt])
    return int(sequence.generate_state(1)[0])


def submit(
    db: Session,
    context: AppContext,
    session: StudySession,
    request: SubmissionRequest,
    *,
    mode: str,
    actor: str,
) -> Receipt:
    """Store a form, advance the session, and return the receipt.

    A form that is already stored returns its first receipt. `session` must be locked. Raises
    InvalidInput with every invalid answer, NotNow if this form is not due or is answered elsewhere,
    and RecordedConflict if different answers are already stored; the new ones are then stored
    separately. `mode`: tablet, headset or operator.
    """
    require_capture_of(db, session)
    hash_ = request_hash(request)
    stored = _stored(db, session, request)
    if stored is not None:
        if stored.idempotency_key == request.idempotency_key and stored.request_hash == hash_:
            return Receipt(receipt_id=stored.id, stored_at=stored.submitted_at, duplicate=True)
        store_rejected(db, context, session, request, stored=stored, actor=actor)
    due = due_form(db, session)
    if due is None or due.key != request.administration:
        raise NotNow(
            f"the form {request.administration!r} is not due now",
            value=request.administration,
            valid=due.key if due else None,
            remedy="The answers are still on this device; tell the experimenter.",
        )
    if mode not in ("operator", due.step.forms):
        raise NotNow(
            f"this form is not answered on the {mode}",
            value=mode,
            valid=due.step.forms,
            remedy="The answers are still on this device; tell the experimenter.",
        )
    instrument = due.used.instrument
    check_answers(instrument, request, mode=mode)
    id_, salt, now = new_id(), secrets.token_hex(32), context.clock.utc_now()
    _store(
        db,
        _submission_row(due, request)
        | {"id": id_, "session_id": session.id, "request_hash": hash_, "salt": salt}
        | {"mode": mode, "entered_by": actor, "submitted_at": now},
        _answer_rows(id_, instrument, request),
        _score_rows(id_, instrument, request.answers),
    )
    judgement = judge(db, session, instrument.key)
    update_alarms(db, session, judgement, now)
    digest = hashlib.sha256(f"{salt}{canonical(request.answers)}".encode()).hexdigest()
    command = SubmitForm(
        step=due.step.index, submission_id=id_, content_hash=digest, rules_met=judgement.met
    )
    apply_command(db, context, session, command, actor=actor)
    judge_with_doubts(db, session)
    return Receipt(receipt_id=id_, stored_at=now, duplicate=False)


def _stored(db: Session, session: StudySession, request: SubmissionRequest) -> Submission | None:
    parameters = {
        "session_id": session.id,
        "idempotency_key": request.idempotency_key,
        "administration": request.administration,
    }
    return db.scalar(_STORED, parameters)


def _store(db: Session, submission: Row, answers: list[Row], scores: list[Row]) -> None:
    """Insert a form with its answers and scores, with one statement per table."""
    db.connection().execute(insert(Submission), submission)
    insert_rows(db, ANSWERS, answers)
    if scores:
        insert_rows(db, SCORES, scores)


def _submission_row(due: DueForm, request: SubmissionRequest) -> Row:
    """Return those columns of a submission that follow from the form and the request."""
    return {
        "administration": due.key,
        "step_index": due.step.index,
        "attempt": due.attempt,
        "instrument_version_id": due.used.version_id,
        "instrument": due.used.instrument.key,
        "idempotency_key": request.idempotency_key,
        "language": request.language,
        "item_seed": request.seed,
        "shown_order": request.shown_order,
        "timings": request.timings,
        "item_traces": _as_stored(request),
        "started_at": request.started_at_utc,
    }


def _as_stored(request: SubmissionRequest) -> dict[str, Any] | None:
    traces = request.item_traces
    return None if traces is None else {item: one.model_dump() for item, one in traces.items()}


def _answer_rows(id_: str, instrument: Instrument, request: SubmissionRequest) -> list[Row]:
    shown = {item: at for at, item in enumerate(request.shown_order)}
    rows = []
    for item in instrument.items:
        value = request.answers.get(item.key)
        text = value.strip() if isinstance(value, str) else None
        number = float(value) if isinstance(value, bool | int | float) else None
        rows.append(
            {
                "submission_id": id_,
                "item": item.key,
                "position": shown[item.key],
                "value_number": number,
                "value_text": text or None,
            }
        )
    return rows


def _score_rows(id_: str, instrument: Instrument, answers: Mapping[str, AnswerValue]) -> list[Row]:
    return [
        {"submission_id": id_, "score": key, "value": value}
        for key, value in score_answers(instrument, answers).items()
    ]


def check_answers(instrument: Instrument, request: SubmissionRequest, *, mode: str) -> None:
    """Raise InvalidInput with every invalid answer, or for a wrong item order or language.

    `mode`: where it was answered. The experimenter may leave out required answers. In a headset
    nobody can type: a text is said aloud, and the experimenter enters it as a correction.
    """

    def may_be_missing(key: str) -> bool:
        item = instrument.by_key.get(key)
        is_spoken = mode == "headset" and item is not None and item.type == "text"
        return mode == "operator" or is_spoken

    problems = [
        problem
        for problem in validate_answers(instrument, request.answers)
        if not (problem.value is None and may_be_missing(problem.item))
    ]
    if problems:
        raise InvalidInput(
            f"{len(problems)} answer{'s are' if len(problems) != 1 else ' is'} invalid",
            value=[problem.item for problem in problems],
            remedy="Correct the answers listed below; nothing was stored.",
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
            remedy="Send the order in which the items were shown, as the form gave it.",
        )
    if request.language not in instrument.languages:
        raise InvalidInput(
            f"the form does not exist in {request.language!r}",
            value=request.language,
            valid=list(instrument.languages),
            remedy="Show the form in one of these languages, and send that one.",
        )


def request_hash(request: SubmissionRequest) -> str:
    """Return a hash of the form and its answers, by which a repeated request is recognised."""
    covered = canonical([request.administration, request.answers, request.shown_order])
    return hashlib.sha256(covered.encode()).hexdigest()


def store_rejected(
    db: Session,
    context: AppContext,
    session: StudySession,
    request: SubmissionRequest,
    *,
    stored: Submission,
    actor: str,
) -> NoReturn:
    """Reject answers that differ from the stored ones, but store them separately, once.

    Raises RecordedConflict, with which this transaction is committed.
    """
    hash_ = request_hash(request)
    if hash_ not in (stored.request_hash, *_rejected_hashes(db, session)):
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
        command = KeepRefusedForm(submission_id=stored.id, content=content)
        apply_command(db, context, session, command, actor=actor)
    raise RecordedConflict(
        "different answers to this form are already stored",
        value=request.administration,
        remedy="The first answers apply; these were stored separately. The experimenter can open "
        "the form again.",
    )


def _rejected_hashes(db: Session, session: StudySession) -> set[str]:
    bodies = [content_body(row) for row in contents_of(db, session.id, CONTENT)]
    return {str(body["request_hash"]) for body in bodies if isinstance(body, dict)}
