"""Run PostgreSQL until the test run ends.

The keeper is a separate process: it ends PostgreSQL on request (SIGTERM) and when the test run has
ended for any reason, so that a killed run leaves no server behind. The last thing it does is to
write `stopped` into its folder.

Arguments: the owner's pid, the account (uid, gid), the folder, then PostgreSQL's command line.
"""

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from types import FrameType

import psutil

LOOKS_EVERY_S = 0.5
FAST_SHUTDOWN_S = 10.0


class StopRequested(Exception):  # a request, not an error
    """Raised when SIGTERM arrives."""


def keep(owner: psutil.Process, server: subprocess.Popen[bytes]) -> None:
    """Wait until the server ends, the owner has ended, or SIGTERM arrives."""
    try:
        while alive(owner):
            try:
                server.wait(LOOKS_EVERY_S)
            except subprocess.TimeoutExpired:
                continue
            return
    except StopRequested:
        return


def alive(owner: psutil.Process) -> bool:
    """Return whether a process is running; a process that has ended but was not reaped is not."""
    try:
        return owner.is_running() and owner.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


def shut_down(server: subprocess.Popen[bytes]) -> None:
    """Shut PostgreSQL down fast, or immediately if that takes too long."""
    for request in (signal.SIGINT, signal.SIGQUIT, signal.SIGKILL):
        if server.poll() is not None:
            return
        server.send_signal(request)
        try:
            server.wait(FAST_SHUTDOWN_S)
        except subprocess.TimeoutExpired:
            continue


def on_term(_number: int, _frame: FrameType | None) -> None:
    """Interrupt the wait in `keep` when SIGTERM arrives."""
    raise StopRequested


def main(arguments: list[str]) -> None:
    """Start PostgreSQL, wait, and shut it down."""
    owner, uid, gid, folder, *command = arguments
    place = Path(folder)
    signal.signal(signal.SIGTERM, on_term)
    with (place / "postgres.log").open("ab") as log:
        server = subprocess.Popen(
            command,
            cwd=place,
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
            user=int(uid),
            group=int(gid),
            extra_groups=[] if os.geteuid() == 0 else None,
            start_new_session=True,
        )
    run = psutil.Process(int(owner))
    try:
        keep(run, server)
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        shut_down(server)
        (place / "stopped").touch()
        if not alive(run):
            # If it was killed, its shared memory is ours to remove.
            shutil.rmtree(place.parent, ignore_errors=True)


if __name__ == "__main__":
    main(sys.argv[1:])
