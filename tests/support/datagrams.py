"""UDP for tests: a free port, senders from one address, and a network that misbehaves."""

import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from tests.support.beside import beside

HERE = "127.0.0.1"


def free_udp_port() -> int:
    """Return a UDP port that nobody uses."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind((HERE, 0))
        port: int = one.getsockname()[1]
        return port


@contextmanager
def taken_port(port: int) -> Iterator[None]:
    """Use a UDP port during the block, as another program would."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind((HERE, port))
        yield


@contextmanager
def sender(port: int) -> Iterator[Callable[[bytes], object]]:
    """Yield a function that sends a datagram, from one address, to a port of this machine."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        yield lambda packet: one.sendto(packet, (HERE, port))


@contextmanager
def sending(port: int, packet: Callable[[int], bytes]) -> Iterator[None]:
    """Send 50 packets a second, numbered from 1, to a port of this machine during the block."""

    def send(stop: threading.Event) -> None:
        with sender(port) as one:
            number = 0
            while not stop.wait(0.02):
                number += 1
                one(packet(number))

    with beside(send):
        yield


class Network:
    """A way for datagrams to a port that loses, doubles or swaps them, from one address.

    `is_gone`: all are lost. `doubles`: each arrives twice. `swaps`: each second one is overtaken by
    the next. `passed`: what has arrived, each once.
    """

    def __init__(self, send: Callable[[bytes], object]) -> None:
        self.is_gone = self.doubles = self.swaps = False
        self.passed: list[bytes] = []
        self._send = send
        self._held: bytes | None = None

    def __call__(self, packet: bytes) -> None:
        """Let a datagram go the way."""
        if self.is_gone:
            return
        if self.swaps and self._held is None:
            self._held = packet
            return
        held, self._held = self._held, None
        for one in (packet,) if held is None else (packet, held):
            self.passed.append(one)
            for _ in range(2 if self.doubles else 1):
                self._send(one)
