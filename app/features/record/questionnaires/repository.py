"""Stored forms with their current answers: each as given, unless it was corrected later.

An answer row is never changed. A correction is a separate row, of which the latest applies, and the
scores are those of the current answers. The original scores can be computed from the answer rows.
"""

import json
from collections.abc import Mapping
from datetime import datetime, timedelta
from typing import Literal

from sqlalchemy import Select, select
from sqlalchemy.orm import Session

from app.database import referenced_row
from app.errors import InvalidInput
from app.features.design.instruments import instrument_of
from app.features.record.questionnaires.hints import hints_of
from app.features.record.questionnaires.schemas import (
    AnswerValue,
    CorrectionView,
    ScoreView,
    StoredAnswers,
    StoredScores,
)
from app.models import (
    Answer,
    AnswerCorrection,
    InstrumentVersion,
    ScoreValue,
    StudySession,
    Submission,
)
from app.science.instruments import Instrument, score_answers, validate_answers

_TICK = timedelta(microseconds=1)


def stored_answers(db: Session, session: StudySession) -> list[StoredAnswers]:
    """Return every stored form of a session with its current answers, oldest first."""
    submissions = db.scalars(
        select(Submission)
        .where(Submission.session_id == session.id)
        .order_by(Submission.submitted_at, Submission.id)
    ).all()
    return [_stored_answers(db, submission) for submission in submissions]


def stored_scores(db: Session, session: StudySession) -> list[StoredScores]:
    """Return the scores and hints of every stored form that has any."""
    return [
        StoredScores(**answers.model_dump(include=set(StoredScores.model_fields)))
        for answers in stored_answers(db, session)
        if answers.scores or answers.hints
    ]


def answers_of(db: Session, submission_id: str) -> dict[str, str | float | None]:
    """Return the current answers of a form, in the order in which its items were shown."""
    rows = db.scalars(
        select(Answer).where(Answer.submission_id == submission_id).order_by(Answer.position)
    )
    corrected = newest_corrections(db, select(Submission.id).where(Submission.id == submission_id))
    return {
        row.item: _value(corrected[row.submission_id, row.item])
        if (row.submission_id, row.item) in corrected
        else _given(row)
        for row in rows
    }


def newest_corrections(
    db: Session, submissions: Select[str]
) -> dict[tuple[str, str], AnswerCorrection]:
    """Return the latest correction of each answer, by submission and item.

    `submissions` is a query of submission ids.
    """
    return {(row.submission_id, row.item): row for row in _corrections(db, submissions)}


def correct_answer(
    db: Session,
    submission: Submission,
    *,
    item: str,
    value: AnswerValue,
    reason: str,
    by: str,
    now: datetime,
) -> AnswerCorrection:
    """Add a correction of an answer and recompute the scores; None means left out.

    The session must be locked. Raises InvalidInput if the form has no such item, if the value is
    not a possible answer to it, or if it is already the current answer.
    """
    instrument = instrument_of(
        referenced_row(db, InstrumentVersion, submission.instrument_version_id)
    )
    _require_fit(instrument, item, value)
    before = answers_of(db, submission.id)
    number = float(value) if isinstance(value, bool | int | float) else None
    text = value.strip() or None if isinstance(value, str) else None
    previous = before[item]
    if previous == (number if text is None else text):
        raise InvalidInput(
            f"this is already the answer to {item!r}",
            value=value,
            remedy="Enter the value that it should have.",
        )
    row = AnswerCorrection(
        submission_id=submission.id,
        item=item,
        previous_number=previous if isinstance(previous, float) else None,
        previous_text=previous if isinstance(previous, str) else None,
        value_number=number,
        value_text=text,
        reason=reason,
        by=by,
        at=_after_all_others(db, submission, now),
    )
    db.add(row)
    db.flush()
    _score_anew(db, submission, instrument)
    return row


def _require_fit(instrument: Instrument, item: str, value: AnswerValue) -> None:
    problems = [
        problem
        for problem in validate_answers(instrument, {item: value})
        if problem.item == item and (problem.value is not None or item not in instrument.by_key)
    ]
    for problem in problems:
        raise InvalidInput(
            f"{item!r}: {problem.message}",
            value=value,
            valid=problem.valid,
            remedy=problem.remedy,
        )


def _after_all_others(db: Session, submission: Submission, now: datetime) -> datetime:
    """Return a time later than all corrections so far, since the latest correction applies."""
    earlier = _corrections(db, select(Submission.id).where(Submission.id == submission.id))
    return max([now, *(row.at + _TICK for row in earlier)])


def _score_anew(db: Session, submission: Submission, instrument: Instrument) -> None:
    scores = score_answers(instrument, answers_of(db, submission.id))
    for row in db.scalars(select(ScoreValue).where(ScoreValue.submission_id == submission.id)):
        row.value = scores[row.score]
    db.flush()


def _corrections(db: Session, submissions: Select[str]) -> list[AnswerCorrection]:
    query = select(AnswerCorrection).where(AnswerCorrection.submission_id.in_(submissions))
    return list(db.scalars(query.order_by(AnswerCorrection.at, AnswerCorrection.id)))


def _value(row: AnswerCorrection) -> str | float | None:
    return row.value_number if row.value_text is None else row.value_text


def _given(row: Answer) -> str | float | None:
    return row.value_number if row.value_text is None else row.value_text


def _entered_in(mode: str) -> Literal["tablet", "headset", "operator"]:
    match mode:
        case "operator" | "headset":
            return mode
        case _:
            return "tablet"


def _stored_answers(db: Session, submission: Submission) -> StoredAnswers:
    rows = db.scalars(select(ScoreValue).where(ScoreValue.submission_id == submission.id))
    scores = {row.score: row.value for row in rows}
    version = referenced_row(db, InstrumentVersion, submission.instrument_version_id)
    instrument = instrument_of(version)
    answers = answers_of(db, submission.id)
    own = select(Submission.id).where(Submission.id == submission.id)
    return StoredAnswers(
        submission_id=submission.id,
        administration=submission.administration,
        step_index=submission.step_index,
        instrument=submission.instrument,
        mode=_entered_in(submission.mode),
        language=submission.language,
        shown_order=submission.shown_order,
        submitted_at=submission.submitted_at,
        answers=_as_sent(answers),
        corrections=[_correction_view(row) for row in _corrections(db, own)],
        definition=json.loads(version.canonical_json),
        scores=scores,
        score_views=[
            ScoreView(
                key=score.key,
                label=score.label.get("en") or score.key,
                value=scores.get(score.key),
                minimum=score.minimum,
                maximum=score.maximum,
            )
            for score in instrument.scores
        ],
        hints=hints_of(instrument, submission, answers),
    )


def _correction_view(row: AnswerCorrection) -> CorrectionView:
    return CorrectionView(
        item=row.item,
        previous=row.previous_number if row.previous_text is None else row.previous_text,
        value=_value(row),
        reason=row.reason,
        by=row.by,
        at=row.at,
    )


def _as_sent(answers: Mapping[str, str | float | None]) -> dict[str, AnswerValue]:
    return dict(answers)
