"""Tests of the streams of fingers, from stored frames to joint errors and quality."""

import numpy as np
import pytest
from numpy.typing import NDArray
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.record.telemetry.encoding import ENCODING, decode_frames, encode_frames
from app.features.record.telemetry.summaries import summary_rows
from app.models import JointErrorRow, Phase, PhaseQuality
from app.science.joint_error import ERROR_JOINTS, ERROR_JOINTS_WITH_FINGERS
from app.science.rotations import from_rotation_vector, multiply
from app.science.simulation import SimulatedFingers
from app.science.skeleton import FINGER_PARTS
from app.wire import StreamName, flag_frames
from tests.features.builders import SessionSpec, build_session
from tests.features.lab import Lab
from tests.features.latency_builders import HISTORY_S, RATE_HZ, store_stream
from tests.features.movement_builders import store_chunks
from tests.features.record.telemetry.plain_decoder import decode_plainly
from tests.features.session_filler import stable_id
from tests.science.moving_bodies import made_movement
from tests.wire.samples import bits, resting_fingers, without_left_hand

LATENCY_S = 0.1
FRAMES = 720
BEND_RAD = np.radians(10.0)
THUMB = FINGER_PARTS.index("RightThumbDistal")


def moving_fingers(count: int) -> NDArray[np.float32]:
    """Return generated frames (count, 120) at 90 Hz."""
    hands = SimulatedFingers(np.random.default_rng(8))
    poses = [hands.pose(frame / RATE_HZ).ravel() for frame in range(count)]
    return np.stack(poses).astype(np.float32)


@pytest.mark.one_engine
def test_frames_of_fingers_are_stored_bit_by_bit() -> None:
    """A chunk of fingers holds every bit, and the document's own decoder reads the same."""
    values = moving_fingers(30)
    values[3, 5] = np.nan
    values[10:14] = without_left_hand(values[10:14])
    times_s, flags = np.arange(30) / RATE_HZ, np.ones(30, np.uint8)
    data = encode_frames(times_s, flags, values)
    frames = decode_frames(
        data, encoding=ENCODING, seq_first=0, frame_count=30, values_per_frame=120
    )
    assert np.array_equal(bits(frames.values), bits(values))
    assert frames.rotations.shape == (30, 30, 4)
    assert decode_plainly(data).values == bits(values).tolist()


@pytest.mark.one_engine
def test_a_hand_that_is_not_tracked_is_no_fault() -> None:
    """Only a hand of which some values are not numbers is flagged, not one without any."""
    values = resting_fingers(4)
    values[1] = without_left_hand(values)[1]
    values[2, 7] = np.nan
    values[3, 8] = 1.5
    flags = flag_frames(np.arange(4.0), values)
    assert flags.non_finite.tolist() == [False, False, True, False]
    assert flags.non_unit.tolist() == [False, False, False, True]


def hand_task(db: Session, request: pytest.FixtureRequest) -> Phase:
    """Return the first hand task of a new session."""
    session_id = build_session(db, SessionSpec(stable_id(request.node.name)[:12])).id
    phase = db.scalars(
        select(Phase).where(
            Phase.session_id == session_id, Phase.limb == "hand", Phase.kind == "task"
        )
    ).first()
    assert phase is not None
    return phase


def test_each_finger_part_has_its_own_joint_error(lab: Lab, request: pytest.FixtureRequest) -> None:
    """A thumb bent 10 degrees too far has that error, the only one against the delayed command."""
    with lab.database.writing() as db:
        phase = hand_task(db, request)
        session_id = phase.session_id
        phase.latency_ms = 1000.0 * LATENCY_S
        before = round(HISTORY_S * RATE_HZ)
        times_s = np.arange(before + FRAMES) / RATE_HZ
        body = made_movement(np.random.default_rng(3))(times_s)
        for stream in (StreamName.TARGET, StreamName.ACTUAL):
            store_stream(db, phase, stream, 1, times_s, body, before)
        target = moving_fingers(len(times_s))
        late = np.maximum(np.arange(len(times_s)) - round(LATENCY_S * RATE_HZ), 0)
        actual = target[late].reshape(-1, 30, 4).astype(np.float64)
        bend = from_rotation_vector(np.array([0.0, BEND_RAD, 0.0]))
        actual[:, THUMB] = multiply(actual[:, THUMB], bend)
        shown = actual.reshape(len(times_s), -1).astype(np.float32)
        shown[before : before + 90] = without_left_hand(shown[before : before + 90])
        for stream, values in (
            (StreamName.TARGET_FINGERS, target),
            (StreamName.ACTUAL_FINGERS, shown),
        ):
            for own, of in ((slice(0, before), 0), (slice(before, None), phase.phase_id)):
                seqs = list(range(len(times_s))[own])
                store_chunks(db, session_id, stream, seqs, values[own], phase_id=of)
        rows = summary_rows(db, session_id, phase.phase_id)
    errors = {
        (row.reference, row.joint): row
        for row in rows
        if isinstance(row, JointErrorRow) and row.axis == "angle"
    }
    assert {joint for _, joint in errors} == set(ERROR_JOINTS_WITH_FINGERS)
    thumb = errors["command", "RightThumbDistal"]
    assert thumb.mean_rad == pytest.approx(BEND_RAD, abs=1e-4)
    assert (thumb.samples, thumb.excluded) == (FRAMES, 0)
    others = [errors["command", part].mean_rad for part in FINGER_PARTS if part != thumb.joint]
    assert max(one or 0.0 for one in others) < 1e-4
    assert (errors["present", "RightIndexProximal"].mean_rad or 0.0) > 0.01
    # A hand that is not tracked has no error, and is no fault.
    untracked = errors["command", "LeftIndexProximal"]
    assert (untracked.samples, untracked.excluded) == (FRAMES - 90, 90)
    quality = {row.stream: row for row in rows if isinstance(row, PhaseQuality)}
    assert quality["actual_fingers"].non_finite == 0
    assert quality["actual_fingers"].frames == FRAMES
    assert len(ERROR_JOINTS) + len(FINGER_PARTS) == len(ERROR_JOINTS_WITH_FINGERS)


@pytest.mark.one_engine
def test_a_phase_is_summarised_although_only_one_run_had_fingers(
    lab: Lab, request: pytest.FixtureRequest
) -> None:
    """A phase has all summaries if the headset restarts without hand tracking in it."""
    with lab.database.writing() as db:
        phase = hand_task(db, request)
        before = round(HISTORY_S * RATE_HZ)
        times_s = np.arange(before + FRAMES) / RATE_HZ
        body = made_movement(np.random.default_rng(3))(times_s)
        fingers = moving_fingers(len(times_s))
        for epoch in (1, 2):
            for stream in (StreamName.TARGET, StreamName.ACTUAL):
                store_stream(db, phase, stream, epoch, times_s, body, before)
        for stream in (StreamName.TARGET_FINGERS, StreamName.ACTUAL_FINGERS):
            for own, of in ((slice(0, before), 0), (slice(before, None), phase.phase_id)):
                seqs = list(range(len(times_s))[own])
                store_chunks(db, phase.session_id, stream, seqs, fingers[own], phase_id=of)
        rows = summary_rows(db, phase.session_id, phase.phase_id)
    counts = {
        row.joint: (row.samples, row.excluded)
        for row in rows
        if isinstance(row, JointErrorRow) and (row.reference, row.axis) == ("present", "angle")
    }
    assert counts["Head"] == (2 * FRAMES, 0)
    assert counts["RightThumbDistal"] == (FRAMES, FRAMES)
    frames = {row.stream: row.frames for row in rows if isinstance(row, PhaseQuality)}
    assert (frames["actual"], frames["actual_fingers"]) == (2 * FRAMES, FRAMES)
