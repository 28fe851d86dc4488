"""Tests of a phase's joint errors, from stored frames to stored rows."""

import subprocess
import sys
from collections.abc import Sequence

import numpy as np
import pytest
from sqlalchemy import select

from app.features.record.telemetry.summaries import replace_rows, summary_rows
from app.models import JointErrorRow, Phase, PhaseLatency, StudySession
from app.science.avatar.body import AXIS_NAMES
from app.science.avatar.mjcf import default_configuration
from app.science.avatar.targets import TargetAngles, joint_rotations
from app.science.joint_error import ERROR_AXES, ERROR_JOINTS, joint_error_summary
from app.science.rotations import FloatArray
from app.wire import StreamName
from tests.features.builders import SessionSpec, as_physics, build_session
from tests.features.lab import Lab
from tests.features.latency_builders import HISTORY_S, RATE_HZ, store_movement, store_stream
from tests.features.session_filler import stable_id
from tests.science.moving_bodies import delayed_copy, made_movement

LATENCY_S = 0.125
DURATION_S = 8.0
BEFORE = round(HISTORY_S * RATE_HZ)
Rows = dict[tuple[str, str, str], JointErrorRow]


@pytest.fixture
def session_id(lab: Lab, request: pytest.FixtureRequest) -> str:
    """Return a session with a delayed copy whose phases have ended without summaries."""
    with lab.database.writing() as db:
        return build_session(db, SessionSpec(stable_id(request.node.name)[:12])).id


@pytest.fixture
def physics_id(lab: Lab, session_id: str) -> str:
    """Return the session with the shipped physics avatar instead of a delayed copy."""
    with lab.database.writing() as db:
        as_physics(db, db.get_one(StudySession, session_id))
    return session_id


def _phase(lab: Lab, session_id: str) -> Phase:
    with lab.database.reading() as db:
        return db.scalars(
            select(Phase).where(
                Phase.session_id == session_id,
                Phase.kind == "task",
                Phase.latency_ms == 1000.0 * LATENCY_S,
                Phase.limb == "hand",
            )
        ).one()


def _summarised(lab: Lab, phase: Phase) -> tuple[Rows, PhaseLatency]:
    """Compute and store a phase's summary; return its rows as read back."""
    with lab.database.reading() as db:
        rows = summary_rows(db, phase.session_id, phase.phase_id)
    with lab.database.writing() as db:
        replace_rows(db, phase.session_id, phase.phase_id, rows)
    with lab.database.reading() as db:
        stored = db.scalars(
            select(JointErrorRow).where(
                JointErrorRow.session_id == phase.session_id,
                JointErrorRow.phase_id == phase.phase_id,
            )
        )
        errors = {(row.reference, row.joint, row.axis): row for row in stored}
        return errors, db.get_one(PhaseLatency, (phase.session_id, phase.phase_id))


def _target() -> tuple[FloatArray, FloatArray]:
    """Return times and rotations of a body that swings far, in single precision."""
    times_s = np.arange(0.0, HISTORY_S + DURATION_S, 1.0 / RATE_HZ)
    rotations = made_movement(np.random.default_rng(3))(times_s)
    return times_s, rotations.astype(np.float32).astype(np.float64)


def _store(lab: Lab, phase: Phase, times_s: FloatArray, streams: Sequence[FloatArray]) -> None:
    with lab.database.writing() as db:
        for stream, rotations in zip((StreamName.TARGET, StreamName.ACTUAL), streams, strict=True):
            store_stream(db, phase, stream, 1, times_s, rotations, BEFORE)


def test_a_physics_avatars_error_is_against_its_commanded_angles(lab: Lab, physics_id: str) -> None:
    """A physics avatar that reaches each clamped angle late has no error at free joints."""
    phase = _phase(lab, physics_id)
    times_s, target = _target()
    angles = TargetAngles(default_configuration().in_force).batch(target)
    shift = LATENCY_S * RATE_HZ
    late = np.maximum(np.arange(len(times_s)) - shift, 0.0)
    before, after = np.floor(late).astype(int), np.ceil(late).astype(int)
    share = (late - before)[:, np.newaxis]
    actual = joint_rotations(
        (1.0 - share) * angles.angles_rad[before] + share * angles.angles_rad[after], target[:, 0]
    )
    _store(lab, phase, times_s, (target, actual))
    rows, latency = _summarised(lab, phase)
    assert latency.achieved_s == pytest.approx(LATENCY_S, abs=0.002)
    counted = np.arange(BEFORE, len(times_s))
    nearest = np.round(late).astype(int)[counted]
    for joint, axis in (("Head", "x"), ("LeftLowerLeg", "x"), ("RightUpperArm", "z")):
        clipped = angles.clipped[:, AXIS_NAMES.index(f"{joint}{axis.upper()}")]
        assert rows["present", joint, axis].clipped_share == clipped[counted].mean()
        assert rows["command", joint, axis].clipped_share == clipped[nearest].mean()
    # The locked third axis of an elbow is commanded as well.
    free = [
        row
        for (reference, joint, axis), row in rows.items()
        if (reference, axis) == ("command", "angle")
        and row.clipped_share == 0.0
        and "LowerArm" not in joint
    ]
    assert free
    assert max(row.max_rad or 0.0 for row in free) < 0.01
    assert {rows["command", "Head", axis].samples for axis in ERROR_AXES} == {len(counted)}
    for axis in ERROR_AXES:
        shoulder = rows["command", "LeftShoulder", axis]
        assert (shoulder.rms_rad, shoulder.clipped_share) == (None, None)
        assert (shoulder.samples, shoulder.excluded) == (0, 0)


@pytest.mark.one_engine
def test_a_delayed_copys_errors_are_those_of_its_rotations(lab: Lab, session_id: str) -> None:
    """The joint errors of a delayed copy are those of its rotations, without clipped shares."""
    phase = _phase(lab, session_id)
    with lab.database.writing() as db:
        store_movement(db, phase, LATENCY_S)
    rows, _ = _summarised(lab, phase)
    times_s = np.arange(0.0, HISTORY_S + 8.0, 1.0 / RATE_HZ)
    run = delayed_copy(times_s, made_movement(np.random.default_rng(1))(times_s), LATENCY_S)
    raw = run.target_rotations.astype(np.float32).astype(np.float64)
    actual = run.actual_rotations.astype(np.float32).astype(np.float64)
    summary = joint_error_summary(raw[BEFORE:], actual)
    for joint_index, joint in enumerate(ERROR_JOINTS):
        for axis_index, axis in enumerate(ERROR_AXES):
            row = rows["present", joint, axis]
            assert row.clipped_share is None
            assert row.rms_rad == summary.rms_rad[joint_index, axis_index]
            assert row.mean_rad == summary.mean_rad[joint_index, axis_index]
    assert {row.clipped_share for row in rows.values()} == {None}


@pytest.mark.one_engine
def test_a_server_without_physics_loads_no_compiler() -> None:
    """A server that needs no physics loads neither MuJoCo nor the numba compiler."""
    lines = (
        "import sys, app.main, app.features.record.telemetry.summaries; "
        "print([name for name in ('numba', 'llvmlite', 'mujoco') if name in sys.modules])"
    )
    result = subprocess.run(
        [sys.executable, "-c", lines], capture_output=True, text=True, check=True
    )
    assert result.stdout.strip() == "[]"
