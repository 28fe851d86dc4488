"""Tests that a killed rehearsal or test run leaves no server behind."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import psutil

from tests.support.unit_tests import needs

REHEARSE = (sys.executable, "-m", "app.cli", "rehearse", "--speed", "20", "--seed", "1")
MOVING, A_WHILE_S = "Free movement", 0.5
"""The first phase: the avatar was built, and movement is stored from then on."""
TEST_RUN = """
import pathlib, sys, time
from tests.support.server import LiveServer
server = LiveServer(pathlib.Path(sys.argv[1])).start()
print(server.pid, flush=True)
time.sleep(1000)
"""
GENEROUS_S = 120.0


def test_a_killed_rehearsal_leaves_no_process(tmp_path: Path) -> None:
    """A rehearsal killed in mid-phase leaves neither its server nor the server's own processes."""
    needs("a server")
    environment = {**os.environ, "TMPDIR": str(tmp_path)}
    with subprocess.Popen(
        REHEARSE, env=environment, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as rehearsal:
        assert rehearsal.stderr is not None
        assert any(MOVING in line for line in rehearsal.stderr)
        time.sleep(A_WHILE_S)
        descended = psutil.Process(rehearsal.pid).children(recursive=True)
        rehearsal.kill()
        rehearsal.stderr.close()
    assert len(descended) > 1
    eventually(lambda: not any(map(runs, descended)) and not group_of(rehearsal.pid))


def test_a_killed_test_run_leaves_no_server(tmp_path: Path) -> None:
    """A killed test run leaves no server, although the nursery forked it."""
    needs("a server")
    command = [sys.executable, "-c", TEST_RUN, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as run:
        assert run.stdout is not None
        server = psutil.Process(int(run.stdout.readline()))
        run.send_signal(signal.SIGKILL)
    eventually(lambda: not runs(server))


def runs(process: psutil.Process) -> bool:
    """Return whether a process has not ended; a process that was not reaped has ended."""
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


def group_of(leader: int) -> list[psutil.Process]:
    """Return the processes of a group that still run."""
    found = []
    for process in psutil.process_iter():
        try:
            if os.getpgid(process.pid) == leader and runs(process):
                found.append(process)
        except ProcessLookupError:
            continue
    return found


def eventually(happened: Callable[[], bool]) -> None:
    """Wait for a condition; fail after a time that only a hung process takes."""
    give_up_s = time.monotonic() + GENEROUS_S
    while not happened():
        assert time.monotonic() < give_up_s, "a process is still there"
        time.sleep(0.1)
