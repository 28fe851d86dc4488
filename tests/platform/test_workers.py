"""Tests of worker processes: replaced when they die, ended with the server."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import CancelledError
from concurrent.futures.process import BrokenProcessPool

import psutil
import pytest

from app.platform.workers import NICENESS, Worker

KILLED_SERVER = """
import os, signal
from app.platform.workers import Worker
if __name__ == "__main__":
    print(Worker().submit(os.getpid).result(), flush=True)
    os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.fixture
def worker() -> Iterator[Worker]:
    """Yield a worker and end it afterwards."""
    worker = Worker()
    yield worker
    worker.end()


def test_tasks_run_one_after_the_other_in_one_process(worker: Worker) -> None:
    """All tasks run one after the other in one separate process of low priority."""
    first, second = worker.submit(os.getpid).result(), worker.submit(os.getpid).result()
    assert first == second != os.getpid()
    assert worker.submit(os.nice, 0).result() == os.nice(0) + NICENESS


def test_a_dead_process_is_replaced(worker: Worker) -> None:
    """When the process dies, its task fails and the next one runs in a new process."""
    first = worker.submit(os.getpid).result()
    with pytest.raises(BrokenProcessPool):
        worker.submit(os.kill, first, signal.SIGKILL).result()
    assert worker.submit(os.getpid).result() != first


def test_an_ended_worker_can_start_again(worker: Worker) -> None:
    """Ending a worker kills its process, even during a task; the next task starts another."""
    first = worker.submit(os.getpid).result()
    endless = worker.submit(time.sleep, 1000)
    worker.end()
    with pytest.raises((BrokenProcessPool, CancelledError)):
        endless.result()
    assert not psutil.pid_exists(first)
    assert worker.submit(os.getpid).result() != first


def test_no_process_outlives_a_killed_server() -> None:
    """A worker's process ends by itself when its server is killed."""
    server = subprocess.run(
        [sys.executable, "-c", KILLED_SERVER], capture_output=True, text=True, check=False
    )
    pid = int(server.stdout)
    for _ in range(200):
        if not psutil.pid_exists(pid):
            return
        time.sleep(0.05)
    pytest.fail(f"process {pid} is still there")
