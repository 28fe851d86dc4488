"""Tests of the course of a phase's joint error, from stored frames to stored rows."""

import time
from collections.abc import Sequence

import numpy as np
import pytest
from numpy.typing import NDArray
from sqlalchemy import delete, select

from app.features.record.telemetry.encoding import Frames
from app.features.record.telemetry.joint_errors import joint_error_rows
from app.features.record.telemetry.movement import Run
from app.features.record.telemetry.summaries import Summariser, replace_rows, summary_rows
from app.models import JointErrorCourseRow, JointErrorRow, Phase, PhaseQuality, StudySession
from app.science.joint_error import COURSE_BIN_S, ERROR_JOINTS
from app.science.rotations import FloatArray, from_rotation_vector, identity
from app.wire import VALUES_PER_FRAME
from tests.features.builders import SessionSpec, as_physics, build_session
from tests.features.lab import Lab
from tests.features.latency_builders import RATE_HZ, store_movement
from tests.features.session_filler import stable_id

JOINTS = len(ERROR_JOINTS)
BIN_FRAMES = round(COURSE_BIN_S * RATE_HZ)
GROWTH_RAD_PER_S = 0.01
WITHIN_S = 30.0


def _frames(rotations: FloatArray, times_s: FloatArray, active: NDArray[np.bool_]) -> Frames:
    values = np.zeros((len(times_s), VALUES_PER_FRAME), np.float32)
    values[:, 3:] = rotations.reshape(len(times_s), -1)
    return Frames(np.arange(len(times_s)), times_s, active.astype(np.uint8), values)


def _turned(
    angles_rad: FloatArray, active: NDArray[np.bool_], *, epoch: int = 1, begin_s: float = 9.0
) -> Run:
    """Return a run in which the target stands still and all avatar joints are off by an angle."""
    times_s = begin_s + np.arange(len(angles_rad)) / RATE_HZ
    vectors = np.zeros((len(angles_rad), 22, 3))
    vectors[:, :, 0] = angles_rad[:, np.newaxis]
    still = identity(len(angles_rad) * 22).reshape(-1, 22, 4)
    return Run(
        epoch,
        _frames(still, times_s, active),
        _frames(from_rotation_vector(vectors), times_s, active),
    )


def _present(runs: Sequence[Run], active_s: float) -> JointErrorCourseRow:
    phase = Phase(session_id="one", phase_id=1, latency_ms=0.0, active_s=active_s)
    rows = joint_error_rows(phase, runs)
    (course,) = (
        row for row in rows if isinstance(row, JointErrorCourseRow) and row.reference == "present"
    )
    return course


def _growing(frames: int) -> FloatArray:
    """Return angles (rad) that grow evenly over this many frames."""
    return GROWTH_RAD_PER_S / RATE_HZ * np.arange(frames, dtype=np.float64)


def _middles_rad(frames: int) -> list[float]:
    """Return the expected mean of an evenly growing error in each bin."""
    firsts = range(0, frames, BIN_FRAMES)
    ends = [min(first + BIN_FRAMES, frames) for first in firsts]
    return [
        GROWTH_RAD_PER_S * 0.5 * (first + end - 1) / RATE_HZ
        for first, end in zip(firsts, ends, strict=True)
    ]


def test_the_course_follows_a_growing_error() -> None:
    """The course of an evenly growing error has its mean in each bin, with a short last bin."""
    frames = round(22.0 * RATE_HZ)
    row = _present([_turned(_growing(frames), np.ones(frames, np.bool_))], 22.0)
    assert row.mean_rad == pytest.approx(_middles_rad(frames), abs=1e-6)
    assert row.samples == [BIN_FRAMES * JOINTS] * 4 + [round(2.0 * RATE_HZ) * JOINTS]
    assert row.bin_s == COURSE_BIN_S


def test_a_course_leaves_out_pauses_and_continues_after_a_restart() -> None:
    """The course leaves out pauses and continues after a restart of the headset."""
    frames, half = round(20.0 * RATE_HZ), round(10.0 * RATE_HZ)
    angles_rad = _growing(frames)
    pause = np.full(round(7.0 * RATE_HZ), 1.5)
    paused = np.concatenate((angles_rad[:half], pause, angles_rad[half:]))
    active = paused != 1.5
    whole = _present([_turned(paused, active)], 20.0)
    assert whole.mean_rad == pytest.approx(_middles_rad(frames), abs=1e-6)
    assert sum(whole.samples) == frames * JOINTS
    runs = [
        _turned(angles_rad[:half], np.ones(half, np.bool_)),
        _turned(angles_rad[half:], np.ones(half, np.bool_), epoch=2, begin_s=4000.0),
    ]
    # The last frame before the restart and the first after it show the same active time: up to two
    # frames fall into an earlier bin.
    parted = _present(runs, 20.0)
    assert parted.mean_rad == pytest.approx(whole.mean_rad, abs=2.5 * GROWTH_RAD_PER_S / RATE_HZ)
    assert sum(parted.samples) == frames * JOINTS


@pytest.fixture
def session_id(lab: Lab, request: pytest.FixtureRequest) -> str:
    """Return a session whose phases have ended, with errors and courses but without movement."""
    with lab.database.writing() as db:
        return build_session(db, SessionSpec(stable_id(request.node.name)[:12])).id


def _phases(lab: Lab, session_id: str) -> list[Phase]:
    with lab.database.reading() as db:
        found = select(Phase).where(Phase.session_id == session_id, Phase.kind == "task")
        return list(db.scalars(found.order_by(Phase.phase_id)))


def _stored(lab: Lab, phase: Phase) -> dict[str, JointErrorCourseRow]:
    with lab.database.reading() as db:
        found = select(JointErrorCourseRow).where(
            JointErrorCourseRow.session_id == phase.session_id,
            JointErrorCourseRow.phase_id == phase.phase_id,
        )
        return {row.reference: row for row in db.scalars(found)}


@pytest.mark.parametrize("avatar", ["delayed_copy", "physics"])
def test_the_mean_of_a_stored_course_is_the_mean_of_the_stored_errors(
    lab: Lab, session_id: str, avatar: str
) -> None:
    """The mean of a stored course equals the mean of the stored joint errors to 1e-12."""
    phase = _phases(lab, session_id)[0]
    with lab.database.writing() as db:
        if avatar == "physics":
            as_physics(db, db.get_one(StudySession, session_id))
        store_movement(db, phase, 0.125, duration_s=12.0)
    with lab.database.reading() as db:
        rows = summary_rows(db, session_id, phase.phase_id)
    with lab.database.writing() as db:
        replace_rows(db, session_id, phase.phase_id, rows)
    courses = _stored(lab, phase)
    assert set(courses) == {"present", "command"}
    for reference, course in courses.items():
        means = [mean for mean in course.mean_rad if mean is not None]
        assert len(means) == len(course.samples) == 3
        with lab.database.reading() as db:
            errors = select(JointErrorRow.mean_rad, JointErrorRow.samples).where(
                JointErrorRow.session_id == session_id,
                JointErrorRow.phase_id == phase.phase_id,
                JointErrorRow.reference == reference,
                JointErrorRow.axis == "angle",
            )
            of_joints = [(mean, n) for mean, n in db.execute(errors) if mean is not None]
        assert len(of_joints) == (JOINTS if avatar == "delayed_copy" else JOINTS - 2)
        assert sum(course.samples) == sum(n for _, n in of_joints)
        whole = np.average(means, weights=course.samples)
        # Every joint has the same number of samples, so the mean over joints is the same.
        assert whole == pytest.approx(np.mean([mean for mean, _ in of_joints]), abs=1e-12)


def _summarised_before_there_were_courses(lab: Lab, phases: Sequence[Phase]) -> None:
    with lab.database.writing() as db:
        for phase in phases:
            db.add(_quality(phase))
            db.execute(
                delete(JointErrorCourseRow).where(
                    JointErrorCourseRow.session_id == phase.session_id,
                    JointErrorCourseRow.phase_id == phase.phase_id,
                )
            )


def _quality(phase: Phase) -> PhaseQuality:
    counts = dict.fromkeys(("gaps", "jumps", "non_unit", "non_finite", "backwards"), 0)
    spans_s = dict.fromkeys(("gap_s", "longest_gap_s", "frozen_s"), 0.0)
    return PhaseQuality(
        session_id=phase.session_id,
        phase_id=phase.phase_id,
        stream="target",
        frames=720,
        span_s=8.0,
        frame_rate_hz=RATE_HZ,
        frozen_joints=[],
        **counts,
        **spans_s,
    )


def test_phases_of_an_older_version_get_their_courses_at_the_start(
    lab: Lab, session_id: str
) -> None:
    """At its start the summariser adds missing courses to phases whose movement is stored."""
    bare, moved, later = _phases(lab, session_id)[:3]
    _summarised_before_there_were_courses(lab, (bare, moved, later))
    with lab.database.writing() as db:
        store_movement(db, moved, 0.125)
        store_movement(db, later, 0.125, epoch=2)
    summariser = Summariser(lab.context)
    summariser.start()
    give_up_s = time.monotonic() + WITHIN_S
    while time.monotonic() < give_up_s and not _stored(lab, later):
        time.sleep(0.05)
    summariser.stop()
    for phase in (moved, later):
        courses = _stored(lab, phase)
        assert set(courses) == {"present", "command"}
        assert [sum(row.samples) for row in courses.values()] == [720 * JOINTS] * 2
    # It would have been computed before the others.
    assert _stored(lab, bare) == {}
    with lab.database.reading() as db:
        kept_quality = select(PhaseQuality.stream).where(
            PhaseQuality.session_id == session_id, PhaseQuality.phase_id == moved.phase_id
        )
        assert list(db.scalars(kept_quality)) == ["target"]
    with lab.database.reading() as db:
        kept = select(JointErrorRow.samples).where(
            JointErrorRow.session_id == session_id, JointErrorRow.phase_id == bare.phase_id
        )
        assert set(db.scalars(kept)) == {5400}
