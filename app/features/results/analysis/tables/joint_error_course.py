"""The table of how joint errors went within each phase, in degrees."""

import math
from itertools import chain

import numpy as np
import pandas as pd
from sqlalchemy import ColumnElement, select, true
from sqlalchemy.orm import Session

from app.features.design.studies.service import study_by_key
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.context import finished, of_kind, phases_context, read
from app.models import JointErrorCourseRow, StudySession

_KEYS = ["session_id", "phase_id"]
_LISTS = ["bin_s", "mean_rad", "samples"]
_PLACES = {"present": 0, "command": 1}


def present_course_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Of the courses, those to the present pose: half of the rows."""
    return _table(db, study_key, kind, JointErrorCourseRow.reference == "present")


def joint_error_course_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """One row per phase, reference and bin, in order of time."""
    return _table(db, study_key, kind, true())


def _table(db: Session, study_key: str, kind: Kind, wanted: ColumnElement[bool]) -> pd.DataFrame:
    query = (
        select(
            JointErrorCourseRow.session_id,
            JointErrorCourseRow.phase_id,
            JointErrorCourseRow.reference,
            JointErrorCourseRow.bin_s,
            JointErrorCourseRow.mean_rad,
            JointErrorCourseRow.samples,
        )
        .join(StudySession, StudySession.id == JointErrorCourseRow.session_id)
        .where(of_kind(study_by_key(db, study_key), kind), wanted)
    )
    courses = read(db, query, (*_KEYS, "reference", *_LISTS))
    courses["place"] = courses["reference"].map(_PLACES)
    frame = phases_context(db, study_key, kind).merge(courses.sort_values("place"), on=_KEYS)
    return finished(_bins(frame), "joint_error_course")


def _bins(courses: pd.DataFrame) -> pd.DataFrame:
    """One row a bin instead of one a course."""
    counts = courses["samples"].map(len).to_numpy(dtype=np.int64)
    rows = courses.drop(columns=_LISTS).loc[courses.index.repeat(counts)]
    first = np.repeat(np.cumsum(counts) - counts, counts)
    place = np.arange(len(rows)) - first
    bin_s = np.repeat(courses["bin_s"].to_numpy(dtype=np.float64), counts)
    means = np.array(list(chain.from_iterable(courses["mean_rad"])), dtype=np.float64)
    return rows.assign(
        begin_active_s=place * bin_s,
        end_active_s=(place + 1) * bin_s,
        mean_deg=means * (180.0 / math.pi),
        samples=list(chain.from_iterable(courses["samples"])),
    )
