"""A session whose headset uses the trackers of a script, on a real server by real sockets."""

import itertools
import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from sqlalchemy import func, select
from websockets.sync.client import ClientConnection, connect

from app.features.record.lab_trackers import decode_samples
from app.models import TrackerAlignment, TrackerChunk
from app.science.alignment import PoseStream
from app.science.rotations import identity
from tests.features.lab import Json, error, ok
from tests.features.record.headset.site import SUBPROTOCOL, Site
from tests.features.record.headset.streaming import materialised
from tests.science.alignment.rooms import (
    FOOT_FROM_HEAD_M,
    OPTICAL,
    in_tracking_world,
    looking_around,
    recorded,
    some_room,
)
from tests.support.beside import beside
from tests.support.datagrams import HERE, free_udp_port, sender, taken_port

SECONDS = 60.0


class SimulatedRoom:
    """Trackers and a headset of a simulated wearer who looks around, in real time."""

    def __init__(self, port: int) -> None:
        rng = np.random.default_rng(4)
        self._port = port
        self.head, room = looking_around(SECONDS), some_room(rng)
        self._headset, self._hat = recorded(self.head, room, OPTICAL, rng)
        feet = self.head.positions_m + np.array(FOOT_FROM_HEAD_M)
        at_s = self.head.times_s + room.delay_s
        in_world = in_tracking_world(room, self.head.times_s, feet)
        self._foot = PoseStream.of(at_s, in_world, identity(len(feet)))
        self.began_s = time.monotonic()

    @contextmanager
    def tracking(self) -> Iterator[None]:
        """Send the trackers at their rate while the block runs."""
        foot_m, _, _ = self._foot.at(self._hat.times_s)

        def send(over: threading.Event) -> None:
            with sender(self._port) as door:
                for n, at in enumerate(self._hat.times_s.tolist()):
                    if over.wait(max(0.0, self.began_s + at - time.monotonic())):
                        return
                    hat = {
                        "position_m": self._hat.positions_m[n].tolist(),
                        "rotation_wxyz": self._hat.rotations[n].tolist(),
                    }
                    foot = {"position_m": foot_m[n].tolist(), "rotation_wxyz": [1, 0, 0, 0]}
                    trackers = {"hat": hat, "foot": foot}
                    door(json.dumps({"source": "lab", "time_s": at, "trackers": trackers}).encode())

        with beside(send):
            yield

    def heads_since(self, after_s: float) -> tuple[float, list[Json]]:
        """Return the headset's poses between a time of the room and now, and that now."""
        now_s = time.monotonic() - self.began_s
        part = self._headset.between(np.nextafter(after_s, np.inf), now_s)
        return now_s, [
            {"t_s": at, "place": [*position, *rotation], "tracked": True}
            for at, position, rotation in zip(
                part.times_s.tolist(),
                part.positions_m.tolist(),
                part.rotations.tolist(),
                strict=True,
            )
        ]

    def foot_error_m(self, message: Json) -> float:
        """Return how far the foot of a message is from where it was."""
        position_m, _, _ = self.head.at(np.array([message["t_s"]]))
        foot_m = np.array(message["places"]["LeftLowerLeg"][:3])
        return float(np.linalg.norm(foot_m - position_m[0] - FOOT_FROM_HEAD_M))


@contextmanager
def tracker_socket(site: Site, token: str) -> Iterator[ClientConnection]:
    """Open the socket over which trackers come to a headset."""
    url = site.server.url.replace("http", "ws") + "/api/vr/trackers"
    offered = [SUBPROTOCOL, f"bearer.{token}"]
    with connect(url, subprotocols=offered, compression=None) as socket:  # type: ignore[arg-type]
        yield socket


def heard(
    socket: ClientConnection, room: SimulatedRoom, until: Callable[[Json], bool], seconds: float
) -> list[Json]:
    """Let the headset say where its head is, and return what it hears until something matches."""
    messages: list[Json] = []
    sent_s, deadline = time.monotonic() - room.began_s, time.monotonic() + seconds
    while time.monotonic() < deadline:
        sent_s, poses = room.heads_since(sent_s)
        if poses:
            socket.send(json.dumps({"type": "head", "poses": poses}))
        try:
            messages.append(json.loads(socket.recv(timeout=0.05)))
        except TimeoutError:
            continue
        if until(messages[-1]):
            return messages
    pytest.fail(f"not within {seconds} s: {messages[-3:]}")


def door_with_limbs(site: Site, port: int) -> None:
    """Open the door for scripts, and say on which limbs the trackers are."""
    body = {"is_open": True, "interface": HERE, "port": port}
    ok(site.operator.put("/api/trackers/doors/json", json=body))
    for tracker, limb in (("hat", "Head"), ("foot", "LeftLowerLeg")):
        wish = {"door": "json", "source": "lab", "tracker": tracker, "limb": limb}
        ok(site.operator.put("/api/trackers/limbs", json=wish))


def test_trackers_reach_the_headset_and_are_on_the_record(site: Site) -> None:
    """Chosen, aligned by looking around, within 5 mm of a foot; samples and result are stored."""
    port = free_udp_port()
    door_with_limbs(site, port)
    session_id = materialised(site)
    path = f"/api/sessions/{session_id}/trackers"
    assert ok(site.operator.get(path))["status"] is None
    shown = ok(site.operator.put(path, json={"door": "json", "source": "lab"}))
    assert (shown["source"], shown["status"]) == ("lab", "silent")
    assert check_of(site, session_id)["code"] == "lab_trackers.silent"
    door = {"is_open": False, "interface": HERE, "port": port}
    ok(site.operator.put("/api/trackers/doors/json", json=door))
    assert check_of(site, session_id)["code"] == "lab_trackers.door_closed"
    with taken_port(port):
        ok(site.operator.put("/api/trackers/doors/json", json=door | {"is_open": True}))
        assert check_of(site, session_id)["code"] == "lab_trackers.door_failed"
    ok(site.operator.put("/api/trackers/doors/json", json=door))
    ok(site.operator.put("/api/trackers/doors/json", json=door | {"is_open": True}))
    token, room = site.token(session_id), SimulatedRoom(port)
    with (
        site.headset(token) as headset,
        room.tracking(),
        tracker_socket(site, token) as socket,
    ):
        headset.reported(kind="materialised", t_s=1.0)
        heard_first = heard(socket, room, lambda one: one["type"] == "trackers", 40)
        states = [one for one in heard_first if one["type"] == "trackers_state"]
        assert [(one["wanted"], one["aligned"]) for one in states] == [(True, False), (True, True)]
        left = itertools.count(60, -1)
        more = heard(socket, room, lambda _: next(left) == 0, 20)
        errors_m = [room.foot_error_m(one) for one in more if one["type"] == "trackers"]
        assert float(np.percentile(errors_m, 95)) <= 0.005
        shown = ok(site.operator.get(path))
        assert shown["status"] == "aligned"
        assert shown["alignment"]["foot_mm"] < 5
        assert {one["tracker"] for one in shown["trackers"] if one["tracked"]} == {"hat", "foot"}
        assert check_of(site, session_id)["code"] == "lab_trackers.aligned"
        deadline = time.monotonic() + 10
        while ok(site.operator.get(path))["stored"] < 200 and time.monotonic() < deadline:
            time.sleep(0.2)
    ok(site.operator.put(path, json={"door": None, "source": None}))
    recorded_as_it_was(site, session_id)


def check_of(site: Site, session_id: str) -> Json:
    """Return the pre-flight's row about the trackers."""
    checks = ok(site.operator.get(f"/api/sessions/{session_id}/preflight"))["checks"]
    return next(one for one in checks if one["key"] == "lab_trackers")


def recorded_as_it_was(site: Site, session_id: str) -> None:
    """Check the events, the alignment's figures and the stored samples of a session."""
    events = ok(site.operator.get(f"/api/sessions/{session_id}/events"))
    chosen = [one["data"] for one in events if one["type"] == "trackers_chosen"]
    assert [one["source"] for one in chosen] == ["lab", None]
    (aligned,) = (one["data"] for one in events if one["type"] == "trackers_aligned")
    assert (aligned["change"], aligned["residual_m"] < 0.005) == ("first", True)
    with site.database.reading() as db:
        row = db.get_one(TrackerAlignment, aligned["alignment_id"])
        assert (row.change, row.tracker, row.door) == ("first", "hat", "json")
        assert row.figures["alignment"]["mount"]["delay_s"] == aligned["delay_s"]
        by_source = dict(
            db.execute(
                select(TrackerChunk.source, func.sum(TrackerChunk.sample_count))
                .where(TrackerChunk.session_id == session_id)
                .group_by(TrackerChunk.source)
            ).all()
        )
        assert set(by_source) == {"lab", "headset"}
        query = select(TrackerChunk).where(
            TrackerChunk.session_id == session_id, TrackerChunk.source == "lab"
        )
        chunk = next(iter(db.scalars(query)))
        samples = decode_samples(chunk.trackers, chunk.sample_count, chunk.data)
    assert samples.trackers == ("hat", "foot")
    late_s = samples.arrival_s - samples.mapped_s
    assert late_s.min() >= 0
    assert np.diff(samples.source_s[samples.tracker == 0]).min() > 0


def test_what_cannot_be_chosen_is_refused(site: Site) -> None:
    """Half a choice is no choice, and a session that has ended uses no trackers."""
    session_id = site.join()
    path = f"/api/sessions/{session_id}/trackers"
    refusal = site.operator.put(path, json={"door": "json", "source": None})
    assert refusal.status_code == 422
    site.command(session_id, "start")
    ok(site.operator.put(path, json={"door": "json", "source": "lab"}))
    site.command(session_id, "abort", reason="a test")
    error(site.operator.put(path, json={"door": "osc", "source": "x"}), 409, "not_now")
    assert ok(site.operator.get(path))["source"] is None


def test_nonsense_closes_the_socket_with_a_reason(site: Site) -> None:
    """A message that is none names the field; a stranger's socket is not served."""
    token = site.token(site.join())
    with tracker_socket(site, token) as socket:
        assert json.loads(socket.recv(timeout=10)) == {
            "type": "trackers_state",
            "wanted": False,
            "aligned": False,
        }
        pose = {"t_s": 1.0, "place": [0, 0, 0, 1, 0, 0, 0], "tracked": True}
        socket.send(json.dumps({"type": "head", "poses": [pose, pose]}))
        failure = json.loads(socket.recv(timeout=10))
        assert "t_s must rise" in failure["message"]
    with tracker_socket(site, "nobody") as socket:
        assert json.loads(socket.recv(timeout=10))["code"] == "not_signed_in"


def test_the_newest_page_of_a_headset_gets_the_trackers(site: Site) -> None:
    """A second socket of the same headset replaces the first, which is told so."""
    token = site.token(site.join())
    with tracker_socket(site, token) as first:
        first.recv(timeout=10)
        with tracker_socket(site, token) as second:
            second.recv(timeout=10)
            assert json.loads(first.recv(timeout=10))["code"] == "taken_over"
