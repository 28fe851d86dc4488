"""A skeleton of 21 bones at 360 Hz, by NatNet, onto a body of CMU's 31 joints, to a page's socket.

From making a datagram to reading the message with the pose of that datagram, which the source's
time tells. A bare relay in a process of its own gets the same datagrams in the same run. What the
door received has to be given out, or to be counted as left out for newer poses.
"""

import socket
import struct
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from websockets.sync.client import connect

from app.adapters.live import connect_request, model_request
from app.features.movement.performers.socket import HEADER
from app.science.retargeting import (
    REFERENCE_JOINT_MAP,
    Retargeter,
    example_walk,
    named_avatar,
)
from app.science.rig import Rig, RigMotion
from app.science.skeleton import Movement, resample
from tests.adapters.live.packets import frame, server_info
from tests.benchmarks.clips import shared_file
from tests.benchmarks.relay import connected, relay
from tests.benchmarks.report import CannotMeasure, Figure
from tests.features.lab import ok
from tests.features.movement.performers.senders import ORDER, SKELETON, natnet_definitions
from tests.support.datagrams import HERE, free_udp_port
from tests.support.server import ADMIN_PASSWORD, LiveServer

RATE_HZ = 360.0
DURATION_S = 60.0
READY_WITHIN_S = 180.0
SETTLES_S = 2.0
P50_MS, P99_MS = 2.0, 8.0
LEFT_OUT_BONE = "UpperChest"
CMU = ("motion", "cmu_bvh/02_01.bvh")
_NUMBER_AT, _TIME_FROM_END = 4, 38


def live_figures(folder: Path, duration_s: float) -> Iterator[Figure]:
    """Yield the figures of the part `live`."""
    door_port, relay_port = free_udp_port(), free_udp_port()
    with (
        relay(relay_port) as relay_url,
        LiveServer(folder) as server,
        _Motive(door_port) as motive,
        server.client() as client,
    ):
        ok(client.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        avatar, joints = _avatar(client)
        body = {"is_open": True, "interface": HERE, "port": door_port, "server": HERE}
        ok(client.put("/api/trackers/doors/natnet", json=body))
        cookie = "; ".join(f"{name}={value}" for name, value in client.cookies.items())
        query = f"door=natnet&source=Motive&skeleton={SKELETON}&avatar={avatar}&ahead=16"
        url = f"{server.url.replace('http', 'ws')}/api/trackers/performers/watch?{query}"
        address = url.replace(" ", "%20")
        page = connect(address, additional_headers={"Cookie": cookie}, compression=None)
        with page, _Page(page) as ours, _Relayed(relay_url) as bare:
            motive.send(relay_port, ours, bare, duration_s)
            time.sleep(SETTLES_S)
        shown = ok(client.get("/api/trackers"))
    door = next(one for one in shown["doors"] if one["door"] == "natnet")
    what, peer = f"21 bones x 360 Hz to a page, {joints} joints", "bare UDP to WebSocket relay"
    if not ours.latencies_s or not bare.latencies_s:
        raise CannotMeasure(f"no pose came: {ours.said}")
    for name, percentile, limit_ms in (("p50", 50, P50_MS), ("p99", 99, P99_MS)):
        own_ms = 1000 * float(np.percentile(ours.latencies_s, percentile))
        bare_ms = 1000 * float(np.percentile(bare.latencies_s, percentile))
        yield Figure("live", f"{what}, {name}", own_ms, "ms", "at most", limit_ms)
        yield Figure("live", f"{name} beside the relay's", own_ms, "ms", peer, bare_ms)
    frames = ours.last - ours.first + 1
    yield Figure("live", "frames that came to the performer", frames, "")
    yield Figure("live", "poses to the page", ours.poses, "")
    yield Figure("live", "left out for newer ones, counted", ours.skipped, "")
    unknown = frames - ours.poses - ours.skipped
    yield Figure("live", "neither given out nor counted", abs(unknown), "", "at most", 0)
    yield Figure("live", "sent and not received", motive.sent - ours.last, "")
    yield Figure("live", "dropped by the kernel", door["dropped"] or 0, "", "at most", 0)


def _avatar(client: Any) -> tuple[str, int]:
    """Return the body to watch on: that of CMU 02 if there are data, else one of 165 cm."""
    path = shared_file(*CMU)
    if path is None:
        return "165cm", 22
    stored = ok(client.post("/api/captures", params={"name": path.name}, content=path.read_bytes()))
    return str(stored["id"]), len(stored["summary"]["skeleton"]["joints"])


def performed() -> RigMotion:
    """Return a walk at 360 Hz of a skeleton of 21 bones, which has no upper chest."""
    walk = example_walk()
    whole = named_avatar("175cm")
    kept = [at for at, name in enumerate(whole.names) if name != LEFT_OUT_BONE]
    gone = whole.index(LEFT_OUT_BONE)
    offsets = whole.offsets_m.copy()
    for at, parent in enumerate(whole.parents):
        if parent == gone:
            offsets[at] += whole.offsets_m[gone]
    parents = [
        whole.parents[at] if whole.parents[at] != gone else whole.parents[gone] for at in kept
    ]
    rig = Rig(
        tuple(whole.names[at] for at in kept),
        tuple(-1 if one < 0 else kept.index(one) for one in parents),
        offsets[kept],
        whole.rest_rotations[kept],
    )
    joint_map = {one: one for one in rig.names}
    moved = Retargeter(walk.rig, REFERENCE_JOINT_MAP, rig, joint_map).batch(walk)
    even = resample(Movement(moved.rate_hz, moved.root_positions_m, moved.rotations), RATE_HZ)
    known = np.ones(even.rotations.shape[:2], dtype=np.bool_)
    return RigMotion(rig, RATE_HZ, even.root_positions_m, even.rotations, known)


class _Motive:
    """Answers a client as Motive does, and sends it frames."""

    def __init__(self, port: int) -> None:
        self.sent = 0
        self._motion = performed()
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((HERE, port))
        self._socket.settimeout(0.2)
        self._client: tuple[str, int] | None = None
        self._told = threading.Event()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._answer)

    def __enter__(self) -> "_Motive":
        self._thread.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._over.set()
        self._thread.join()
        self._socket.close()

    def _answer(self) -> None:
        info, definitions = server_info((3, 0)), natnet_definitions(self._motion)
        kinds = {connect_request()[:2]: info, model_request()[:2]: definitions}
        while not self._over.is_set():
            try:
                request, self._client = self._socket.recvfrom(2048)
            except TimeoutError:
                continue
            answer = kinds.get(request[:2])
            if answer is not None:
                self._socket.sendto(answer, self._client)
            if answer is definitions:
                self._told.set()

    def send(self, relay_port: int, ours: "_Page", bare: "_Relayed", duration_s: float) -> None:
        """Send frames to the client and to the relay for this long, from when a pose came."""
        if not self._told.wait(READY_WITHIN_S) or self._client is None:
            raise CannotMeasure("the server has not asked for definitions")
        frames = [bytearray(one) for one in _frames(self._motion)]
        began_s = time.monotonic()
        until_s = began_s + READY_WITHIN_S
        ready = False
        number = 0
        while True:
            due_s = began_s + number / RATE_HZ
            time.sleep(max(0.0, due_s - time.monotonic()))
            now_s = time.monotonic()
            if not ready and ours.latencies_s:
                ready, until_s = True, now_s + SETTLES_S + duration_s
                ours.counts_from(number + int(SETTLES_S * RATE_HZ))
                bare.counts_from(number + int(SETTLES_S * RATE_HZ))
            if now_s > until_s:
                return
            packet = frames[number % len(frames)]
            struct.pack_into("<i", packet, _NUMBER_AT, number)
            struct.pack_into("<d", packet, len(packet) - _TIME_FROM_END, number / RATE_HZ)
            ours.sent_s.append(now_s)
            bare.sent_s.append(now_s)
            self._socket.sendto(packet, self._client)
            self._socket.sendto(packet, (HERE, relay_port))
            self.sent += 1
            number += 1


def _frames(motion: RigMotion) -> Iterator[bytes]:
    """Yield a frame for each of the movement's, bones in the world, as Motive usually sends."""
    places, world = motion.world()
    for at in range(motion.frame_count):
        rows = [
            (joint + 1, tuple(places[at, joint].tolist()), tuple(world[at, joint].tolist()), True)
            for joint in range(motion.rig.joint_count)
        ]
        yield frame((3, 0), 0, 0.0, (), {ORDER: rows})


class _Reader:
    """Reads messages in a thread, and notes how late each is against its datagram."""

    def __init__(self, viewer: Any) -> None:
        self.sent_s: list[float] = []
        self.latencies_s: list[float] = []
        self._viewer = viewer
        self._from = 0
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._read)

    def counts_from(self, number: int) -> None:
        """Forget what was measured, and count from a datagram on."""
        self._from = number
        self.latencies_s.clear()

    def note(self, number: int) -> None:
        """Note that a message about a datagram was read now."""
        if number >= self._from and number < len(self.sent_s):
            self.latencies_s.append(time.monotonic() - self.sent_s[number])

    def take(self, message: str | bytes) -> None:
        """Take a message."""
        raise NotImplementedError

    def _read(self) -> None:
        while not self._over.is_set():
            try:
                message = self._viewer.recv(timeout=0.2)
            except TimeoutError:
                continue
            self.take(message)

    def __exit__(self, *_error: object) -> None:
        self._over.set()
        self._thread.join()


class _Page(_Reader):
    """The page that watches: it answers every pose at once."""

    def __init__(self, viewer: Any) -> None:
        super().__init__(viewer)
        self.said: list[str] = []
        self.first = self.last = self.skipped = self.poses = 0

    def __enter__(self) -> "_Page":
        self._thread.start()
        return self

    def take(self, message: str | bytes) -> None:
        """Take a pose, or what the server says about itself."""
        if isinstance(message, str):
            self.said.append(message[:200])
            return
        _, _, _, self.last, self.skipped, source_s, _, _ = HEADER.unpack_from(message)
        self.note(round(source_s * RATE_HZ))
        self._viewer.send("")
        self.poses += 1
        self.first = self.first or self.last


class _Relayed(_Reader):
    """The reader of the bare relay."""

    def __init__(self, url: str) -> None:
        super().__init__(connected(url))

    def __enter__(self) -> "_Relayed":
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        super().__exit__(*error)
        self._viewer.close()

    def take(self, message: str | bytes) -> None:
        """Take a datagram."""
        if isinstance(message, bytes):
            (time_s,) = struct.unpack_from("<d", message, len(message) - _TIME_FROM_END)
            self.note(round(time_s * RATE_HZ))
