"""UDP for tests: a free port, a sender from one address, and one that sends all the time."""

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
