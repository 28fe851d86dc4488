"""Lines over a TCP connection, with a limit on their length and on the time to wait for one."""

import socket
import time

from app.adapters.cosimulation.messages import LONGEST_LINE


class LineTooLongError(ValueError):
    """The other side sent a longer line than is valid, or ended in the middle of one."""


class Lines:
    """Reads and writes the lines of one connection.

    Args:
        connection: connected; closed by `close`.
        send_s: how long sending may take.
    """

    def __init__(self, connection: socket.socket, send_s: float = 10.0) -> None:
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._connection, self._send_s = connection, send_s
        self._received = bytearray()

    def send(self, line: bytes) -> None:
        """Send one line; raise OSError if the other side has gone or does not read."""
        self._connection.settimeout(self._send_s)
        self._connection.sendall(line)

    def receive(self, timeout_s: float | None) -> bytes | None:
        """Return the next line, None if there is none in time, and nothing (b"") at the end.

        Raises:
            LineTooLongError: the line is too long.
            OSError: the connection broke.
        """
        until = None if timeout_s is None else time.monotonic() + timeout_s
        searched = 0
        while (end := self._received.find(b"\n", searched)) < 0:
            searched = len(self._received)
            if searched > LONGEST_LINE:
                raise LineTooLongError(f"a line has more than {LONGEST_LINE} bytes")
            # A timeout of 0 would mean "never wait" and raise another error.
            left_s = None if until is None else max(1e-6, until - time.monotonic())
            self._connection.settimeout(left_s)
            try:
                piece = self._connection.recv(65536)
            except TimeoutError:
                return None
            if not piece:
                return b""
            self._received += piece
        line = bytes(self._received[: end + 1])
        del self._received[: end + 1]
        return line

    def close(self) -> None:
        """Close the connection."""
        self._connection.close()
