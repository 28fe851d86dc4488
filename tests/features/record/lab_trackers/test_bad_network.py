"""A session whose trackers come over a bad network, and a headset whose socket is cut."""

import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest
from sqlalchemy import select

from app.features.record.lab_trackers import decode_samples
from app.models import TrackerChunk
from tests.features.lab import Json, ok
from tests.features.record.headset.site import Site
from tests.features.record.headset.streaming import materialised
from tests.features.record.lab_trackers.test_session import (
    check_of,
    door_with_limbs,
    tracker_socket,
)
from tests.support.beside import beside
from tests.support.datagrams import Network, free_udp_port, sender

PACKET_S = 0.02


class Script:
    """Sends numbered packets of a tracker on the head."""

    def __init__(self, way: Callable[[bytes], object], first: int = 1) -> None:
        self._way, self._next = way, first

    @contextmanager
    def running(self) -> Iterator[None]:
        """Send 50 packets a second during the block."""

        def send(over: threading.Event) -> None:
            while not over.wait(PACKET_S):
                number, self._next = self._next, self._next + 1
                pose = {"position_m": [0, 1.7, 0], "rotation_wxyz": [1, 0, 0, 0]}
                packet = {"source": "lab", "frame": number, "time_s": number * PACKET_S}
                self._way(json.dumps({**packet, "trackers": {"hat": pose}}).encode())

        with beside(send):
            yield


def seen(look: Callable[[], Json], matches: Callable[[Json], bool]) -> Json:
    """Return what is shown once it is as expected."""
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline:
        if matches(found := look()):
            return found
        time.sleep(0.05)
    pytest.fail(f"not within 20 s: {found}")


def stored_times(site: Site, session_id: str, source: str = "lab") -> list[tuple[str, float]]:
    """Return sender and own time of every stored pose of a source, in the order of arrival."""
    with site.database.reading() as db:
        of_session = TrackerChunk.session_id == session_id
        query = select(TrackerChunk).where(of_session, TrackerChunk.source == source)
        rows = list(db.scalars(query.order_by(TrackerChunk.number)))
    return [
        (row.address, at)
        for row in rows
        for at in decode_samples(row.trackers, row.sample_count, row.data).source_s.tolist()
    ]


def test_a_bad_network_is_shown_and_loses_nothing_that_arrived(site: Site) -> None:
    """Gone, then doubling, swapping, and with a second sender: each is said, and it goes on alone.

    Every packet that arrived is stored, also those that came late, each under its sender.
    """
    port = free_udp_port()
    door_with_limbs(site, port)
    session_id = materialised(site)
    path = f"/api/sessions/{session_id}/trackers"
    ok(site.operator.put(path, json={"door": "json", "source": "lab"}))
    with site.headset(site.token(session_id)) as headset, sender(port) as send:
        headset.reported(kind="materialised", t_s=1.0)
        way = Network(send)
        script = Script(way)

        def session() -> Json:
            view: Json = ok(site.operator.get(path))
            return view

        def source() -> Json:
            found = ok(site.operator.get("/api/trackers"))["sources"]
            first: Json = next(one for one in found if one["address"] == address)
            return first

        with script.running():
            seen(session, lambda one: one["stored"] > 0)
            address = stored_times(site, session_id)[0][0]
            way.is_gone = True
            seen(session, lambda one: one["status"] == "silent")
            assert source()["is_silent"]
            assert check_of(site, session_id)["code"] == "lab_trackers.silent"
            way.is_gone = False
            seen(session, lambda one: one["status"] == "no_headset")
            assert not source()["is_silent"]
            way.doubles = way.swaps = True
            seen(source, lambda one: one["doubled"] > 9 and one["late"] > 9)
            way.doubles = way.swaps = False
            with sender(port) as other, Script(other, 5000).running():
                seen(session, lambda one: len(one["others"]) == 1)
                assert source()["same_name"]
            seen(session, lambda one: one["others"] == [])
        kept = seen(session, lambda one: one["stored"] > len(way.passed))
    assert kept["waiting_lost"] == 0
    ok(site.operator.put(path, json={"door": None, "source": None}))
    passed = [json.loads(one)["frame"] for one in way.passed]

    def stored() -> Json:
        found = stored_times(site, session_id)
        first = [round(at / PACKET_S) for address, at in found if address == found[0][0]]
        return {"first": first, "others": len(found) - len(first)}

    found = seen(stored, lambda one: set(one["first"]) == set(passed))
    assert found["first"] != sorted(found["first"])
    assert found["others"] > 0
    assert max(passed) > len(passed)


def test_a_cut_socket_of_the_headset_is_said_and_opened_again(site: Site) -> None:
    """The cockpit waits for the headset, and goes on with its head once the socket is back."""
    port = free_udp_port()
    door_with_limbs(site, port)
    session_id = materialised(site)
    path = f"/api/sessions/{session_id}/trackers"
    ok(site.operator.put(path, json={"door": "json", "source": "lab"}))
    token = site.token(session_id)

    def session() -> Json:
        view: Json = ok(site.operator.get(path))
        return view

    def says_head(t_s: float) -> None:
        with tracker_socket(site, token) as socket:
            assert json.loads(socket.recv(timeout=10))["wanted"]
            pose = {"t_s": t_s, "place": [0, 1.6, 0, 1, 0, 0, 0], "tracked": True}
            socket.send(json.dumps({"type": "head", "poses": [pose]}))
            seen(session, lambda one: one["status"] == "looking")

    with (
        site.headset(token) as headset,
        sender(port) as send,
        Script(send).running(),
    ):
        headset.reported(kind="materialised", t_s=1.0)
        began_s = time.monotonic()
        says_head(1.0)
        seen(session, lambda one: one["status"] == "no_headset")
        assert check_of(site, session_id)["code"] == "lab_trackers.no_headset"
        says_head(1.0 + time.monotonic() - began_s)
        seen(
            lambda: {"heads": stored_times(site, session_id, "headset")},
            lambda one: len(one["heads"]) == 2,
        )
