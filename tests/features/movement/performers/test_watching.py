"""Performers on a running server: watched on a body, agreed with, recorded as captures."""

import json
import re
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from starlette.testclient import WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

from app.features.movement.performers.socket import HEADER, MAGIC
from app.science.retargeting import REFERENCE_JOINT_MAP, Retargeter, named_avatar
from app.science.rig import RigMotion
from tests.api.people import sign_in
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.live.test_doors import close_doors, open_door
from tests.features.movement.performers.senders import by_json, part_of_walk
from tests.support.datagrams import free_udp_port, sender

NAME = {"door": "json", "source": "mime", "skeleton": "Hips"}
WATCH = "/api/trackers/performers/watch?door=json&source=mime&skeleton=Hips"
REPOSITORY = Path(__file__).resolve().parents[4]
pytestmark = pytest.mark.one_engine


@pytest.fixture(scope="module")
def walk() -> RigMotion:
    """Provide half a second of a generated walk."""
    return part_of_walk(50, 110)


@pytest.fixture
def port(fresh_lab: Lab) -> Iterator[int]:
    """Provide the port of the open door for scripts."""
    port = free_udp_port()
    open_door(fresh_lab, "json", port=port)
    yield port
    close_doors(fresh_lab)


def performers(lab: Lab, until: Callable[[Json], bool]) -> Json:
    """Return what is known of performers once it is as expected."""
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline:
        view: Json = ok(lab.operator.get("/api/trackers/performers"))
        if until(view):
            return view
        time.sleep(0.02)
    pytest.fail(f"not within 30 s: {view}")


@contextmanager
def watching(lab: Lab, query: str = "") -> Iterator[WebSocketTestSession]:
    """Watch the performer of the script."""
    with lab.operator.websocket_connect(f"{WATCH}{query}") as socket:
        yield socket


def told(socket: WebSocketTestSession, kind: str) -> Json:
    """Return the next JSON message of a kind; poses in between are answered."""
    while True:
        message: Any = socket.receive()
        if message.get("text"):
            said: Json = json.loads(message["text"])
            if said["type"] == kind:
                return said
        else:
            socket.send_text("")


def pose(socket: WebSocketTestSession) -> tuple[tuple[Any, ...], Any]:
    """Return the header and the values of the next pose."""
    data = socket.receive_bytes()
    header = HEADER.unpack_from(data)
    return header, np.frombuffer(data, dtype="<f4", offset=HEADER.size)


def test_a_page_sees_the_body_that_the_file_would_give(
    fresh_lab: Lab, port: int, walk: RigMotion
) -> None:
    """Absent at first; then the setup, and each pose within the precision of 32 bits.

    A pose that is not answered holds back the next ones: the newest follows, and the rest is
    counted.
    """
    packets = list(by_json(walk))
    retargeter = Retargeter(
        walk.rig, REFERENCE_JOINT_MAP, named_avatar("190cm"), REFERENCE_JOINT_MAP
    )
    moved = retargeter.batch(walk)
    with watching(fresh_lab, "&avatar=190cm&ahead=1") as socket, sender(port) as send:
        assert told(socket, "state")["state"] == "absent"
        send(packets[0])
        setup = told(socket, "setup")
        assert (setup["stature_m"], setup["profile_m"]) == (1.9, [])
        assert setup["joints"] == list(named_avatar("190cm").names)
        assert told(socket, "state")["state"] == "ready"
        for at, answers in ((0, True), (1, False)):
            if at:
                send(packets[at])
            header, values = pose(socket)
            magic, count, held, number, skipped, source_s, *_ = header
            assert (magic, count, held, number, skipped) == (MAGIC, 91, 0, at + 1, 0)
            assert source_s == at / walk.rate_hz
            expected = np.concatenate((moved.root_positions_m[at], moved.rotations[at].ravel()))
            np.testing.assert_allclose(values, expected, atol=1e-6)
            if answers:
                socket.send_text("")
        for packet in packets[2:]:
            send(packet)
        performers(fresh_lab, lambda _: taken(fresh_lab) == len(packets))
        socket.send_text("")
        header, _ = pose(socket)
        assert (header[3], header[4]) == (len(packets), len(packets) - 3)


def test_the_skeleton_of_the_docs_moves_a_body(fresh_lab: Lab, port: int) -> None:
    """Copied as it is, the script is a performer who faces -z and waves the left arm."""
    docs = (REPOSITORY / "docs" / "live.md").read_text(encoding="utf-8")
    _, script = re.findall(r"```python\n(.*?)```", docs, re.DOTALL)
    assert "39570" in script
    running = subprocess.Popen([sys.executable, "-c", script.replace("39570", str(port))])
    try:
        (found,) = performers(fresh_lab, lambda view: bool(view["performers"]))["performers"]
        assert (found["state"], found["bones"], found["skeleton"]) == ("ready", 17, "Hips")
        name = "door=json&source=waving+script&skeleton=Hips"
        path = f"/api/trackers/performers/watch?{name}&avatar=170cm&ground=ramp"
        with fresh_lab.operator.websocket_connect(path) as socket:
            setup = told(socket, "setup")
            np.testing.assert_allclose(setup["uphill"], (0, -1), atol=1e-6)
            arm = setup["joints"].index("LeftUpperArm")
            turned: list[Any] = []
            while len(turned) < 20:
                message: Any = socket.receive()
                if message.get("bytes"):
                    values = np.frombuffer(message["bytes"], dtype="<f4", offset=HEADER.size)
                    turned.append(values[3 + 4 * arm : 7 + 4 * arm])
                    socket.send_text("")
            assert float(np.ptp(turned, axis=0).max()) > 0.01
    finally:
        running.kill()
        running.wait()


def taken(lab: Lab) -> int:
    """Return how many packets of the script were taken."""
    view = ok(lab.operator.get("/api/trackers"))
    return sum(int(one["packets"]) for one in view["sources"])


def test_a_ramp_is_told_and_begins_before_the_performer(
    fresh_lab: Lab, port: int, walk: RigMotion
) -> None:
    """In the direction in which they face, which is -z."""
    with watching(fresh_lab, "&ground=ramp") as socket, sender(port) as send:
        send(next(by_json(walk)))
        setup = told(socket, "setup")
        assert setup["uphill"] == pytest.approx([0.0, -1.0], abs=0.05)
        assert setup["ground_start_m"][1] < float(walk.root_positions_m[0, 2]) - 0.5
        assert setup["profile_m"][-1] == [4.0, 0.4]


def test_of_two_senders_one_is_used_until_it_is_silent(
    fresh_lab: Lab, port: int, walk: RigMotion
) -> None:
    """Both are shown, one as used, with the other's address; the page is told when it changes."""
    packets = by_json(walk)
    with sender(port) as first, sender(port) as second, watching(fresh_lab) as socket:
        first(next(packets))
        second(next(packets))
        view = performers(fresh_lab, lambda view: len(view["performers"]) == 2)
        used, other = sorted(view["performers"], key=lambda one: not one["is_used"])
        assert (used["others"], other["is_used"]) == ([other["address"]], False)
        state = told(socket, "state")
        while state["state"] != "ready" or not state["others"]:
            state = told(socket, "state")
        assert state["others"] == [other["address"]]
        deadline = time.monotonic() + 20
        while state["address"] != other["address"]:
            assert time.monotonic() < deadline
            second(next(packets))
            time.sleep(0.1)
            state = told(socket, "state")


def test_a_recording_becomes_a_capture_with_the_same_movement(
    fresh_lab: Lab, port: int, walk: RigMotion
) -> None:
    """The performer's own movement, at its rate, with the skeleton of the source."""
    lab = fresh_lab
    error(lab.operator.post("/api/trackers/recordings", json=NAME), 404, "not_found")
    packets = list(by_json(walk))
    with sender(port) as send:
        send(packets[0])
        performers(lab, lambda view: bool(view["performers"]))
        recording = ok(lab.operator.post("/api/trackers/recordings", json=NAME))
        assert recording["limit_s"] == 600.0
        again = lab.operator.post("/api/trackers/recordings", json=NAME)
        error(again, 409, "conflict")
        path = f"/api/trackers/recordings/{recording['id']}"
        error(lab.operator.post(f"{path}/capture"), 409, "conflict")
        began_s = time.monotonic()
        for at, packet in enumerate(packets[1:]):
            time.sleep(max(0.0, began_s + at / walk.rate_hz - time.monotonic()))
            send(packet)
        performers(lab, lambda view: view["recordings"][0]["frames"] == len(packets) - 1)
    stored = ok(lab.operator.post(f"{path}/capture"))
    assert (stored["frames"], stored["rate_hz"]) == (len(packets) - 1, 120.0)
    assert (stored["gaps"], stored["held_share"]) == ([], 0.0)
    assert performers(lab, lambda _: True)["recordings"] == []
    capture = ok(lab.operator.get(f"/api/captures/{stored['capture_id']}"))
    assert capture["title"].startswith("mime, Hips, 20")
    assert capture["summary"]["skeleton"]["joints"] == list(walk.rig.names)
    motion = lab.operator.get(f"/api/captures/{stored['capture_id']}/motion?shown=skeleton").content
    (length,) = struct.unpack_from("<I", motion)
    header = json.loads(motion[4 : 4 + length])
    places = np.frombuffer(motion, dtype="<f4", offset=4 + length)
    places = places.reshape(header["frames"], len(header["names"]), 3)
    own, _ = walk.world()
    np.testing.assert_allclose(places, own[1::2][: len(places)], atol=1e-4)


def test_a_recording_can_be_discarded(fresh_lab: Lab, port: int, walk: RigMotion) -> None:
    """Then another one may begin; a discarded one is not found."""
    lab = fresh_lab
    with sender(port) as send:
        send(next(by_json(walk)))
        performers(lab, lambda view: bool(view["performers"]))
    recording = ok(lab.operator.post("/api/trackers/recordings", json=NAME))
    path = f"/api/trackers/recordings/{recording['id']}"
    assert lab.operator.delete(path).status_code == 204
    error(lab.operator.delete(path), 404, "not_found")
    ok(lab.operator.post("/api/trackers/recordings", json=NAME))


def test_a_pose_is_agreed_by_those_who_run_sessions(
    fresh_lab: Lab, port: int, walk: RigMotion
) -> None:
    """Those who watch are told the new setup; an analyst may only watch, a stranger not at all."""
    lab = fresh_lab
    packets = by_json(walk)
    with watching(lab) as socket, sender(port) as send:
        send(next(packets))
        told(socket, "setup")
        wish = {**NAME, "pose": "t_pose"}
        view = ok(lab.operator.post("/api/trackers/performers/pose", json=wish))
        assert view["performers"][0]["is_t_pose_shown"]
        told(socket, "setup")
        entries = ok(lab.operator.get("/api/audit"))["entries"]
        assert ("performer.agreed", "t_pose") in [
            (one["action"], one["details"].get("pose")) for one in entries
        ]
        analyst = sign_in(lab, "analyst")
        refused = analyst.post("/api/trackers/performers/pose", json=wish)
        error(refused, 403, "not_allowed")
        with analyst.websocket_connect(WATCH) as other:
            assert told(other, "setup")["stature_m"] == 1.65
        with lab.stranger().websocket_connect(WATCH) as stranger:
            with pytest.raises(WebSocketDisconnect) as closed:
                stranger.receive_text()
            assert closed.value.code == 4401
