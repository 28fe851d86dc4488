"""Tests of the course of joint error within the phases of a rehearsed session."""

import numpy as np
import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.models import JointErrorCourseRow, JointErrorRow, Phase
from app.science.joint_error import COURSE_BIN_S
from tests.rehearsal.performed import TASK_PHASES, Performed

RATE_HZ = 90.0
JOINTS = 21


def _courses(performed: Performed, db: Session) -> list[tuple[Phase, JointErrorCourseRow]]:
    query = (
        select(Phase, JointErrorCourseRow)
        .join(
            JointErrorCourseRow,
            (JointErrorCourseRow.session_id == Phase.session_id)
            & (JointErrorCourseRow.phase_id == Phase.phase_id),
        )
        .where(Phase.session_id == performed.session_id)
        .order_by(Phase.phase_id, JointErrorCourseRow.reference)
    )
    return [(phase, course) for phase, course in db.execute(query)]


def test_every_bin_of_a_task_has_its_five_seconds(performed: Performed, db: Session) -> None:
    """Every bin of a task contains five seconds of active time, give or take a few frames.

    Walks back are left out, and there is no extra bin.
    """
    courses = [course for phase, course in _courses(performed, db) if phase.kind == "task"]
    assert len(courses) == 2 * TASK_PHASES
    task_s = performed.lengths.task_s
    for course in courses:
        frames = np.array(course.samples) / JOINTS
        assert len(frames) == task_s / COURSE_BIN_S
        np.testing.assert_allclose(frames[:-1], COURSE_BIN_S * RATE_HZ, atol=3.0)
        # The last bin contains what pauses add or remove, up to a frame each.
        assert frames.sum() == pytest.approx(task_s * RATE_HZ, abs=20.0)


def test_the_mean_of_the_bins_is_that_of_the_phase(performed: Performed, db: Session) -> None:
    """The mean of the bins equals the mean of the phase to 1e-12 rad, for both references."""
    for phase, course in _courses(performed, db):
        means = db.scalars(
            select(JointErrorRow.mean_rad).where(
                JointErrorRow.session_id == phase.session_id,
                JointErrorRow.phase_id == phase.phase_id,
                JointErrorRow.reference == course.reference,
                JointErrorRow.axis == "angle",
            )
        ).all()
        known = [mean for mean in means if mean is not None]
        values = np.array(course.mean_rad, np.float64)
        assert len(known) == JOINTS
        assert np.average(values, weights=course.samples) == pytest.approx(
            np.mean(known), abs=1e-12
        )


def test_a_body_without_latency_has_no_error_at_any_time(performed: Performed, db: Session) -> None:
    """Joint error is zero in every bin at 0 ms and positive at 350 ms, to the wire's precision."""
    for phase, course in _courses(performed, db):
        if phase.kind == "task" and course.reference == "present":
            values = np.array(course.mean_rad, np.float64)
            if phase.latency_ms == 0.0:
                np.testing.assert_allclose(values, 0.0, atol=1e-3)
            else:
                assert values.min() > np.radians(0.5)
