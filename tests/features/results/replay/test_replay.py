"""Tests of replays over HTTP: positions, gaps, permissions and refusals."""

import json
import struct
from dataclasses import dataclass, replace
from datetime import timedelta

import numpy as np
import pytest
from numpy.typing import NDArray
from sqlalchemy import delete, select

from app.features.record.sessions import CALIBRATION, store_content
from app.features.record.sessions.engine.events import (
    AvatarBuilt,
    Event,
    PhaseStarted,
    SessionEnded,
)
from app.features.record.sessions.journal import append_events
from app.features.record.telemetry.frames import phase_frames
from app.features.results.replay.movement import (
    ROTATION_SCALE,
    Recording,
    encode,
    movement_of,
    placed_movement,
)
from app.features.results.replay.service import ReplayedBody
from app.models import Phase, SessionEvent, StudySession, TelemetryChunk, TelemetryStream
from app.science.joint_error import joint_errors
from app.science.rotations import normalise
from app.science.skeleton import JOINT_COUNT, JOINT_NAMES, build_skeleton, forward_kinematics
from app.wire import BODY_STREAMS, FINGER_STREAMS, StreamName
from tests.api.people import sign_in
from tests.features.builders import SessionSpec, build_session
from tests.features.lab import STUDY, Json, Lab, error, ok
from tests.features.latency_builders import HISTORY_S, RATE_HZ, store_movement
from tests.features.movement_builders import moving_values, store_chunks
from tests.features.session_filler import stable_id

LATENCY_S = 0.125
DURATION_S = 6.0
STATURE_M = 1.73
NEAREST_S = 0.5 / RATE_HZ + 1e-9


@dataclass(frozen=True)
class Decoded:
    """A movement decoded as documented, without the product's code."""

    header: Json
    bodies: dict[str, NDArray[np.float32]]
    errors_rad: NDArray[np.float32]


def decode(body: bytes) -> Decoded:
    """Decode the bytes of a movement."""
    (length,) = struct.unpack_from("<I", body)
    header = json.loads(body[4 : 4 + length])
    numbers = np.frombuffer(body, "<f4", offset=4 + length)
    frames, joints = header["frames"], len(header["names"])
    size = frames * joints * 3
    bodies = {
        name: numbers[at * size : (at + 1) * size].reshape(frames, joints, 3)
        for at, name in enumerate(header["bodies"])
    }
    errors = numbers[len(bodies) * size :]
    return Decoded(
        header, bodies, errors.reshape(header["error_frames"], len(header["error_joints"]))
    )


@pytest.fixture
def phase(lab: Lab, request: pytest.FixtureRequest) -> Phase:
    """Return the first hand phase of an ended session, with six seconds of movement."""
    with lab.database.writing() as db:
        session = build_session(db, SessionSpec(stable_id(request.node.name)[:12]))
        found = db.scalars(
            select(Phase)
            .where(Phase.session_id == session.id, Phase.limb == "hand")
            .order_by(Phase.phase_id)
            .limit(1)
        ).one()
        started_s = found.client_started_s or 0.0
        found.client_ended_s = started_s + DURATION_S
        found.active_s = DURATION_S
        store_movement(db, found, LATENCY_S, duration_s=DURATION_S, clock_s=started_s - HISTORY_S)
        return found


def path(phase: Phase, what: str = "replay") -> str:
    """Return the URL path of a phase's replay or movement."""
    return f"/api/sessions/{phase.session_id}/phases/{phase.phase_id}/{what}"


def placed(lab: Lab, phase: Phase, *, full: bool = True) -> Decoded:
    """Return the movement of a phase as it is sent to a page."""
    return decode(placed_movement(lab.database, phase.session_id, phase.phase_id, full=full))


def test_positions_are_those_of_the_nearest_stored_frame(lab: Lab, phase: Phase) -> None:
    """Positions at each moment are those of the nearest stored frame, at the matched height."""
    shown = placed(lab, phase)
    assert shown.header["rate_hz"] == 30.0
    assert shown.header["gaps"] == []
    skeleton = build_skeleton(STATURE_M)
    for body in ("target", "actual"):
        with lab.database.reading() as db:
            ((_, frames),) = phase_frames(db, phase.session_id, StreamName(body), phase.phase_id)
        times_s = frames.times_s - (phase.client_started_s or 0.0)
        expected = forward_kinematics(
            skeleton, frames.values[:, :3].astype(np.float64), frames.rotations
        ).positions_m
        for moment, place in enumerate(shown.bodies[body][:-1]):
            nearest = int(np.argmin(np.abs(times_s - moment / 30.0)))
            assert abs(times_s[nearest] - moment / 30.0) <= NEAREST_S
            np.testing.assert_allclose(place, expected[nearest], atol=1e-6)


@pytest.mark.one_engine
def test_a_replay_without_a_recorded_body_has_the_measured_arms(lab: Lab, phase: Phase) -> None:
    """Arms are as long as the calibration before the phase measured; a later one changes nothing.

    Lengths that no body has are left out.
    """
    started_at = phase.started_at
    assert started_at is not None
    for measured_m, minutes in ((0.3, -2), (50.0, 2)):
        with lab.database.writing() as db:
            report = {"stature_m": STATURE_M, "segments_m": {"upper_arm": measured_m}}
            made_at = started_at + timedelta(minutes=minutes)
            store_content(
                db,
                session_id=phase.session_id,
                kind=CALIBRATION,
                body=report,
                by="headset",
                now=made_at,
            )
        (shown,) = {
            tuple(_arm_lengths_m(placed(lab, phase), body)) for body in ("target", "actual")
        }
        assert shown == (0.3, round(0.146 * STATURE_M, 3))
    assert ReplayedBody(STATURE_M, {"upper_arm": 50.0}).skeleton().length_m(
        "LeftLowerArm"
    ) == pytest.approx(0.186 * STATURE_M)


def _arm_lengths_m(shown: Decoded, body: str) -> list[float]:
    """Return the lengths of upper arm and forearm in the first frame, to a millimetre."""
    joints = [JOINT_NAMES.index(f"Left{part}") for part in ("UpperArm", "LowerArm", "Hand")]
    places = shown.bodies[body][0][joints]
    return [round(float(one), 3) for one in np.linalg.norm(np.diff(places, axis=0), axis=1)]


@pytest.mark.one_engine
def test_rotations_follow_on_request(lab: Lab, phase: Phase) -> None:
    """On request the same movement has rotations after it, which lead to the same positions."""
    plain = lab.operator.get(path(phase, "movement")).content
    turned = lab.operator.get(f"{path(phase, 'movement')}?rotations=true").content
    (length,) = struct.unpack_from("<I", turned)
    assert json.loads(turned[4 : 4 + length])["rotations"] is True
    shown = decode(plain)
    rotation_bytes = sum(places.size // 3 * 8 for places in shown.bodies.values())
    numbers = turned[4 + length : -rotation_bytes]
    assert numbers == plain[-len(numbers) :]
    turns = np.frombuffer(turned[-rotation_bytes:], "<i2").reshape(2, -1, JOINT_COUNT, 4) / 32767.0
    for places, local in zip(shown.bodies.values(), turns, strict=True):
        skeleton = build_skeleton(STATURE_M)
        moved = forward_kinematics(skeleton, places[:, 0].astype(np.float64), local)
        np.testing.assert_allclose(moved.positions_m, places, atol=5e-4)


@pytest.mark.one_engine
def test_replayed_errors_are_the_joint_errors_of_the_frames(lab: Lab, phase: Phase) -> None:
    """The joint errors of a replay are those of the same frames, for every joint but the hips."""
    shown = placed(lab, phase)
    with lab.database.reading() as db:
        ((_, target),) = phase_frames(db, phase.session_id, StreamName.TARGET, phase.phase_id)
        ((_, actual),) = phase_frames(db, phase.session_id, StreamName.ACTUAL, phase.phase_id)
    angles = joint_errors(target.rotations, actual.rotations).values_rad[..., 0]
    every = round(RATE_HZ / shown.header["error_rate_hz"])
    expected = angles[::every]
    np.testing.assert_allclose(shown.errors_rad[: len(expected)], expected, atol=1e-6)
    assert shown.errors_rad.max() > 0.05


@pytest.mark.one_engine
def test_fingers_are_those_of_the_nearest_stored_frame(lab: Lab, phase: Phase) -> None:
    """A replay has the rotations of both bodies' fingers, on request and where recorded."""
    begin_s = phase.client_started_s or 0.0
    skeleton = build_skeleton(STATURE_M)
    asked = Recording(
        *(phase.session_id, phase.phase_id, {1: -begin_s}, DURATION_S, skeleton), rotations=True
    )
    with lab.database.reading() as db:
        assert movement_of(db, asked).fingers == {}
        ((_, body),) = phase_frames(db, phase.session_id, StreamName.ACTUAL, phase.phase_id)
    turned = normalise(np.random.default_rng(2).normal(size=(len(body), 30, 4)))
    values = turned.reshape(len(body), -1).astype(np.float32)
    values[90:, :60] = np.nan
    seqs = range(round(begin_s * RATE_HZ), round(begin_s * RATE_HZ) + len(body))
    with lab.database.writing() as db:
        for stream in FINGER_STREAMS:
            store_chunks(db, phase.session_id, stream, seqs, values, phase_id=phase.phase_id)
    with lab.database.reading() as db:
        movement = movement_of(db, asked)
        plain = movement_of(db, replace(asked, rotations=False))
    assert plain.fingers == {}
    shown = movement.fingers[StreamName.ACTUAL]
    np.testing.assert_allclose(shown[0] / ROTATION_SCALE, turned[0], atol=1e-4)
    # The left hand is not tracked after a second.
    late = round(2.0 * movement.grid.rate_hz)
    assert not shown[late, :15].any()
    assert shown[late, 15:].any()
    encoded = encode(movement)
    assert encoded.endswith(movement.fingers[StreamName.ACTUAL].astype("<i2").tobytes())
    assert b"RightLittleDistal" in encoded


@pytest.mark.one_engine
def test_unrecorded_time_is_a_gap(lab: Lab, phase: Phase) -> None:
    """Two seconds without frames are a gap in the replay, neither filled nor removed."""
    seqs = [*range(180), *range(360, 540)]
    with lab.database.writing() as db:
        for table in (TelemetryChunk, TelemetryStream):
            db.execute(delete(table).where(table.session_id == phase.session_id))
        db.merge(phase).client_started_s = 0.0
        for stream in BODY_STREAMS:
            values = moving_values(len(seqs), 1)
            store_chunks(db, phase.session_id, stream, seqs, values, phase_id=phase.phase_id)
    shown = placed(lab, phase)
    ((begin_s, end_s),) = shown.header["gaps"]
    assert (begin_s, end_s) == (pytest.approx(179 / 90, abs=1e-3), 4.0)
    existing: NDArray[np.bool_] = np.isfinite(shown.bodies["actual"].sum(axis=(1, 2)))
    moments_s = np.arange(existing.size) / shown.header["rate_hz"]
    half_step_s = 0.5 / shown.header["rate_hz"]
    inside = (moments_s > begin_s + half_step_s) & (moments_s < end_s - half_step_s)
    outside = (moments_s <= begin_s) | (moments_s >= end_s)
    assert not existing[inside].any()
    assert existing[outside & (moments_s < 539 / 90)].all()


@pytest.mark.one_engine
def test_a_body_of_later_was_not_worn_before(lab: Lab, phase: Phase) -> None:
    """A phase is replayed with the body recorded before it, not with one asked for later."""
    session_id, clock = phase.session_id, lab.context.clock

    def built(stature_m: float) -> Event:
        body = {"stature_m": stature_m, "model_hash": "0" * 64}
        now = clock.utc_now()
        made = store_content(
            db, session_id=session_id, kind="avatar", body=body, by="test", now=now
        )
        return AvatarBuilt(configuration_hash="0" * 64, **vars(made))

    with lab.database.writing() as db:
        db.execute(delete(SessionEvent).where(SessionEvent.session_id == session_id))
        started = PhaseStarted(phase_id=phase.phase_id, client_t_s=1.0)
        append_events(
            db,
            session_id=session_id,
            version=0,
            events=[built(1.9), started, built(0.6), SessionEnded(status="completed")],
            actor="test",
            command_id=None,
            clock=clock,
        )
    assert ok(lab.operator.get(path(phase)))["stature_m"] == 1.9


@pytest.mark.one_engine
def test_contacts_completions_and_forms_are_on_the_phases_time(lab: Lab, phase: Phase) -> None:
    """A replay has contacts, completed tasks and forms on the phase's time axis, and surfaces."""
    shown = ok(lab.operator.get(path(phase)))
    assert shown["view"] == "full"
    assert shown["duration_s"] == pytest.approx(DURATION_S, abs=0.02)
    assert shown["stature_m"] == STATURE_M
    panels = [one for one in shown["contacts"] if one["surface_kind"] == "panel"]
    assert [(one["effect"], one["begin_s"], one["end_s"]) for one in panels] == [
        ("green", 5.0, 5.5)
    ]
    assert {one["surface"] for one in shown["contacts"]} <= {
        one["key"] for one in shown["surfaces"]
    }
    assert [one["number"] for one in shown["completions"]] == [1, 2, 3]
    with lab.database.reading() as db:
        session = db.get_one(StudySession, phase.session_id)
    steps = {step["index"]: step for step in lab.view(session.id)["steps"]}
    following = [steps[one["step_index"]] for one in shown["forms"]]
    assert following
    assert {step["block"] for step in following} == {steps[phase.step_index]["block"]}


def test_unchanged_movement_is_not_sent_again(lab: Lab, phase: Phase) -> None:
    """A page that already has the movement gets 304 until more is stored."""
    first = lab.operator.get(path(phase, "movement"))
    assert first.content == placed_movement(
        lab.database, phase.session_id, phase.phase_id, full=True
    )
    tag = {"if-none-match": first.headers["etag"]}
    assert lab.operator.get(path(phase, "movement"), headers=tag).status_code == 304
    with lab.database.writing() as db:
        store_movement(db, db.merge(phase), LATENCY_S, duration_s=1.0, epoch=2)
    later = lab.operator.get(path(phase, "movement"), headers=tag)
    assert later.status_code == 200
    assert later.headers["etag"] != first.headers["etag"]


@pytest.mark.one_engine
def test_a_phase_is_replayed_once_it_is_over(lab: Lab, phase: Phase) -> None:
    """A running phase has no replay; the error for an unknown phase lists the existing ones."""
    with lab.database.writing() as db:
        db.merge(phase).status = "running"
    for what in ("replay", "movement"):
        assert error(lab.operator.get(path(phase, what)), 409, "not_now")["value"] == "running"
    unknown = f"/api/sessions/{phase.session_id}/phases/99/replay"
    assert phase.phase_id in error(lab.operator.get(unknown), 404, "not_found")["valid"]


@pytest.mark.one_engine
def test_a_blinded_replay_shows_the_participant_only(fresh_lab: Lab) -> None:
    """A blinded replay shows only the participant, as the avatar reveals the latency."""
    yaml = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}"))["yaml"]
    blinded = yaml.replace("operator: false", "operator: true")
    ok(fresh_lab.operator.post(f"/api/studies/{STUDY}/versions", json={"yaml": blinded}))
    with fresh_lab.database.writing() as db:
        session = build_session(db, SessionSpec("P-0001", status="active"))
        phase = db.scalars(
            select(Phase).where(Phase.session_id == session.id, Phase.limb == "hand").limit(1)
        ).one()
        clock_s = (phase.client_started_s or 0.0) - HISTORY_S
        store_movement(db, phase, LATENCY_S, duration_s=2.0, clock_s=clock_s)
    operator = replace(fresh_lab, operator=sign_in(fresh_lab, "operator"))
    for reader in (fresh_lab, operator):
        shown = ok(reader.operator.get(path(phase)))
        assert shown["view"] == "participant"
        assert shown["latency_ms"] is None
        assert [shown[name] for name in ("contacts", "completions", "surfaces")] == [[], [], []]
        movement = decode(reader.operator.get(path(phase, "movement")).content)
        assert movement.header["bodies"] == ["target"]
        assert movement.errors_rad.size == 0
        assert np.isfinite(movement.bodies["target"][:50]).all()
    with fresh_lab.database.writing() as db:
        db.merge(session).status = "completed"
    assert ok(fresh_lab.operator.get(path(phase)))["view"] == "full"
    assert ok(operator.operator.get(path(phase)))["view"] == "participant"
