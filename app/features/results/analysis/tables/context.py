"""Tables that others are joined with: sessions, steps and phases, and whether they are valid."""

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import astuple
from functools import wraps
from typing import Any, get_args

import numpy as np
import pandas as pd
from sqlalchemy import ColumnElement, Select, and_, select
from sqlalchemy.orm import Session

from app.features.design.studies import protocol_of, study_by_key, versions_of
from app.features.record.doubts import doubts_of_sessions
from app.features.record.sessions import not_erased, plans_of, state_of
from app.features.results.analysis.codebook import ColumnType, columns_of
from app.features.results.analysis.schemas import Kind
from app.models import Participant, Phase, Study, StudySession, StudyVersion
from app.protocol import Step

KINDS: tuple[Kind, ...] = get_args(Kind)
BROKEN_OFF = ("aborted", "withdrawn")
Context = Callable[[Session, str, Kind], pd.DataFrame]
Contexts = dict[tuple[str, str, Kind], pd.DataFrame]
_shared: ContextVar[Contexts | None] = ContextVar("shared_contexts", default=None)


@contextmanager
def shared_contexts(cache: Contexts) -> Iterator[None]:
    """Read each context table only once in this context manager, and store it in `cache`.

    Only for tables of one database whose data do not change while `cache` is used. Within another
    one the outer cache is used, so that what a caller has read is not read again.
    """
    if _shared.get() is not None:
        yield
        return
    token = _shared.set(cache)
    try:
        yield
    finally:
        _shared.reset(token)


def _once(context: Context) -> Context:
    """Decorate a function that reads a context, so that it reads once where contexts are shared."""

    @wraps(context)
    def read_once(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
        cache = _shared.get()
        if cache is None:
            return context(db, study_key, kind)
        name = (context.__name__, study_key, kind)
        if name not in cache:
            cache[name] = context(db, study_key, kind)
        return cache[name].copy(deep=False)

    return read_once


def of_kind(study: Study, kind: Kind) -> ColumnElement[bool]:
    """Return the condition for a study's sessions of one kind, or of every kind (`all`).

    Expert sessions are reviews of a study and are in no table, not even with `all`.
    """
    if kind not in KINDS:
        raise ValueError(f"unknown kind {kind!r}; valid are {', '.join(KINDS)}")
    of_study = StudySession.study_id == study.id
    chosen = StudySession.kind == kind if kind != "all" else StudySession.kind != "expert"
    return and_(of_study, chosen)


def read(db: Session, query: Select[*tuple[Any, ...]], names: Sequence[str]) -> pd.DataFrame:
    """Return the rows of a query under these column names, with the database's objects."""
    rows = [tuple(row) for row in db.execute(query)]
    return pd.DataFrame(rows, columns=list(names), dtype=object)


def finished(frame: pd.DataFrame, table: str) -> pd.DataFrame:
    """Return the columns of `table` in the codebook's order and types.

    Raises KeyError if a column is missing.
    """
    columns = columns_of(table)
    shaped = frame[[column.name for column in columns]].reset_index(drop=True)
    for column in columns:
        shaped[column.name] = _cast(shaped[column.name], column.type)
    return shaped


def _cast(values: "pd.Series[Any]", kind: ColumnType) -> "pd.Series[Any]":
    match kind:
        case "time":
            return pd.to_datetime(values, utc=True).astype("datetime64[us, UTC]")
        case "integer":
            missing = values.isna().to_numpy(dtype=np.bool_)
            whole = np.zeros(len(values), np.int64)
            whole[~missing] = values.to_numpy(dtype=object)[~missing].astype(np.int64)
            return pd.Series(pd.arrays.IntegerArray(whole, missing))
        case "number":
            return values.astype("float64")
        case "boolean":
            if not values.isna().any():
                return values.astype("bool")
            truths = [None if pd.isna(value) else bool(value) for value in values]
            return pd.Series(pd.array(truths, dtype="boolean"))
        case "text":
            return values.astype("object").where(values.notna(), None)


@_once
def sessions_context(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per session, oldest first: the common first columns and the status."""
    study = study_by_key(db, study_key)
    query = (
        select(
            StudyVersion.number,
            StudySession.kind,
            StudySession.avatar,
            Participant.code,
            StudySession.id,
            StudySession.status,
            StudySession.shortfalls,
            ~not_erased(StudySession.id),
        )
        .join(StudyVersion, StudyVersion.id == StudySession.study_version_id)
        .join(Participant, Participant.id == StudySession.participant_id)
        .where(of_kind(study, kind))
        .order_by(StudySession.created_at, StudySession.id)
    )
    names = ("study_version", "kind", "avatar", "participant_code", "session_id", "session_status")
    frame = read(db, query, (*names, "shortfalls", "erased"))
    frame["session_counts"] = _counts(frame) & ~frame["session_id"].isin(
        doubted_sessions(db, study_key, kind)
    )
    frame["study_key"] = study.key
    frame["simulated"] = frame["kind"] == "simulated"
    return frame


def _counts(sessions: pd.DataFrame) -> "pd.Series[Any]":
    """Return whether each session counts: it was not broken off and meets all requirements.

    Nor have its data been erased: what is left of it, such as its phases, says nothing.
    """
    lacking = [
        bool(found) or bool(erased)
        for found, erased in zip(sessions["shortfalls"], sessions["erased"], strict=True)
    ]
    return ~(sessions["session_status"].isin(BROKEN_OFF) | pd.Series(lacking, sessions.index))


def has_rules(db: Session, study: Study, used: Collection[int] = ()) -> bool:
    """Return whether versions of the study have rules for valid sessions (`valid_when`).

    `used`: the numbers of the versions to consider; all if empty.
    """
    versions = [one for one in versions_of(db, study) if not used or one.number in used]
    return any(protocol_of(version).valid_when is not None for version in versions)


@_once
def steps_context(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per step of every session: its place in the design and its valid attempt."""
    study = study_by_key(db, study_key)
    rows = []
    plans = plans_of(db, of_kind(study, kind))
    for session in db.scalars(select(StudySession).where(of_kind(study, kind))):
        plan, state = plans[session.id], state_of(session)
        positions = _positions(plan)
        skipped = {
            (step.block, step.limb)
            for step in plan
            if step.spec.counts and state.steps[step.index].status == "skipped"
        }
        for step in plan:
            own = state.steps[step.index]
            rows.append(
                {
                    "session_id": session.id,
                    "step_index": step.index,
                    "block": step.block,
                    "position": positions.get((step.block, step.limb)),
                    "limb": None if step.limb is None else str(step.limb),
                    "condition": step.condition,
                    "latency_ms": step.latency_ms,
                    "body": step.body,
                    "attempt_that_counts": own.attempt,
                    "answered": own.status == "done" and (step.block, step.limb) not in skipped,
                }
            )
    return pd.DataFrame(rows, columns=list(STEP_COLUMNS), dtype=object)


STEP_COLUMNS = (
    "session_id",
    "step_index",
    "block",
    "position",
    "limb",
    "condition",
    "latency_ms",
    "body",
    "attempt_that_counts",
    "answered",
)


@_once
def phases_context(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per phase: its session, its place in the design, and whether it is valid."""
    sessions = sessions_context(db, study_key, kind)
    steps = steps_context(db, study_key, kind)[["session_id", "step_index", "position"]]
    query = (
        select(
            Phase.session_id,
            Phase.phase_id,
            Phase.kind,
            Phase.step_index,
            Phase.block,
            Phase.limb,
            Phase.condition,
            Phase.latency_ms,
            Phase.attempt,
            Phase.status,
        )
        .join(StudySession, StudySession.id == Phase.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
        .order_by(Phase.session_id, Phase.phase_id)
    )
    names = ("session_id", "phase_id", "phase_kind", "step_index", "block", "limb", "condition")
    phases = read(db, query, (*names, "latency_ms", "attempt", "status"))
    frame = sessions.merge(phases, on="session_id").merge(
        steps, on=["session_id", "step_index"], how="left"
    )
    doubted = doubts_context(db, study_key, kind)
    in_doubt = set(zip(doubted["session_id"], doubted["phase_id"], strict=True))
    own = zip(frame["session_id"], frame["phase_id"], strict=True)
    believed = np.array([key not in in_doubt for key in own], dtype=np.bool_)
    frame["valid"] = (frame["status"] == "done") & frame["session_counts"] & believed
    return frame


@_once
def doubts_context(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per doubt, by session and phase: recorded data that cannot be true.

    A doubt about a phase makes that phase invalid, a doubt without a phase the whole session.
    """
    doubts = doubts_of_sessions(db, of_kind(study_by_key(db, study_key), kind))
    rows = [(key, *astuple(one)) for key, of_session in doubts.items() for one in of_session]
    return pd.DataFrame(rows, columns=list(DOUBT_COLUMNS), dtype=object)


DOUBT_COLUMNS = ("session_id", "phase_id", "doubt", "words", "claimed", "possible", "value_unit")


def doubted_sessions(db: Session, study_key: str, kind: Kind) -> list[str]:
    """Return the sessions that are entirely invalid, because a doubt is about the whole session."""
    doubts = doubts_context(db, study_key, kind)
    return sorted(set(doubts.loc[doubts["phase_id"].isna(), "session_id"]))


def phase_limbs(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per session and limb of its phases."""
    query = (
        select(Phase.session_id, Phase.limb)
        .join(StudySession, StudySession.id == Phase.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
        .distinct()
    )
    return read(db, query, ("session_id", "limb"))


def _positions(plan: Sequence[Step]) -> dict[tuple[int | None, str | None], int]:
    """Return the position of each task in its block, counted from 1.

    Steps outside the blocks have none.
    """
    positions: dict[tuple[int | None, str | None], int] = {}
    for step in plan:
        if step.spec.counts:
            earlier = sum(block == step.block for block, _ in positions)
            positions[step.block, step.limb] = earlier + 1
    return positions
