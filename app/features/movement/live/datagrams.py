"""Sockets that say when a datagram arrived, and how many the kernel dropped."""

import socket
import struct
import sys
import time

LARGEST_BYTES = 65_535
BUFFER_BYTES = 4 * 2**20
"""The kernel's buffer that is asked for: seconds of what the busiest sources send."""
OLDEST_S = 10.0
_ON_LINUX = sys.platform == "linux"
# Options of Linux that Python does not name.
_ARRIVAL = 35  # SO_TIMESTAMPNS
_MEMORY = 55  # SO_MEMINFO, since Linux 4.12
_MEMORY_FIELDS = "@9I"
_DROPS = 8  # SK_MEMINFO_DROPS, the last field
_TIMESPEC = "@ll"
_SPACE = socket.CMSG_SPACE(struct.calcsize(_TIMESPEC)) if _ON_LINUX else 0


class DatagramSocket:
    """A UDP socket that does not block; raises OSError if the address cannot be bound.

    `is_shared`: other programs may take the same multicast packets.
    """

    def __init__(self, address: str, port: int, *, is_shared: bool = False) -> None:
        self.raw = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self.raw.setblocking(False)
            self.raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
            if _ON_LINUX:
                self.raw.setsockopt(socket.SOL_SOCKET, _ARRIVAL, 1)
            if is_shared:
                self.raw.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            self.raw.bind((address, port))
        except OSError:
            self.raw.close()
            raise

    def fileno(self) -> int:
        """Return what `select` waits for."""
        return self.raw.fileno()

    def join(self, group: str, interface: str) -> None:
        """Take what is sent to a multicast group in the network of an interface."""
        membership = socket.inet_aton(group) + socket.inet_aton(interface)
        self.raw.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)

    def dropped(self) -> int | None:
        """Return how many datagrams the kernel dropped, its buffer being full; None if unknown.

        The kernel is asked: the count that it sends beside a datagram is of when that one came in,
        so a flood with nothing after it would be hidden.
        """
        if not _ON_LINUX:
            return None
        try:
            fields = self.raw.getsockopt(
                socket.SOL_SOCKET, _MEMORY, struct.calcsize(_MEMORY_FIELDS)
            )
            return int(struct.unpack(_MEMORY_FIELDS, fields)[_DROPS])
        except (OSError, struct.error):
            return None

    def receive(self) -> tuple[bytes, tuple[str, int], float]:
        """Return a datagram, its sender, and how many seconds ago it arrived.

        The kernel stamps a datagram when it comes in, so a busy server does not make it late; where
        the kernel does not, it has only just arrived. Raises BlockingIOError if there is none.
        """
        if not _ON_LINUX:
            packet, sender = self.raw.recvfrom(LARGEST_BYTES)
            return packet, sender, 0.0
        packet, extra, _, sender = self.raw.recvmsg(LARGEST_BYTES, _SPACE)
        age_s = 0.0
        for level, kind, data in extra:
            if (level, kind) == (socket.SOL_SOCKET, _ARRIVAL):
                age_s = _age_s(*struct.unpack(_TIMESPEC, data))
        return packet, sender, age_s

    def close(self) -> None:
        """Give the port back."""
        self.raw.close()


def _age_s(seconds: int, nanoseconds: int) -> float:
    """Return the time since a stamp of the kernel, which is by the time of day."""
    age_s = (time.time_ns() - seconds * 10**9 - nanoseconds) / 1e9
    # The time of day may be set meanwhile; no datagram waits as long as this suggests then.
    return age_s if 0 <= age_s <= OLDEST_S else 0.0
