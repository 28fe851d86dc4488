"""Tests of the fork server that starts the worker processes of servers under test."""

import os
import socket

from app.platform.workers import Worker
from tests.support.nursery import nursery


def test_a_server_killed_while_it_asks_does_not_end_the_fork_server() -> None:
    """A connection that closes without a request leaves the fork server able to start workers."""
    for _ in range(3):
        with socket.socket(socket.AF_UNIX) as asking:
            asking.connect(nursery().workers)
    worker = Worker()
    try:
        assert worker.submit(os.getpid).result(60) != os.getpid()
    finally:
        worker.end()
