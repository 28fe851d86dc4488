"""The tables of answers, scores and corrections in long form: one row each."""

from collections.abc import Mapping

import pandas as pd
from sqlalchemy import Select, select
from sqlalchemy.orm import Session

from app.features.design.instruments import instrument_of
from app.features.design.studies import study_by_key
from app.features.record.questionnaires import newest_corrections
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.context import (
    finished,
    of_kind,
    read,
    sessions_context,
    steps_context,
)
from app.models import (
    Answer,
    AnswerCorrection,
    InstrumentVersion,
    ScoreValue,
    Study,
    StudySession,
    Submission,
)
from app.science.instruments import Instrument


def answers_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per item of every stored form, in the order in which the items were shown."""
    study = study_by_key(db, study_key)
    query = (
        select(Answer.submission_id, Answer.item, Answer.position, Answer.value_number)
        .add_columns(Answer.value_text)
        .join(Submission, Submission.id == Answer.submission_id)
        .join(StudySession, StudySession.id == Submission.session_id)
        .where(of_kind(study, kind))
        .order_by(Answer.submission_id, Answer.position)
    )
    names = ("submission_id", "item", "shown_position", "value_number", "value_text")
    frame = _forms(db, study, kind).merge(read(db, query, names), on="submission_id")
    _apply_corrections(frame, newest_corrections(db, _submissions(study, kind)))
    instruments = _instruments(db)
    items = [
        instruments[row].by_key[item]
        for row, item in zip(frame["instrument_version_id"], frame["item"], strict=True)
    ]
    frame["item_type"] = [item.type for item in items]
    frame["shown_position"] = frame["shown_position"] + 1
    _add_times(frame)
    return finished(frame, "answers")


def _add_times(frame: pd.DataFrame) -> None:
    """Add the columns of response times and changes, numeric even where nothing is known."""
    timed = list(zip(frame["timings"], frame["item"], strict=True))
    traced = [
        traces.get(item, {}) if isinstance(traces, dict) else {}
        for traces, item in zip(frame["item_traces"], frame["item"], strict=True)
    ]
    columns = {
        "response_s": [trace.get("response_s") for trace in traced],
        "changes": [trace.get("changes") for trace in traced],
        "answered_after_s": [(timings or {}).get(item) for timings, item in timed],
    }
    for name, values in columns.items():
        frame[name] = values


def _apply_corrections(
    frame: pd.DataFrame, corrected: Mapping[tuple[str, str], AnswerCorrection]
) -> None:
    """Replace each corrected answer with its latest correction, and mark it in `corrected`."""
    rows = [corrected.get(key) for key in zip(frame["submission_id"], frame["item"], strict=True)]
    frame["corrected"] = [row is not None for row in rows]
    for name in ("value_number", "value_text"):
        frame[name] = [
            given if row is None else getattr(row, name)
            for given, row in zip(frame[name], rows, strict=True)
        ]


def _submissions(study: Study, kind: Kind) -> Select[str]:
    return (
        select(Submission.id)
        .join(StudySession, StudySession.id == Submission.session_id)
        .where(of_kind(study, kind))
    )


def scores_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per score of every stored form, in the instrument's order."""
    study = study_by_key(db, study_key)
    query = (
        select(ScoreValue.submission_id, ScoreValue.score, ScoreValue.value)
        .join(Submission, Submission.id == ScoreValue.submission_id)
        .join(StudySession, StudySession.id == Submission.session_id)
        .where(of_kind(study, kind))
    )
    frame = _forms(db, study, kind).merge(
        read(db, query, ("submission_id", "score", "value")), on="submission_id"
    )
    score_ranges = {
        (row, score.key): (place, score.minimum, score.maximum)
        for row, instrument in _instruments(db).items()
        for place, score in enumerate(instrument.scores)
    }
    of_row = [
        score_ranges.get(key, (len(score_ranges), None, None))
        for key in zip(frame["instrument_version_id"], frame["score"], strict=True)
    ]
    frame["place"] = [place for place, _, _ in of_row]
    frame["minimum"] = [minimum for _, minimum, _ in of_row]
    frame["maximum"] = [maximum for _, _, maximum in of_row]
    return finished(frame.sort_values(["form", "place"], kind="stable"), "scores")


def _forms(db: Session, study: Study, kind: Kind) -> pd.DataFrame:
    """Return one row per stored form, by session and time.

    The rows have the session's columns, the place in the design and whether the form is valid.
    """
    query = (
        select(
            Submission.session_id,
            Submission.id,
            Submission.administration,
            Submission.instrument,
            Submission.instrument_version_id,
            Submission.step_index,
            Submission.attempt,
            Submission.mode,
            Submission.language,
            Submission.timings,
            Submission.item_traces,
            Submission.started_at,
            Submission.submitted_at,
        )
        .join(StudySession, StudySession.id == Submission.session_id)
        .where(of_kind(study, kind))
        .order_by(Submission.submitted_at, Submission.id)
    )
    names = ("session_id", "submission_id", "administration", "instrument", "instrument_version_id")
    more = ("step_index", "attempt", "mode", "language", "timings", "item_traces")
    forms = read(db, query, (*names, *more, "started_at_utc", "submitted_at_utc"))
    frame = (
        sessions_context(db, study.key, kind)
        .merge(forms, on="session_id")
        .merge(steps_context(db, study.key, kind), on=["session_id", "step_index"], how="left")
    )
    versions = {row: instrument.version for row, instrument in _instruments(db).items()}
    frame["instrument_version"] = [versions[row] for row in frame["instrument_version_id"]]
    superseded = frame["attempt"] != frame["attempt_that_counts"]
    answered = frame["answered"].fillna(value=False).astype(bool)
    frame["valid"] = answered & ~superseded & frame["session_counts"]
    frame["form"] = range(len(frame))
    return frame


def _instruments(db: Session) -> dict[str, Instrument]:
    return {row.id: instrument_of(row) for row in db.scalars(select(InstrumentVersion))}


def corrections_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per correction, by session and in the order in which they were made."""
    query = (
        select(
            Submission.session_id,
            Submission.id,
            Submission.administration,
            Submission.instrument,
            AnswerCorrection.item,
            AnswerCorrection.previous_number,
            AnswerCorrection.previous_text,
            AnswerCorrection.value_number,
            AnswerCorrection.value_text,
            AnswerCorrection.reason,
        )
        .add_columns(AnswerCorrection.by, AnswerCorrection.at)
        .join(Submission, Submission.id == AnswerCorrection.submission_id)
        .join(StudySession, StudySession.id == Submission.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
        .order_by(AnswerCorrection.at, AnswerCorrection.id)
    )
    names = ("session_id", "submission_id", "administration", "instrument", "item")
    values = ("previous_number", "previous_text", "value_number", "value_text")
    rows = read(db, query, (*names, *values, "reason", "by", "at_utc"))
    sessions = sessions_context(db, study_key, kind)
    return finished(sessions.merge(rows, on="session_id"), "corrections")
