"""Provide one folder for everything that the processes of one test run share.

pytest-xdist spreads a run over worker processes that start and end independently. The process that
was started first (the controller, or the only process) creates the folder, passes it to the workers
in an environment variable, and removes it at the end.
"""

import fcntl
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

FOLDER_VARIABLE = "REEMBODY_TEST_RUN"
OWNER_VARIABLE = "REEMBODY_TEST_RUN_OWNER"


def open_run() -> None:
    """Create the run's folder; call this in the controller before workers start."""
    # Not the temporary folder of the environment: the path of a unix socket ends after 107 bytes,
    # and PostgreSQL, run as `nobody` where the tests run as root, must be able to reach it.
    short = Path("/tmp")  # noqa: S108  # mkdtemp makes the name unguessable
    parent = short if os.access(short, os.W_OK) else Path(tempfile.gettempdir())
    folder = Path(tempfile.mkdtemp(prefix="reembody-", dir=parent))
    folder.chmod(0o711)
    os.environ[FOLDER_VARIABLE] = str(folder)
    os.environ[OWNER_VARIABLE] = str(os.getpid())


def run_folder() -> Path:
    """Return the folder of this run."""
    return Path(os.environ[FOLDER_VARIABLE])


def owner_pid() -> int:
    """Return the id of the process whose end marks the end of the run."""
    return int(os.environ[OWNER_VARIABLE])


def close_run() -> None:
    """Remove the run's folder; call this in the controller when nothing uses it any more."""
    shutil.rmtree(run_folder(), ignore_errors=True)


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Hold `path` as a lock between processes; the lock of a process that ends is released."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


@contextmanager
def once(name: str) -> Iterator[Path | None]:
    """Run a block in only one process of the run: yield the mark to write, or None if already done.

    The caller decides what to write into the mark; the other processes can read it.
    """
    mark = run_folder() / f"{name}.done"
    with locked(run_folder() / f"{name}.lock"):
        yield None if mark.exists() else mark
