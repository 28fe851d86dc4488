"""Take the datagrams of one door in a thread of its own.

A thread, so that neither a busy server delays a door nor a busy door the server: what is read is
limited, and the rest is only counted.
"""

import errno
import logging
import select
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from dataclasses import dataclass
from typing import Literal

from app.adapters.live import (
    DATA_PORT,
    MULTICAST_GROUP,
    Decoder,
    JsonTrackers,
    OscTrackers,
    Reading,
)
from app.features.movement.live.datagrams import DatagramSocket
from app.features.movement.live.doors import DoorSettings
from app.features.movement.live.natnet_link import NatNetLink
from app.features.movement.live.sources import DoorKey

log = logging.getLogger(__name__)
DoorState = Literal["opening", "open", "failed"]
TroubleKind = Literal["port_in_use", "no_such_address", "forbidden", "unreachable", "other"]
Take = Callable[[DoorKey, list[tuple[str, Reading, float]]], None]
BATCH = 256
"""The most datagrams that are taken before the state is updated."""
BYTES_PER_S: dict[DoorKey, float] = {"osc": 2.5e6, "json": 2.5e6, "natnet": 10e6}
"""What is read of a door: four performers with all their bones at 120 Hz by VMC, and what Motive
sends, which takes less time to read. Reading so much takes a third of a processor core."""
PACKET_BYTES = 64
"""What a packet counts beside its content, because a small one takes time as well."""
BURST_S = 0.25
WAIT_S = 0.2
RETRY_S = 2.0
_KINDS: dict[int, TroubleKind] = {
    errno.EADDRINUSE: "port_in_use",
    errno.EADDRNOTAVAIL: "no_such_address",
    errno.EACCES: "forbidden",
    errno.EPERM: "forbidden",
    errno.ENETUNREACH: "unreachable",
    errno.EHOSTUNREACH: "unreachable",
    errno.ENODEV: "unreachable",
}


@dataclass(frozen=True)
class Trouble:
    """Why a door could not be opened, or Motive not be asked; `detail` as the system says it."""

    kind: TroubleKind
    detail: str

    @classmethod
    def of(cls, error: OSError) -> "Trouble":
        """Return what an error of the system means."""
        return cls(_KINDS.get(error.errno or 0, "other"), error.strerror or str(error))


class Budget:
    """How much may be read: so many bytes a second, and no more at once than `BURST_S` allows."""

    def __init__(self, bytes_per_s: float) -> None:
        self._bytes_per_s = bytes_per_s
        self._left = bytes_per_s * BURST_S
        self._at_s: float | None = None

    def takes(self, size: int, now_s: float) -> bool:
        """Return whether a packet of `size` bytes may be read now, and if so, count it."""
        passed_s = 0.0 if self._at_s is None else max(0.0, now_s - self._at_s)
        self._at_s = now_s
        most = self._bytes_per_s * BURST_S
        self._left = min(most, self._left + passed_s * self._bytes_per_s)
        if self._left < size + PACKET_BYTES:
            return False
        self._left -= size + PACKET_BYTES
        return True


@dataclass
class Received:
    """What came through a door since it was opened.

    `foreign` packets are not from Motive's address. `unread` ones came faster than the door reads.
    `dropped` ones were dropped by the kernel; None where it does not say.
    """

    packets: int = 0
    foreign: int = 0
    unread: int = 0
    dropped: int | None = None


class Listener:
    """An open door. It opens in its thread, and tries again until it is stopped."""

    def __init__(self, settings: DoorSettings, take: Take, monotonic_ns: Callable[[], int]) -> None:
        self.settings = settings
        self.state: DoorState = "opening"
        self.trouble: Trouble | None = None
        self.received = Received()
        self._take = take
        self._monotonic_ns = monotonic_ns
        self._link = NatNetLink() if settings.door == "natnet" else None
        self._decoder: Decoder = JsonTrackers() if settings.door == "json" else OscTrackers()
        self._budget = Budget(BYTES_PER_S[settings.door])
        self._tried = threading.Event()
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"door-{settings.door}", daemon=True)

    def start(self) -> None:
        """Start the thread, and wait until the door is open or has failed."""
        self._thread.start()
        self._tried.wait(RETRY_S)

    def stop(self) -> None:
        """Close the door."""
        self._stopping.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._stopping.is_set():
            try:
                with ExitStack() as stack:
                    sockets = [stack.enter_context(closing(one)) for one in _sockets(self.settings)]
                    self.state, self.trouble = "open", None
                    self._tried.set()
                    self._serve(sockets)
            except OSError as error:
                self.state, self.trouble = "failed", Trouble.of(error)
                self._tried.set()
                self._stopping.wait(RETRY_S)

    def _serve(self, sockets: list[DatagramSocket]) -> None:
        while not self._stopping.is_set():
            ready, _, _ = select.select(sockets, [], [], WAIT_S)
            for one in ready:
                try:
                    self._take(self.settings.door, list(self._drain(one)))
                except OSError:
                    raise  # The network is gone: the door has to be opened anew.
                except Exception:
                    # One batch is lost; the door must stay open for the ones that follow.
                    log.exception("tracking data could not be taken")
            drops = [count for one in sockets if (count := one.dropped()) is not None]
            self.received.dropped = sum(drops) if drops else None
            self._ask(sockets[0])

    def _ask(self, commands: DatagramSocket) -> None:
        """Send Motive what is due; it may be away, which must not close the door."""
        if self._link is None or self.settings.server is None:
            return
        request = self._link.due(self._now_s())
        if request is not None:
            try:
                commands.raw.sendto(request, (self.settings.server, self.settings.port))
                self.trouble = None
            except OSError as error:
                self.trouble = Trouble.of(error)

    def _drain(self, one: DatagramSocket) -> Iterator[tuple[str, Reading, float]]:
        for _ in range(BATCH):
            try:
                packet, sender, age_s = one.receive()
            except (BlockingIOError, ConnectionError):
                # Nothing left, or the news that nobody listens at Motive's address.
                return
            self.received.packets += 1
            now_s = self._now_s()
            if self._link is not None and sender[0] != self.settings.server:
                self.received.foreign += 1
            elif self._budget.takes(len(packet), now_s):
                yield self._read(packet, sender, now_s - age_s)
            else:
                # Left in the kernel's buffer it would delay those that are read later.
                self.received.unread += 1

    def _read(
        self, packet: bytes, sender: tuple[str, int], arrival_s: float
    ) -> tuple[str, Reading, float]:
        host, port = sender
        if self._link is None:
            return f"{host}:{port}", self._decoder.read(packet), arrival_s
        # Answers and frames come from different ports of one Motive.
        return f"{host}:{self.settings.port}", self._link.read(packet, arrival_s), arrival_s

    def _now_s(self) -> float:
        return self._monotonic_ns() / 1e9


def _sockets(settings: DoorSettings) -> Iterator[DatagramSocket]:
    """Yield the sockets of a door, the one for requests first; raises OSError."""
    if settings.door != "natnet":
        yield DatagramSocket(settings.interface, settings.port)
        return
    yield DatagramSocket(settings.interface, 0)
    if settings.multicast:
        data = DatagramSocket("", DATA_PORT, is_shared=True)
        try:
            data.join(MULTICAST_GROUP, settings.interface)
        except OSError:
            data.close()
            raise
        yield data
