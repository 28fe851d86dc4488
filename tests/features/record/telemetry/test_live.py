"""Tests of the figures that the cockpit shows while a phase runs."""

import math

import numpy as np
import pytest

from app.features.record.telemetry.live import LiveTelemetry, live_telemetry
from app.science.avatar.body import PART_NAMES
from app.science.avatar.configuration import ANATOMIC
from app.science.avatar.targets import HingeReference, TargetAngles, joint_rotations
from app.science.rotations import FloatArray, from_rotation_vector, identity
from app.science.skeleton import JOINT_COUNT, JOINT_INDEX
from app.wire import (
    VALUES_PER_FRAME,
    ContactReport,
    Report,
    StreamName,
    decode_batch,
    encode_batch,
)
from tests.features.builders import SessionSpec, as_physics, build_session
from tests.features.lab import Lab
from tests.rehearsal.orders import order
from tests.wire.message_vectors import COMPLETION
from tests.wire.samples import message, standing


def live_errors_deg(
    live: LiveTelemetry, target: FloatArray, actual: FloatArray, now_s: float = 1.0
) -> dict[str, float]:
    """Return the live joint errors of one frame of both streams."""
    for stream, rotations in ((StreamName.TARGET, target), (StreamName.ACTUAL, actual)):
        values = np.zeros((1, VALUES_PER_FRAME), np.float32)
        values[0, 3:] = rotations.reshape(-1)
        message = encode_batch(
            stream,
            epoch=1,
            phase_id=1,
            seq_first=0,
            times_s=np.array([0.5]),
            flags=np.ones(1, np.uint8),
            values=values,
            active_s=0.5,
            closed_at_s=0.6,
        )
        live.take(decode_batch(message))
    figures = live.figures(now_s)
    assert figures is not None
    return dict(figures["joint_error_deg"])


def test_completions_are_told_to_a_blinded_reader_on_a_beat_of_ten_seconds() -> None:
    """The number for blinded readers rises at the next full 10 s, and not when a task is done."""
    live = LiveTelemetry()
    told = []
    for at_s, done in ((1.0, 0), (3.0, 1), (9.9, 2), (10.2, 2), (19.0, 3), (20.0, 3)):
        if done:
            body = {**COMPLETION, "phase_id": 1, "number": done}
            live.count(Report.model_validate({"epoch": 1, "seq": done, "body": body}))
        live.take(
            decode_batch(message(standing(1), stream=StreamName.ACTUAL, phase_id=1, active_s=at_s))
        )
        figures = live.figures(at_s)
        assert figures is not None
        told.append((figures["completions"], figures["completions_on_beat"]))
    assert told == [(0, 0), (1, 0), (2, 0), (2, 2), (3, 2), (3, 3)]


def shrug() -> FloatArray:
    """Return a pose with the left shoulder raised by 20 degrees."""
    pose = identity(JOINT_COUNT)
    raised = np.array((0.0, 0.0, -math.radians(20.0)))
    pose[JOINT_INDEX["LeftShoulder"]] = from_rotation_vector(raised)
    return pose


def test_live_errors_are_of_the_raw_rotations_of_a_delayed_copy() -> None:
    """A delayed copy's live error is that of its rotations, here at one shoulder only."""
    reported = live_errors_deg(LiveTelemetry(), shrug(), identity(JOINT_COUNT))
    assert reported.pop("LeftShoulder") == pytest.approx(20.0, abs=0.01)
    assert max(reported.values()) < 0.1


def test_a_physics_avatars_live_errors_are_against_its_commanded_angles() -> None:
    """A physics avatar's live error is against its commanded angles, as in the stored rows."""
    pose = shrug()
    live = LiveTelemetry(hinges=HingeReference(ANATOMIC))
    expected = TargetAngles(ANATOMIC).follow(pose).unclamped_rad
    reported = live_errors_deg(live, pose, joint_rotations(expected, pose[0]))
    assert {joint for joint, error in reported.items() if error is None} == {
        "LeftShoulder",
        "RightShoulder",
    }
    assert max(error for error in reported.values() if error is not None) < 0.1
    late = live_errors_deg(
        LiveTelemetry(hinges=HingeReference(ANATOMIC)), pose, identity(JOINT_COUNT)
    )
    assert late["LeftUpperArm"] == pytest.approx(20.0, abs=0.01)


def test_a_connection_gets_the_hinges_of_its_session(lab: Lab) -> None:
    """A headset connection uses the hinges of its session's avatar; a delayed copy has none."""
    with lab.database.writing() as db:
        copy = build_session(db, SessionSpec("P-live-copy")).id
        physics = build_session(db, SessionSpec("P-live-physics"))
        as_physics(db, physics)
        moved = physics.id
    with lab.database.reading() as db:
        assert live_telemetry(db, copy).hinges is None
        assert live_telemetry(db, moved).hinges is not None


def test_live_errors_are_of_the_body_that_is_worn() -> None:
    """A named body without a neck has no error there; the configuration's body has one."""
    parts = [part for part in PART_NAMES if part != "Neck"]
    live = LiveTelemetry(HingeReference(ANATOMIC), {"short": HingeReference(ANATOMIC, parts)})
    pose = identity(JOINT_COUNT)
    assert live_errors_deg(live, pose, pose)["Neck"] == pytest.approx(0.0, abs=0.1)
    # The participant stays in the body between phases.
    for now_s, worn in ((2.0, order(body="short")), (3.0, None)):
        live.wear(worn)
        assert live.worn_hinges is live.hinges_by_body["short"]
        assert live_errors_deg(live, pose, pose, now_s)["Neck"] is None
    live.wear(order())
    assert live_errors_deg(live, pose, pose, 4.0)["Neck"] == pytest.approx(0.0, abs=0.1)


def test_a_connection_gets_the_hinges_of_the_named_bodies(lab: Lab) -> None:
    """A connection has hinges for each body that conditions name, next to its own body's."""
    with lab.database.writing() as db:
        session = build_session(db, SessionSpec("P-live-bodies"))
        as_physics(db, session)
        session_id = session.id
    with lab.database.reading() as db:
        live = live_telemetry(db, session_id, ("female", "male"))
    assert set(live.hinges_by_body) == {"female", "male"}
    assert live.hinges is not None


def test_side_contacts_are_counted_with_their_time_as_they_end() -> None:
    """Two parts on one side at the same time are one contact, as in the record."""
    live = LiveTelemetry()
    live_errors_deg(live, identity(JOINT_COUNT), identity(JOINT_COUNT))
    for seq, (begin_s, end_s) in enumerate([(1.0, 2.0), (1.5, 2.5), (4.0, 4.25)]):
        contact = ContactReport(
            phase_id=1,
            surface="hand/1/left",
            surface_kind="side",
            body_part=("LeftHand", "LeftLowerArm", "LeftHand")[seq],
            begin_s=begin_s,
            end_s=end_s,
            begin_active_s=begin_s,
            end_active_s=end_s,
            effect="side",
        )
        live.count(Report(epoch=1, seq=seq, body=contact))
    figures = live.figures(2.0)
    assert figures is not None
    assert (figures["side_contacts"], figures["side_contact_s"]) == (2, 1.75)
