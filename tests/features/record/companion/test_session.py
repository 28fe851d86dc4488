"""A session whose headset shows a companion, on a real server by real sockets."""

import itertools
import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from sqlalchemy import select
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from app.features.record.companion import ENCODING, decode_frames
from app.features.record.companion.placing import STRAYS_M
from app.models import TrackerChunk
from app.wire.companion import POSE_MAGIC
from tests.features.lab import Json, error, ok
from tests.features.movement.performers.senders import by_json, part_of_walk
from tests.features.record.headset.conftest import running_site
from tests.features.record.headset.site import SUBPROTOCOL, Site
from tests.features.record.headset.streaming import materialised
from tests.support.beside import beside
from tests.support.datagrams import HERE, free_udp_port, sender
from tests.support.humanoid_files import humanoid_file

MIME: Json = {"door": "json", "source": "mime", "skeleton": "Hips"}
WISH: Json = {**MIME, "stature": "180cm", "humanoid": None, "place": "ahead_right"}
NOBODY: Json = {"companion": None}


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    """A server; one engine is enough, since the queries are plain."""
    with running_site("sqlite", tmp_path_factory.mktemp("companion"), {}) as site:
        yield site


@pytest.fixture(scope="module")
def port(site: Site) -> int:
    """The port of the open door for scripts."""
    port = free_udp_port()
    body = {"is_open": True, "interface": HERE, "port": port}
    ok(site.operator.put("/api/trackers/doors/json", json=body))
    return port


@contextmanager
def performing(port: int) -> Iterator[None]:
    """Let the performer of a script walk while the block runs, over and over."""

    def send(over: threading.Event) -> None:
        with sender(port) as door:
            for packet in itertools.cycle(list(by_json(part_of_walk(50, 110)))):
                if over.wait(0.02):
                    return
                door(packet)

    with beside(send):
        yield


@contextmanager
def companion_socket(site: Site, token: str) -> Iterator[ClientConnection]:
    """Open the socket over which a companion comes to a headset."""
    url = site.server.url.replace("http", "ws") + "/api/vr/companion"
    offered = [Subprotocol(SUBPROTOCOL), Subprotocol(f"bearer.{token}")]
    with connect(url, subprotocols=offered, compression=None) as socket:
        yield socket


def told(socket: ClientConnection) -> Json:
    """Return the next state; poses before it are passed over."""
    while isinstance(message := socket.recv(timeout=10), bytes):
        pass
    found: Json = json.loads(message)
    return found


def pose(socket: ClientConnection) -> np.ndarray:
    """Return the next pose."""
    message = socket.recv(timeout=10)
    assert isinstance(message, bytes)
    assert message.startswith(POSE_MAGIC)
    return np.frombuffer(message, "<f4", offset=len(POSE_MAGIC))


def until(look: Callable[[], Json], matches: Callable[[Json], bool]) -> Json:
    """Return what is seen once it is as expected."""
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline:
        if matches(seen := look()):
            return seen
        time.sleep(0.05)
    pytest.fail(f"not within 20 s: {seen}")


def test_what_a_participant_is_shown_is_chosen_sent_stored_and_erased(
    site: Site, port: int
) -> None:
    """Poses come while the headset shows the companion; each of them is on disk, and only those."""
    session_id = materialised(site)
    path = f"/api/sessions/{session_id}/companion"
    shown = ok(site.operator.get(path))
    assert (shown["companion"], shown["headset"]) == (None, "away")
    token = site.token(session_id)
    poses = []
    with site.headset(token) as headset, companion_socket(site, token) as socket, performing(port):
        headset.reported(kind="materialised", t_s=1.0)
        assert told(socket) == {"type": "companion_state", **STATE, "chosen": False}
        until(lambda: ok(site.operator.get(path)), lambda one: len(one["choices"]) > 0)
        shown = ok(site.operator.put(path, json={"companion": WISH}))
        assert (shown["headset"], shown["companion"]["source"]) == ("hidden", "mime")
        x, z = shown["companion"]["position_m"]
        wanted = {"chosen": True, "stature_m": 1.8}
        assert told(socket) == {"type": "companion_state", **STATE, **wanted}
        socket.send(json.dumps({"type": "companion_seen", "seen": True}))
        poses = [pose(socket) for _ in range(40)]
        away_m = np.hypot(*(np.array(poses)[:, [0, 2]] - (x, z)).T)
        assert float(away_m.max()) <= STRAYS_M + 1e-5
        seen = ok(site.operator.get(path))
        assert (seen["headset"], seen["body"]["state"]) == ("seen", "ready")
        assert seen["latency_ms"] is not None
        socket.send(json.dumps({"type": "companion_seen", "seen": False}))
        until(lambda: ok(site.operator.get(path)), lambda one: one["headset"] == "hidden")
        stored = until(lambda: ok(site.operator.get(path)), lambda one: one["stored"] >= 40)
        ok(site.operator.put(path, json=NOBODY))
        # What was on its way when the headset hid them.
        while isinstance(message := socket.recv(timeout=10), bytes):
            poses.append(np.frombuffer(message, "<f4", offset=len(POSE_MAGIC)))
        assert json.loads(message)["chosen"] is False
    assert stored["stored"] == len(poses)
    events = ok(site.operator.get(f"/api/sessions/{session_id}/events"))
    chosen = [one["data"]["companion"] for one in events if one["type"] == "companion_chosen"]
    assert [None if one is None else one["stature"] for one in chosen] == ["180cm", None]
    assert chosen[0]["position_m"] == [x, z]
    with site.database.reading() as db:
        rows = list(
            db.scalars(
                select(TrackerChunk)
                .where(TrackerChunk.session_id == session_id, TrackerChunk.encoding == ENCODING)
                .order_by(TrackerChunk.number)
            )
        )
    found = [decode_frames(row.sample_count, row.data) for row in rows]
    assert np.array_equal(np.concatenate([one.values for one in found]), np.array(poses))
    assert all((one.sent_s >= one.arrival_s).all() for one in found)


STATE: Json = {"chosen": True, "stature_m": 0.0, "model": None, "in_tasks": False}


def test_what_cannot_be_shown_is_refused(site: Site) -> None:
    """A body that the lab has not, a stature that nobody has, and a session that has ended."""
    session_id = site.join()
    path = f"/api/sessions/{session_id}/companion"

    def refused(**other: object) -> Json:
        answer = site.operator.put(path, json={"companion": {**WISH, **other}})
        assert answer.status_code == 422
        failure: Json = answer.json()
        return failure

    assert "no such body" in str(refused(humanoid="0" * 64))
    assert refused(stature="30cm")["error"]["valid"] == "50cm to 260cm"
    refused(place="behind")
    site.command(session_id, "start")
    nobody = {**WISH, "source": "nobody", "in_tasks": True}
    ok(site.operator.put(path, json={"companion": nobody}))
    assert ok(site.operator.get(path))["body"]["state"] == "absent"
    site.command(session_id, "abort", reason="a test")
    error(site.operator.put(path, json={"companion": WISH}), 409, "not_now")
    assert ok(site.operator.get(path))["companion"] is None


def test_a_headset_fetches_the_companions_body_and_no_other(site: Site) -> None:
    """The model of a chosen body can be fetched by the session's own headset, and not before."""
    (body, *_) = ok(site.operator.get("/api/humanoids"))["humanoids"]
    session_id = site.join()
    token = site.token(session_id)
    file = f"/api/vr/bodies/{body['content_hash']}/file"
    with site.server.client() as headset:
        headset.headers["authorization"] = f"Bearer {token}"
        assert headset.get(file).status_code == 404
        wish = {**WISH, "humanoid": body["content_hash"]}
        ok(site.operator.put(f"/api/sessions/{session_id}/companion", json={"companion": wish}))
        assert headset.get(file).status_code == 200


def test_a_body_that_a_participant_was_shown_stays(site: Site) -> None:
    """The record names the body by its hash, so it is not removed, also not after the session."""
    answer = site.operator.post("/api/humanoids?name=companion.glb", content=humanoid_file())
    content_hash = ok(answer)["content_hash"]
    session_id = site.join()
    path = f"/api/sessions/{session_id}/companion"
    ok(site.operator.put(path, json={"companion": {**WISH, "humanoid": content_hash}}))
    ok(site.operator.put(path, json=NOBODY))
    refused = error(site.operator.delete(f"/api/humanoids/{content_hash}"), 409, "conflict")
    assert "companion" in refused["message"]


def test_the_newest_page_of_a_headset_shows_the_companion(site: Site) -> None:
    """A second socket of the same headset replaces the first; nonsense closes one with a reason."""
    token = site.token(site.join())
    with companion_socket(site, token) as first:
        told(first)
        with companion_socket(site, token) as second:
            told(second)
            assert told(first)["code"] == "taken_over"
            second.send(json.dumps({"type": "companion_seen"}))
            assert "seen" in told(second)["message"]


def test_a_door_names_the_sessions_that_use_it(site: Site) -> None:
    """Whoever closes a door is told which sessions lose trackers or companion, until they end."""
    session_id = site.join()
    path = f"/api/sessions/{session_id}"

    def behind(door: str) -> list[list[str]]:
        found = ok(site.operator.get(f"/api/trackers/doors/{door}/sessions"))
        code = ok(site.operator.get(path))["participant_code"]
        own = [one for one in found if one["session_id"] == session_id]
        assert all(one["participant_code"] == code for one in own)
        return [one["uses"] for one in own]

    assert behind("json") == []
    ok(site.operator.put(f"{path}/companion", json={"companion": WISH}))
    assert (behind("json"), behind("osc")) == ([["companion"]], [])
    ok(site.operator.put(f"{path}/trackers", json={"door": "json", "source": "lab"}))
    assert behind("json") == [["trackers", "companion"]]
    site.command(session_id, "start")
    site.command(session_id, "abort", reason="a test")
    assert behind("json") == []
