"""Run a command, end all its descendants, and measure their processor time.

    this process --(starts)--> warden --(starts)--> command --> ... its descendants

On Linux the warden becomes the parent of every descendant that loses its own, so it can wait for
all of them: a server started by a helper that has ended, a database that put itself into the
background. The system then adds their processor time to the warden's, and the one number that
`run_warded` reads from it is that of the whole tree. Processes that still run when the command has
ended are given some seconds, then ended. If this process is killed, the warden ends everything
immediately. On other systems a warden only starts the command and passes its exit code on.
"""

import ctypes
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import IO, NoReturn

PARENT_DEATH_SIGNAL, CHILD_SUBREAPER = 1, 36
"""PR_SET_PDEATHSIG and PR_SET_CHILD_SUBREAPER of linux/prctl.h."""
WARDEN_VARIABLE = "REEMBODY_WARDEN"
ENDS_BY_ITSELF_WITHIN_S = 20.0
ENDS_WHEN_ASKED_WITHIN_S = 8.0
LOOKS_EVERY_S = 0.02
NOT_FOUND = 127


@dataclass(frozen=True)
class Ended:
    """How a command ended, and the processor time of its tree; `code` is negative for a signal."""

    code: int
    wall_s: float
    user_s: float
    system_s: float

    @property
    def processor_s(self) -> float:
        """Return the sum of user and system time."""
        return self.user_s + self.system_s

    @property
    def exit_code(self) -> int:
        """Return the code as a shell reports it: 128 plus the signal's number for a signal."""
        return self.code if self.code >= 0 else 128 - self.code


def run_warded(
    command: list[str],
    *,
    folder: Path,
    environment: Mapping[str, str] | None = None,
    output: IO[bytes] | None = None,
    errors: IO[bytes] | int | None = None,
) -> Ended:
    """Run `command` in `folder` with a warden of its own; `output` and `errors` are Popen's.

    Raises `OSError` if the warden itself cannot start. An exception raised meanwhile is delayed
    until the warden has ended everything.
    """
    began_s = time.monotonic()
    warden = subprocess.Popen(
        # Isolated and without site-packages: it starts sooner.
        [sys.executable, "-I", "-S", __file__, str(os.getpid()), *command],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=output,
        stderr=errors,
    )
    try:
        _, status, used = os.wait4(warden.pid, 0)
    except BaseException as interruption:
        _end(warden, ENDS_WHEN_ASKED_WITHIN_S if isinstance(interruption, KeyboardInterrupt) else 0)
        raise
    code = warden.returncode = os.waitstatus_to_exitcode(status)
    killed = 128 < code <= 128 + signal.NSIG
    wall_s = time.monotonic() - began_s
    return Ended(128 - code if killed else code, wall_s, used.ru_utime, used.ru_stime)


def is_warded() -> bool:
    """Return whether this process is the command of a warden."""
    return os.environ.get(WARDEN_VARIABLE) == str(os.getppid())


def _end(warden: "subprocess.Popen[bytes]", patience_s: float) -> None:
    """Wait for a command that may be ending after Ctrl+C, then terminate the warden."""
    try:
        warden.wait(patience_s)
    except subprocess.TimeoutExpired:
        warden.terminate()
        warden.wait()


class _Stop(Exception):
    """Raised when everything must end immediately."""


def _stop(number: int, _frame: FrameType | None) -> NoReturn:
    raise _Stop(number)


def _control(option: int, value: int) -> None:
    """Call prctl on systems that provide it."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(option, value, 0, 0, 0)


def _watch(caller: int, command: list[str]) -> int:
    """Act as the warden; return the command's exit code, 128 plus the number for a signal."""
    signal.signal(signal.SIGTERM, _stop)
    signal.signal(signal.SIGHUP, _stop)
    # A terminal sends Ctrl+C to the command too, which then ends in its own way; a command that
    # a shell has put into the background must ignore it, and inherits that.
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, lambda *_: None)
    _control(CHILD_SUBREAPER, 1)
    _control(PARENT_DEATH_SIGNAL, signal.SIGTERM)
    try:
        if os.getppid() != caller:
            return 128 + signal.SIGTERM
        code = _wait_for(_started(command))
        if not _all_ended(ENDS_BY_ITSELF_WITHIN_S):
            left = ", ".join(sorted(_name(child) for child in _children()))
            _say(f"still running after {command[0]} had ended, now ended: {left}")
            _end_all()
    except _Stop as stopped:
        for number in (signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_IGN)
        _end_all()
        return 128 + int(stopped.args[0])
    return code if code >= 0 else 128 - code


def _started(command: list[str]) -> int:
    warden = os.getpid()
    child = os.fork()
    if child:
        return child
    try:
        for number in (signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)
        # A killed warden cannot end the command: then the command is at least asked to end.
        _control(PARENT_DEATH_SIGNAL, signal.SIGTERM)
        os.environ[WARDEN_VARIABLE] = str(warden)
        if os.getppid() == warden:
            os.execvp(command[0], command)  # noqa: S606  # no shell is meant
    except OSError as error:
        _say(f"{command[0]}: {error.strerror}")
    os._exit(NOT_FOUND)


def _wait_for(command: int) -> int:
    while True:
        child, status = os.wait()
        if child == command:
            return os.waitstatus_to_exitcode(status)


def _all_ended(within_s: float) -> bool:
    """Wait for every child, including newly adopted ones; return False if it takes too long."""
    deadline_s = time.monotonic() + within_s
    while time.monotonic() < deadline_s:
        try:
            if os.waitpid(-1, os.WNOHANG)[0] == 0:
                time.sleep(LOOKS_EVERY_S)
        except ChildProcessError:
            return True
    return False


def _end_all() -> None:
    """Terminate every child, including newly adopted ones; later kill those that remain."""
    kills_from_s = time.monotonic() + ENDS_WHEN_ASKED_WITHIN_S
    asked: set[int] = set()
    while not _all_ended(5 * LOOKS_EVERY_S):
        if time.monotonic() > kills_from_s:
            _signal_all(_children(), signal.SIGKILL)
        else:
            unasked = set(_children()) - asked
            _signal_all(unasked, signal.SIGTERM)
            asked |= unasked


def _signal_all(children: Iterable[int], number: int) -> None:
    for child in children:
        try:
            os.kill(child, number)
        except ProcessLookupError:
            continue


def _children() -> list[int]:
    """Return the child processes of this process.

    In /proc, the second word after the name in brackets is the parent.
    """
    ours = str(os.getpid())
    names = [entry.name for entry in Path("/proc").glob("[0-9]*")]
    return [int(name) for name in names if _stat(name).rpartition(")")[2].split()[1:2] == [ours]]


def _name(child: int) -> str:
    return _stat(str(child)).partition("(")[2].rpartition(")")[0] or str(child)


def _stat(process: str) -> str:
    try:
        return Path("/proc", process, "stat").read_text(errors="replace")
    except OSError:
        return ""


def _say(line: str) -> None:
    sys.stderr.write(f"{line}\n")
    sys.stderr.flush()


if __name__ == "__main__":
    sys.exit(_watch(int(sys.argv[1]), sys.argv[2:]))
