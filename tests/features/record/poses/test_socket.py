"""Tests of the socket on which a console watches a session's movement."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from starlette.testclient import WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

from app.features.movement.avatar import SHIPPED, configuration_by_hash, version_of
from app.features.record.headset.poses import HEADER, PoseFeed
from app.features.record.poses.endpoints import MAX_UNDRAWN
from app.features.record.sessions import CALIBRATION, store_content
from app.models import StudySession
from app.science.rotations import FloatArray
from app.science.skeleton import JOINT_NAMES, build_skeleton
from app.wire import FINGER_STREAMS, Batch, StreamName, decode_batch
from tests.features.builders import as_physics
from tests.features.lab import STUDY, Json, Lab, ok
from tests.features.record.poses.test_feed import contact
from tests.wire.samples import message, resting_fingers, standing

PATIENCE_S = 10.0
STATURE_M = 1.81


@contextmanager
def watching(lab: Lab, session_id: str) -> Iterator[WebSocketTestSession]:
    """Open a console's socket for a session."""
    with lab.operator.websocket_connect(f"/api/sessions/{session_id}/pose") as socket:
        yield socket


def feed_of(lab: Lab, session_id: str) -> PoseFeed:
    """Wait until a console listens to a session and return a feed for it."""
    until_s = time.monotonic() + PATIENCE_S
    while not lab.context.hub.has_listeners(session_id, "pose_target"):
        assert time.monotonic() < until_s
        time.sleep(0.005)
    return PoseFeed(lab.context.hub, session_id)


def batch(seq: int, stream: StreamName = StreamName.TARGET) -> Batch:
    """Return a batch of one frame."""
    values = resting_fingers(1) if stream in FINGER_STREAMS else standing(1)
    return decode_batch(message(values, stream=stream, seq_first=seq))


def seq_of(pose: bytes) -> int:
    """Return the seq of the frame in a pose message."""
    return int(HEADER.unpack_from(pose)[5])


def blinded_session(lab: Lab) -> str:
    """Return an active session of a study whose operators are blinded."""
    yaml = ok(lab.operator.get(f"/api/studies/{STUDY}"))["yaml"]
    blinded = yaml.replace("operator: false", "operator: true")
    ok(lab.operator.post(f"/api/studies/{STUDY}/versions", json={"yaml": blinded}))
    return str(lab.skip_to(lab.join(), "block1.hand")["id"])


def test_a_console_receives_the_body_and_the_tasks_surfaces(lab: Lab) -> None:
    """A console receives the participant's skeleton and the surfaces of the current task."""
    view = lab.join()
    with watching(lab, view["id"]) as socket:
        setup: Json = socket.receive_json()
        assert (setup["limb"], setup["surfaces"], setup["recording"]) == (None, [], False)
        assert tuple(setup["joints"]) == JOINT_NAMES
        assert np.allclose(setup["offsets_m"], build_skeleton(1.72).offsets_m)
        assert setup["stature_known"] is False
        view = lab.skip_to(view, "height")
        lab.command(view, "complete_step", height_m={"stated": 1.8, "matched": 1.81})
        while not setup["stature_known"]:
            setup = socket.receive_json()
        assert np.allclose(setup["offsets_m"], build_skeleton(1.81).offsets_m)
        lab.skip_to(lab.view(view["id"]), "block1.hand")
        while setup["limb"] is None:
            setup = socket.receive_json()
        kinds = [surface["kind"] for surface in setup["surfaces"]]
        assert {"panel", "side", "target"} == set(kinds)
        assert all(surface["key"].startswith("hand/") for surface in setup["surfaces"])


@pytest.mark.one_engine
def test_a_plain_body_is_drawn_with_the_arms_that_were_measured_last(lab: Lab) -> None:
    """The live figures' arms are the newest calibration's; lengths that no body has are left out.

    The stature stays then. A body with a model keeps its own proportions.
    """
    view = lab.skip_to(lab.join(), "height")
    lab.command(view, "complete_step", height_m={"stated": 1.8, "matched": STATURE_M})
    session_id = str(view["id"])
    usual_m = arm_lengths_m(build_skeleton(STATURE_M).offsets_m)
    measured = {"upper_arm": 0.31, "forearm": 0.25}
    shown = [drawn_arms_m(lab, session_id)]
    for segments_m in ({"upper_arm": 0.4}, measured, {"upper_arm": 50.0}, measured):
        with lab.database.writing() as db:
            store_content(
                db,
                session_id=session_id,
                kind=CALIBRATION,
                body={"segments_m": segments_m},
                by="headset",
                now=lab.context.clock.utc_now(),
            )
        shown.append(drawn_arms_m(lab, session_id))
    expected = [usual_m, (0.4, usual_m[1]), (0.31, 0.25), usual_m, (0.31, 0.25)]
    np.testing.assert_allclose(shown, expected)
    with lab.database.writing() as db:
        as_physics(db, db.get_one(StudySession, session_id))
    np.testing.assert_allclose(drawn_arms_m(lab, session_id), usual_m)


def drawn_arms_m(lab: Lab, session_id: str) -> tuple[float, float]:
    """Return the lengths of upper arm and forearm that a console is told to draw."""
    with watching(lab, session_id) as socket:
        return arm_lengths_m(np.array(socket.receive_json()["offsets_m"]))


def arm_lengths_m(offsets_m: FloatArray) -> tuple[float, float]:
    """Return the lengths of the left upper arm and forearm, which are the right ones', too."""
    left, right = (
        [np.linalg.norm(offsets_m[JOINT_NAMES.index(side + part)]) for part in ("LowerArm", "Hand")]
        for side in ("Left", "Right")
    )
    np.testing.assert_allclose(left, right)
    return float(left[0]), float(left[1])


@pytest.mark.one_engine
def test_only_a_console_that_is_not_blinded_learns_the_body(fresh_lab: Lab) -> None:
    """The setup names the model that the avatar wears, but not to a blinded console."""
    open_session, blinded = str(fresh_lab.join()["id"]), blinded_session(fresh_lab)
    with fresh_lab.database.writing() as db:
        for session_id in (open_session, blinded):
            as_physics(db, db.get_one(StudySession, session_id))
        worn = configuration_by_hash(db, version_of(db, SHIPPED, None).content_hash).humanoid
        assert worn is not None
    with watching(fresh_lab, open_session) as socket:
        assert socket.receive_json()["body"] == {"hash": worn}
    with watching(fresh_lab, blinded) as socket:
        setup = socket.receive_json()
        assert (setup["blinded"], setup["body"]) == (True, None)


def test_both_figures_and_the_touches_reach_an_open_console(lab: Lab) -> None:
    """An open console receives the poses of both streams and the touches."""
    session_id = lab.join()["id"]
    with watching(lab, session_id) as socket:
        socket.receive_json()
        feed = feed_of(lab, session_id)
        feed.take(batch(5), 1.0)
        assert seq_of(socket.receive_bytes()) == 5
        feed.take(batch(6, StreamName.ACTUAL), 1.0)
        reported = socket.receive_bytes()
        assert (seq_of(reported), HEADER.unpack_from(reported)[1]) == (6, 2)
        feed.report(contact(3))
        touches = socket.receive_json()
        assert touches["type"] == "touches"
        assert touches["touches"][0]["surface"] == "hand/1/panel"


@pytest.mark.one_engine
def test_a_blinded_console_gets_the_avatar_once_the_condition_is_shown(fresh_lab: Lab) -> None:
    """A blinded console gets neither avatar nor contacts until the condition is shown."""
    session_id = blinded_session(fresh_lab)
    with watching(fresh_lab, session_id) as socket:
        assert socket.receive_json()["blinded"] is True
        feed = feed_of(fresh_lab, session_id)
        feed.take(batch(1, StreamName.ACTUAL), 1.0)
        feed.report(contact(1))
        feed.take(batch(2), 1.0)
        assert seq_of(socket.receive_bytes()) == 2
        path = f"/api/sessions/{session_id}/reveal"
        ok(fresh_lab.operator.post(path, json={"reason": "the participant is unwell"}))
        assert socket.receive_json()["blinded"] is False
        feed.take(batch(3, StreamName.ACTUAL), 2.0)
        assert seq_of(socket.receive_bytes()) == 3


@pytest.mark.one_engine
def test_a_console_that_stops_drawing_resumes_with_the_newest_frame(lab: Lab) -> None:
    """A console that stops confirming frames gets only a few more, and later the newest one."""
    session_id = lab.join()["id"]
    with watching(lab, session_id) as socket:
        socket.receive_json()
        feed = feed_of(lab, session_id)
        last = MAX_UNDRAWN - 1
        for seq in range(last):
            feed.take(batch(seq), float(seq))
            assert seq_of(socket.receive_bytes()) == seq
        for seq in range(last, 200):
            feed.take(batch(seq), float(seq))
        for _ in range(last):
            socket.send_text("")
        assert seq_of(socket.receive_bytes()) == 199


@pytest.mark.one_engine
def test_fingers_without_a_body_do_not_pile_up(lab: Lab) -> None:
    """A console that answers nothing gets a few poses of fingers; the next body comes all the same.

    Fingers follow again once that body has been drawn.
    """
    fingers = StreamName.TARGET_FINGERS
    session_id = lab.join()["id"]
    with watching(lab, session_id) as socket:
        socket.receive_json()
        feed = feed_of(lab, session_id)
        for seq in range(MAX_UNDRAWN):
            feed.take(batch(seq, fingers), float(seq))
            assert seq_of(socket.receive_bytes()) == seq
        for seq in range(MAX_UNDRAWN, 60):
            feed.take(batch(seq, fingers), float(seq))
        for seq in (60, 61, 62):
            feed.take(batch(seq), float(seq))
            assert seq_of(socket.receive_bytes()) == seq
        # The next ones wait for an answer each, so they show that it has been received.
        feed.take(batch(63), 63.0)
        socket.send_text("")
        assert seq_of(socket.receive_bytes()) == 63
        feed.take(batch(64, fingers), 64.0)
        socket.send_text("")
        assert seq_of(socket.receive_bytes()) == 64


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("client", "code"), [("stranger", 4401), ("elsewhere", 4403), ("unknown", 4403)]
)
def test_an_unauthorised_console_is_refused_with_a_code(lab: Lab, client: str, code: int) -> None:
    """A console without login, from another site or for an unknown session is refused."""
    session_id = "nobody" if client == "unknown" else lab.join()["id"]
    caller: Any = lab.stranger() if client == "stranger" else lab.operator
    headers = {"origin": "http://elsewhere.example"} if client == "elsewhere" else {}
    path = f"/api/sessions/{session_id}/pose"
    with (
        pytest.raises(WebSocketDisconnect) as closed,
        caller.websocket_connect(path, headers=headers) as socket,
    ):
        socket.receive_json()
    assert closed.value.code == code
