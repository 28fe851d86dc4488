"""Tests that a command under a warden leaves no process behind and is fully timed."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support.warden import run_warded

REPOSITORY = Path(__file__).resolve().parents[2]
linux = pytest.mark.skipif(sys.platform != "linux", reason="only Linux hands orphans on")
BURN_S = 0.3
BURN = f"""
import time
while time.process_time() < {BURN_S}: pass
"""
LEAVE = """
import subprocess, sys
subprocess.Popen([sys.executable, "-S", "-c", {code!r}], start_new_session=True)
"""
SERVE = """
import os, sys, time
open({file!r}, "w").write(str(os.getpid()))
time.sleep(600)
"""
CALL = """
import sys
from pathlib import Path
from tests.support.warden import run_warded
sys.exit(run_warded({command!r}, folder=Path({folder!r})).exit_code)
"""
WAITS_S = 60.0


def python(code: str) -> list[str]:
    """Return a command that runs a piece of Python code."""
    return [sys.executable, "-S", "-c", code]


def eventually(fact: Callable[[], bool]) -> None:
    """Wait until the condition is true."""
    deadline_s = time.monotonic() + WAITS_S
    while not fact():
        assert time.monotonic() < deadline_s, "it did not come true"
        time.sleep(0.02)


def lives(pid: int) -> bool:
    """Return whether the process exists; one that has ended but was not reaped does not."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"


@pytest.mark.parametrize("code", [0, 3, 127])
def test_the_exit_code_is_that_of_the_command(tmp_path: Path, code: int) -> None:
    """The exit code of a warded run is the exit code of its command."""
    assert run_warded(python(f"raise SystemExit({code})"), folder=tmp_path).code == code


def test_a_signal_is_reported(tmp_path: Path) -> None:
    """The end of a command by a signal is reported as a negative code, and as a shell's code."""
    ended = run_warded(["sh", "-c", "kill -9 $$"], folder=tmp_path)
    assert (ended.code, ended.exit_code) == (-signal.SIGKILL, 128 + signal.SIGKILL)


def test_a_missing_command_is_named(tmp_path: Path) -> None:
    """A missing command is named and gives exit code 127, as in a shell."""
    with (tmp_path / "errors").open("wb") as errors:
        assert run_warded(["no-such-command"], folder=tmp_path, errors=errors).code == 127
    assert "no-such-command" in (tmp_path / "errors").read_text()


@linux
def test_the_time_of_an_orphan_counts(tmp_path: Path) -> None:
    """A process that outlives its parent, in its own session, is awaited and timed."""
    ended = run_warded(python(LEAVE.format(code=BURN)), folder=tmp_path)
    assert ended.code == 0
    assert ended.processor_s >= BURN_S


@linux
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_killing_the_caller_ends_its_servers(tmp_path: Path, number: int) -> None:
    """Killing the caller also ends a server that runs in its own session."""
    mark = tmp_path / "pid"
    command = python(
        LEAVE.format(code=SERVE.format(file=str(mark))) + "\nimport time\ntime.sleep(600)"
    )
    caller = subprocess.Popen(
        python(CALL.format(command=command, folder=str(tmp_path))),
        cwd=REPOSITORY,
        env={**os.environ, "PYTHONPATH": str(REPOSITORY)},
    )
    eventually(lambda: mark.exists() and mark.read_text().isdigit())
    server = int(mark.read_text())
    assert lives(server)
    caller.send_signal(number)
    caller.wait()
    eventually(lambda: not lives(server))
