"""Measure how late a lab's trackers reach a headset, beside a bare relay in the same run.

`headset`: six trackers at 90 Hz, by JSON over UDP, to the socket of an emulated headset whose
wearer looks around, from making a datagram to reading its message. Which datagram a message is from
shows in the distance between two trackers, which no alignment changes. The relay is a process of
its own that passes each datagram on to a WebSocket and does nothing else; it gets the same
datagrams. Then every pose that the door took has to be on disk.

`live`: a skeleton onto a body, to a page; see `hub_live`.
"""

import json
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from sqlalchemy import func, select
from websockets.sync.client import connect

from app.database import open_database
from app.models import TrackerChunk
from app.science.rotations import identity
from tests.benchmarks.hub_live import DURATION_S as LIVE_S
from tests.benchmarks.hub_live import live_figures
from tests.benchmarks.relay import connected, relay
from tests.benchmarks.report import CannotMeasure, Figure, Report
from tests.features.lab import ok
from tests.features.record.headset.site import HELLO, SUBPROTOCOL, Site, open_site
from tests.features.record.headset.streaming import materialised
from tests.science.alignment.rooms import (
    FOOT_FROM_HEAD_M,
    OPTICAL,
    in_tracking_world,
    looking_around,
    recorded,
    some_room,
)
from tests.support.datagrams import HERE, free_udp_port, sender
from tests.support.server import LiveServer

PARTS = ("headset", "live")
RATE_HZ = 90.0
LIMBS = ("Hips", "LeftHand", "RightHand", "LeftLowerLeg", "RightLowerLeg")
DURATION_S = 30.0
ALIGNS_WITHIN_S = 30.0
WELCOMED_WITHIN_S = 180.0
LIMIT_MS = 15.0
_APART_M, _STEP_M = 0.5, 1e-4


class Lab:
    """A simulated wearer: datagrams of six trackers, and the head by the headset."""

    def __init__(self, seconds: float) -> None:
        rng = np.random.default_rng(1)
        head, room = looking_around(seconds), some_room(rng)
        headset, hat = recorded(head, room, OPTICAL, rng)
        self.times_s = np.arange(0.0, float(hat.times_s[-1]), 1.0 / RATE_HZ)
        hat_m, hat_q, _ = hat.at(self.times_s)
        feet_m = in_tracking_world(room, head.times_s, head.positions_m + FOOT_FROM_HEAD_M)
        feet_q = identity(1)[0].tolist()
        at = np.clip(np.searchsorted(head.times_s, self.times_s), 0, len(feet_m) - 1)
        self._hats = list(zip(hat_m.tolist(), hat_q.tolist(), strict=True))
        self._feet = feet_m[at].tolist()
        self._feet_q = feet_q
        self.sent_s = [0.0] * len(self.times_s)
        self._headset = headset

    def datagram(self, n: int) -> bytes:
        """Return the trackers' n-th datagram; the distance of the hands says which it is."""
        position, rotation = self._hats[n]
        x, y, z = self._feet[n]
        feet = {limb: {"position_m": [x, y, z], "rotation_wxyz": self._feet_q} for limb in LIMBS}
        feet["RightHand"] = {**feet["RightHand"], "position_m": [x + _APART_M + n * _STEP_M, y, z]}
        trackers = {"Head": {"position_m": position, "rotation_wxyz": rotation}, **feet}
        said = {"source": "bench", "frame": n, "time_s": self.sent_s[n], "trackers": trackers}
        return json.dumps(said).encode()

    def number(self, places: dict[str, list[float]]) -> int:
        """Return which datagram a message of the headset is from."""
        apart = np.subtract(places["RightHand"][:3], places["LeftHand"][:3])
        return round((float(np.linalg.norm(apart)) - _APART_M) / _STEP_M)

    def heads(self, after_s: float, until_s: float, began_s: float) -> list[dict[str, Any]]:
        """Return the headset's poses in a span of the room's time, by its own clock."""
        part = self._headset.between(np.nextafter(after_s, np.inf), until_s)
        return [
            {"t_s": began_s + at, "place": [*position, *rotation], "tracked": True}
            for at, position, rotation in zip(
                part.times_s.tolist(),
                part.positions_m.tolist(),
                part.rotations.tolist(),
                strict=True,
            )
        ]


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts."""
    report = Report("hub")
    with tempfile.TemporaryDirectory(prefix="reembody-hub-") as folder:
        if "headset" in parts:
            report.add(*_to_headset(Path(folder) / "headset", duration_s or DURATION_S))
        if "live" in parts:
            report.add(*live_figures(Path(folder) / "live", duration_s or LIVE_S))
    return report


def _to_headset(folder: Path, duration_s: float) -> list[Figure]:
    lab = Lab(duration_s + ALIGNS_WITHIN_S + 5.0)
    port, relay_port = free_udp_port(), free_udp_port()
    with (
        relay(relay_port) as relay_url,
        _relayed(relay_url) as relayed,
        LiveServer(folder) as server,
        open_site(server) as site,
    ):
        session_id, token = _session(site, port)
        path = f"/api/sessions/{session_id}/trackers"
        with _in_the_body(site, token), _Wearer(server, token, lab) as wearer:
            _send_for(lab, wearer, (port, relay_port), duration_s)
            time.sleep(2.5)
            shown: dict[str, Any] = ok(site.operator.get(path))
            doors = ok(site.operator.get("/api/trackers"))["doors"]
        # A session that stops using the trackers has all of them on disk a second later.
        ok(site.operator.put(path, json={"door": None, "source": None}))
        time.sleep(2.5)
        door = next(one for one in doors if one["door"] == "json")
    stored = _stored(server, session_id)
    if not wearer.latencies_s:
        raise CannotMeasure(f"the trackers were never aligned: {shown['status']}")
    ours, bare = (
        [1000 * float(one) for one in np.percentile(latencies_s, (50, 95, 99))]
        for latencies_s in (wearer.latencies_s, relayed)
    )
    what, peer = "6 trackers x 90 Hz to the headset", "bare UDP to WebSocket relay"
    taken = door["packets"] * (len(LIMBS) + 1)
    return [
        Figure("headset", f"{what}, p50", ours[0], "ms", peer, bare[0]),
        Figure("headset", f"{what}, p95", ours[1], "ms", "at most", LIMIT_MS),
        Figure("headset", "p95 beside the relay's", ours[1], "ms", peer, bare[1]),
        Figure("headset", f"{what}, p99", ours[2], "ms", peer, bare[2]),
        Figure("headset", "messages to the headset", len(wearer.latencies_s), ""),
        Figure("headset", "messages without trackers, which were lost then", wearer.lost, ""),
        Figure("headset", "dropped by the kernel", door["dropped"] or 0, "", "at most", 0),
        Figure("headset", "poses taken by the door, not on disk", taken - stored, "", "at most", 0),
        Figure("headset", "a foot is known to", shown["alignment"]["foot_mm"], "mm", "at most", 5),
    ]


def _session(site: Site, port: int) -> tuple[str, str]:
    """Return a session that uses the trackers, and the token of its headset."""
    body = {"is_open": True, "interface": HERE, "port": port}
    ok(site.operator.put("/api/trackers/doors/json", json=body))
    for limb in ("Head", *LIMBS):
        wish = {"door": "json", "source": "bench", "tracker": limb, "limb": limb}
        ok(site.operator.put("/api/trackers/limbs", json=wish))
    session_id = materialised(site)
    path = f"/api/sessions/{session_id}/trackers"
    ok(site.operator.put(path, json={"door": "json", "source": "bench"}))
    return session_id, site.token(session_id)


@contextmanager
def _in_the_body(site: Site, token: str) -> Iterator[None]:
    """Keep the headset's own socket open, with the body entered: movement is then recorded."""
    with site.socket(token) as socket:
        body = {"kind": "materialised", "t_s": 1.0}
        socket.send(json.dumps({**HELLO, "avatars": ["physics"], "changes_avatar": True}))
        # The server loads compiled code for the first welcome, which takes long on a busy machine.
        epoch = json.loads(socket.recv(timeout=WELCOMED_WITHIN_S))["epoch"]
        socket.send(json.dumps({"type": "report", "epoch": epoch, "seq": 0, "body": body}))
        yield


class _Wearer:
    """The headset's second socket: says where the head is, and notes how late trackers are."""

    def __init__(self, server: LiveServer, token: str, lab: Lab) -> None:
        self.latencies_s: list[float] = []
        self.lost = 0
        self.is_aligned = threading.Event()
        self._lab = lab
        self._over = threading.Event()
        self._began_s: float | None = None
        url = server.url.replace("http", "ws") + "/api/vr/trackers"
        offered: Any = [SUBPROTOCOL, f"bearer.{token}"]
        self._socket = connect(url, subprotocols=offered, compression=None)
        self._threads = [threading.Thread(target=one) for one in (self._read, self._say)]

    def __enter__(self) -> "_Wearer":
        for one in self._threads:
            one.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._over.set()
        for one in self._threads:
            one.join()
        self._socket.close()

    def begin(self, began_s: float) -> None:
        """Say from now on where the head is: the room's time 0 is then."""
        self._began_s = began_s

    def _read(self) -> None:
        while not self._over.is_set():
            try:
                message = json.loads(self._socket.recv(timeout=0.2))
            except TimeoutError:
                continue
            if message["type"] != "trackers":
                continue
            self.is_aligned.set()
            if not {"LeftHand", "RightHand"} <= message["places"].keys():
                self.lost += 1  # for a quarter of a second nothing had come
                continue
            sent_s = self._lab.sent_s[self._lab.number(message["places"])]
            self.latencies_s.append(time.monotonic() - sent_s)

    def _say(self) -> None:
        after_s = 0.0
        while not self._over.wait(0.1):
            if self._began_s is None:
                continue
            now_s = time.monotonic() - self._began_s
            poses = self._lab.heads(after_s, now_s, self._began_s)
            after_s = now_s
            if poses:
                self._socket.send(json.dumps({"type": "head", "poses": poses}))


def _send_for(lab: Lab, wearer: _Wearer, ports: tuple[int, int], duration_s: float) -> None:
    """Send the trackers until they were aligned for `duration_s`, or were not in time."""
    began_s = time.monotonic()
    wearer.begin(began_s)
    until_s = began_s + ALIGNS_WITHIN_S
    with sender(ports[0]) as door, sender(ports[1]) as relay:
        for n, at in enumerate(lab.times_s.tolist()):
            time.sleep(max(0.0, began_s + at - time.monotonic()))
            now_s = time.monotonic()
            if wearer.is_aligned.is_set() and until_s - began_s == ALIGNS_WITHIN_S:
                until_s = now_s + duration_s
            if now_s > until_s:
                return
            lab.sent_s[n] = now_s
            packet = lab.datagram(n)
            door(packet)
            relay(packet)


def _stored(server: LiveServer, session_id: str) -> int:
    """Return how many poses of the trackers are on disk."""
    database = open_database(f"sqlite:///{server.data_dir / 'reembody.sqlite'}")
    try:
        with database.reading() as db:
            query = select(func.sum(TrackerChunk.sample_count)).where(
                TrackerChunk.session_id == session_id, TrackerChunk.source == "bench"
            )
            return int(db.scalar(query) or 0)
    finally:
        database.close()


@contextmanager
def _relayed(url: str) -> Iterator[list[float]]:
    """Read the relay's messages while the block runs; yield how late each was."""
    latencies_s: list[float] = []
    over = threading.Event()
    viewer = connected(url)

    def read() -> None:
        with viewer:
            while not over.is_set():
                try:
                    message = json.loads(viewer.recv(timeout=0.2))
                except TimeoutError:
                    continue
                latencies_s.append(time.monotonic() - message["time_s"])

    thread = threading.Thread(target=read)
    thread.start()
    try:
        yield latencies_s
    finally:
        over.set()
        thread.join()
