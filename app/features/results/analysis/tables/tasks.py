"""The tables of contacts and completed tasks, and the times at which sides of boxes were red."""

from collections.abc import Iterable

import numpy as np
import pandas as pd
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.design.studies import study_by_key
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.clocks import add_utc
from app.features.results.analysis.tables.context import finished, of_kind, phases_context, read
from app.models import Completion, Contact, StudySession
from app.science.tasks import Span, side_unit, union

_KEYS = ["session_id", "phase_id"]


def red_spans(contacts: Iterable[tuple[str, float, float]]) -> dict[str, tuple[Span, ...]]:
    """Return the spans in which each side, such as "hand/2/left", was red.

    Each is the union over body parts. `contacts` are (surface, begin_active_s, end_active_s) of one
    phase; the bars of a rim are one side.
    """
    by_side: dict[str, list[Span]] = {}
    for surface, begin_s, end_s in contacts:
        by_side.setdefault(side_unit(surface) or surface, []).append((begin_s, end_s))
    return {side: union(spans) for side, spans in by_side.items()}


def total_s(spans: Iterable[Span]) -> float:
    """Return the total length of disjoint spans, in s."""
    return sum((end - begin for begin, end in spans), 0.0)


def contact_spans_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per contact interval without UTC times.

    Mapping to UTC takes longest, and no figure needs it.
    """
    return _contacts(db, study_key, kind, in_utc=False)


def contacts_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per contact interval, by phase and start time."""
    return _contacts(db, study_key, kind, in_utc=True)


def _contacts(db: Session, study_key: str, kind: Kind, *, in_utc: bool) -> pd.DataFrame:
    query = (
        select(
            Contact.session_id,
            Contact.phase_id,
            Contact.epoch,
            Contact.surface,
            Contact.surface_kind,
            Contact.box,
            Contact.side,
            Contact.body_part,
            Contact.effect,
            Contact.begin_s,
            Contact.end_s,
            Contact.begin_active_s,
            Contact.end_active_s,
        )
        .join(StudySession, StudySession.id == Contact.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
        .order_by(Contact.begin_s, Contact.surface, Contact.body_part, Contact.id)
    )
    names = ("surface", "surface_kind", "box", "side", "body_part", "effect")
    times = ("begin_s", "end_s", "begin_active_s", "end_active_s")
    contacts = read(db, query, (*_KEYS, "epoch", *names, *times))
    if in_utc:
        add_utc(db, contacts, "begin_s", "begin_utc")
    else:
        unplaced = pd.Series(pd.NaT, index=contacts.index, dtype="datetime64[ns, UTC]")
        contacts = contacts.assign(begin_utc=unplaced, clock_uncertainty_ms=np.nan)
    frame = phases_context(db, study_key, kind).merge(contacts, on=_KEYS)
    frame["duration_s"] = frame["end_active_s"] - frame["begin_active_s"]
    return finished(frame, "contacts")


def completions_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per completed task, by phase and number."""
    query = (
        select(
            Completion.session_id,
            Completion.phase_id,
            Completion.epoch,
            Completion.number,
            Completion.at_s,
            Completion.active_s,
            Completion.duration_s,
            Completion.order,
            Completion.out_of_order_touches,
        )
        .join(StudySession, StudySession.id == Completion.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
        .order_by(Completion.number)
    )
    names = ("number", "at_s", "active_s", "duration_s", "panels", "out_of_order_touches")
    done = read(db, query, (*_KEYS, "epoch", *names))
    add_utc(db, done, "at_s", "at_utc")
    frame = phases_context(db, study_key, kind).merge(done, on=_KEYS)
    frame["panel_order"] = [" ".join(str(box) for box in panels) for panels in frame["panels"]]
    return finished(frame, "completions")
