"""The tables of joint errors in degrees: per phase, and by bin of active time."""

import math
from itertools import chain

import numpy as np
import pandas as pd
from sqlalchemy import ColumnElement, select, true
from sqlalchemy.orm import Session

from app.features.design.studies import study_by_key
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.context import finished, of_kind, phases_context, read
from app.models import JointErrorCourseRow, JointErrorRow, StudySession
from app.science.joint_error import ERROR_AXES, ERROR_JOINTS_WITH_FINGERS

_KEYS = ["session_id", "phase_id"]
_FIGURES = ("mean", "rms", "p95", "max")
_REFERENCES = ("present", "command")
_LISTS = ["bin_s", "mean_rad", "samples"]
_PLACES = {"present": 0, "command": 1}


def joint_angles_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return only the joint errors that are angles to the present pose, an eighth of all rows."""
    return _errors(
        db,
        study_key,
        kind,
        (JointErrorRow.reference == "present") & (JointErrorRow.axis == "angle"),
    )


def joint_errors_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per phase, reference, joint and axis, in the order of joints and fingers."""
    return _errors(db, study_key, kind, true())


def _errors(
    db: Session, study_key: str, kind: Kind, condition: ColumnElement[bool]
) -> pd.DataFrame:
    query = (
        select(
            JointErrorRow.session_id,
            JointErrorRow.phase_id,
            JointErrorRow.reference,
            JointErrorRow.joint,
            JointErrorRow.axis,
            JointErrorRow.mean_rad,
            JointErrorRow.rms_rad,
            JointErrorRow.p95_rad,
            JointErrorRow.max_rad,
            JointErrorRow.clipped_share,
            JointErrorRow.samples,
            JointErrorRow.excluded,
        )
        .join(StudySession, StudySession.id == JointErrorRow.session_id)
        .where(of_kind(study_by_key(db, study_key), kind), condition)
    )
    names = ("reference", "joint", "axis", *(f"{name}_rad" for name in _FIGURES))
    errors = read(db, query, (*_KEYS, *names, "clipped_share", "samples", "excluded"))
    # If all values are missing, the column is not numeric yet.
    errors["clipped_share"] = errors["clipped_share"].astype("float64")
    places = _places()
    keys = zip(errors["reference"], errors["joint"], errors["axis"], strict=True)
    errors["place"] = [places.get(key, len(places)) for key in keys]
    for name in _FIGURES:
        errors[f"{name}_deg"] = errors[f"{name}_rad"].astype("float64") * (180.0 / math.pi)
    frame = phases_context(db, study_key, kind).merge(errors.sort_values("place"), on=_KEYS)
    return finished(frame, "joint_errors")


def _places() -> dict[tuple[str, str, str], int]:
    ordered = [
        (reference, joint, axis)
        for reference in _REFERENCES
        for joint in ERROR_JOINTS_WITH_FINGERS
        for axis in ERROR_AXES
    ]
    return {key: place for place, key in enumerate(ordered)}


def present_course_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return only the courses of joint errors to the present pose, half of all rows."""
    return _courses(db, study_key, kind, JointErrorCourseRow.reference == "present")


def joint_error_course_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per phase, reference and bin of active time, in order of time."""
    return _courses(db, study_key, kind, true())


def _courses(
    db: Session, study_key: str, kind: Kind, condition: ColumnElement[bool]
) -> pd.DataFrame:
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
        .where(of_kind(study_by_key(db, study_key), kind), condition)
    )
    courses = read(db, query, (*_KEYS, "reference", *_LISTS))
    courses["place"] = courses["reference"].map(_PLACES)
    frame = phases_context(db, study_key, kind).merge(courses.sort_values("place"), on=_KEYS)
    return finished(_bins(frame), "joint_error_course")


def _bins(courses: pd.DataFrame) -> pd.DataFrame:
    """Expand the courses from one row per course to one row per bin."""
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
