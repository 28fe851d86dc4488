"""Start `reembody` commands by forking a process that has already imported them.

A run starts hundreds of servers, and each first imports the same modules, which takes longer than
everything that follows: about a second. So each test process has a nursery, a process with one
thread that has imported the command and does nothing else. On request it forks: the child has its
own process group, environment, folder and output, runs the command from its arguments on as the
installed script does, and can be killed like any other process.

    test process --(a socket, one message per request)--> nursery --(fork)--> `reembody serve ...`

Whether the script itself starts is tested by tests/lan and tests/architecture, which run it.
"""

import ctypes
import json
import os
import resource
import select
import signal
import socket
import subprocess
import sys
import tempfile
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any

from tests.support.forked_workers import leave_fork_server, listener, use_fork_server

MOST_BYTES = 64 * 1024
PARENT_DEATH_SIGNAL = 1
"""PR_SET_PDEATHSIG of linux/prctl.h."""
CHEAP_PASSWORDS = "TESTS_HAVE_CHEAP_PASSWORDS"
"""The variable that makes servers hash passwords at little cost."""
STUDIES = "TESTS_SHIP_STUDIES_FROM"
"""The variable with the folder of studies for new databases, instead of the product's own."""
EAGER = (
    "app.cli.commands",
    "app.cli.serve.run",
    "sqlalchemy.dialects.sqlite",
    "psycopg",
    "uvicorn.lifespan.on",
    "uvicorn.protocols.http.httptools_impl",
    "uvicorn.protocols.websockets.websockets_sansio_impl",
)
"""The modules that a server has imported by the time it listens."""


class Child:
    """A child process of the nursery, with the interface of `subprocess.Popen`."""

    def __init__(self, nursery: "Nursery", pid: int) -> None:
        self.pid = pid
        self._nursery = nursery
        self._handle = os.pidfd_open(pid)
        self._code: int | None = None

    @property
    def returncode(self) -> int | None:
        """Return the exit code, negative for a signal; None while it runs."""
        return self.poll()

    def poll(self) -> int | None:
        """Return the exit code, or None while it runs."""
        if self._code is None and select.select([self._handle], [], [], 0)[0]:
            self._ended()
        return self._code

    def wait(self, timeout: float | None = None) -> int:
        """Wait for the process to end; raises subprocess.TimeoutExpired."""
        if self._code is None:
            if not select.select([self._handle], [], [], timeout)[0]:
                raise subprocess.TimeoutExpired("reembody", timeout or 0.0)
            self._ended()
        assert self._code is not None  # `_ended` has set it
        return self._code

    def send_signal(self, request: int) -> None:
        """Send a signal, unless the process has ended."""
        if self.poll() is None:
            os.kill(self.pid, request)

    def kill(self) -> None:
        """Send SIGKILL."""
        self.send_signal(signal.SIGKILL)

    def _ended(self) -> None:
        self._code = int(self._nursery.ask({"reap": self.pid})["code"])
        os.close(self._handle)


@dataclass(frozen=True)
class Wish:
    """A command to run, with the environment, folder and output of its process."""

    arguments: Sequence[str]
    environment: dict[str, str]
    folder: Path
    output: Path
    errors: Path | None = None
    """The file for standard error; None: `output`."""
    max_file_bytes: int | None = None
    """The size limit of files that it writes; None: no limit."""


class Nursery:
    """The test process's connection to the prepared process."""

    def __init__(self) -> None:
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs, listener() as workers:
            self.workers: bytes = workers.getsockname()
            descriptors = [theirs.fileno(), workers.fileno()]
            self._process = subprocess.Popen(
                [sys.executable, "-m", "tests.support.nursery", *map(str, descriptors)],
                pass_fds=descriptors,
                stdin=subprocess.DEVNULL,
                env={**_plain_environment(), "PYTHONUNBUFFERED": "1"},
                cwd=Path(__file__).resolve().parents[2],
            )
        self._socket = ours
        self._one_question = threading.Lock()

    def start(self, wish: Wish) -> Child:
        """Start a command in a child process of the nursery and return that process."""
        started = self.ask(
            {
                "arguments": list(wish.arguments),
                "environment": wish.environment,
                "folder": str(wish.folder),
                "output": str(wish.output),
                "errors": str(wish.errors or wish.output),
                "max_file_bytes": wish.max_file_bytes,
            }
        )
        return Child(self, int(started["pid"]))

    def ask(self, request: dict[str, Any]) -> dict[str, Any]:
        """Send one request and return its response."""
        with self._one_question:
            self._socket.sendall(json.dumps(request).encode())
            answered = self._socket.recv(MOST_BYTES)
        if not answered:
            raise RuntimeError(f"the nursery ended with exit code {self._process.wait()}")
        answer: dict[str, Any] = json.loads(answered)
        return answer


def nursery() -> Nursery:
    """Return the nursery of this process; the nursery ends with this process."""
    with _BEGINNING:
        return _nursery()


_BEGINNING = threading.Lock()


@cache
def _nursery() -> Nursery:
    return Nursery()


def _plain_environment() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if not name.startswith("REEMBODY_")}


def serve_wishes(wishes: socket.socket) -> dict[str, Any] | None:
    """Answer requests until the connection closes (return None); in a child, return its request."""
    while asked := wishes.recv(MOST_BYTES):
        request = json.loads(asked)
        if "reap" in request:
            _, status = os.waitpid(request["reap"], 0)
            answer = {"code": os.waitstatus_to_exitcode(status)}
        else:
            pid = os.fork()
            if pid == 0:
                wishes.close()
                child: dict[str, Any] = request
                return child
            answer = {"pid": pid}
        wishes.sendall(json.dumps(answer).encode())
    return None


def become(request: dict[str, Any]) -> None:
    """Give this process its own group, folder, environment and output."""
    # The nursery ends with the test process in any case, and no server may outlive it.
    ctypes.CDLL(None).prctl(PARENT_DEATH_SIGNAL, signal.SIGKILL)
    os.setsid()
    os.chdir(request["folder"])
    os.environ.clear()
    os.environ.update(request["environment"])
    for standard, name in ((1, "output"), (2, "errors")):
        file = os.open(request[name], os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)
        os.dup2(file, standard)
        os.close(file)
    if request["max_file_bytes"] is not None:
        limits = (request["max_file_bytes"], request["max_file_bytes"])
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    script = str(Path(sys.executable).with_name("reembody"))
    sys.argv = [script, *request["arguments"]]
    # Settings that its child processes will need.
    main_module = sys.modules["__main__"]
    main_module.__spec__, main_module.__file__ = None, script


def main() -> None:
    """Import the product, then answer requests; a child leaves the loop and runs its command."""
    for name in EAGER:
        __import__(name)
    if STUDIES in os.environ:
        ship_studies_from(Path(os.environ[STUDIES]))
    _read_shipped_files()
    _build_routes()
    _make_a_database()
    if os.environ.get(CHEAP_PASSWORDS):
        make_passwords_cheap()
    wishes, workers = (socket.socket(fileno=int(argument)) for argument in sys.argv[1:])
    use_fork_server(partial(bytes, workers.getsockname()))
    leave_fork_server(workers, wishes.fileno())
    request = serve_wishes(wishes)
    if request is not None:
        become(request)
        from app.cli import main as reembody

        reembody()


def make_passwords_cheap() -> None:
    """Hash passwords at the lowest cost in this process from now on."""
    from argon2 import PasswordHasher

    from app.features.people.accounts import passwords

    passwords._HASHER = PasswordHasher(time_cost=1, memory_cost=64, parallelism=1)


def ship_studies_from(folder: Path) -> None:
    """Provide new databases of this process with the studies of `folder` from now on."""
    from app.features.design.studies import service

    instruments = service.shipped_files().instruments
    files = service.ShippedFiles(tuple(sorted(folder.glob("*.yaml"))), instruments)
    service.shipped_files = lambda: files


def _read_shipped_files() -> None:
    """Read the shipped files once, since every new database gets them; they are cached by text."""
    from app.features.design.studies import service
    from app.protocol.loading import load_instrument, study_source

    shipped = service.shipped_files()
    for path in shipped.instruments:
        load_instrument(path.read_text(encoding="utf-8"))
    for path in shipped.studies:
        study_source(path.read_text(encoding="utf-8"))


def _build_routes() -> None:
    """Let FastAPI build its routes once, which takes a quarter of a second on first use."""
    from fastapi import FastAPI

    from app.api.router import add_routes

    app = FastAPI()
    add_routes(app)
    for route in app.routes:
        route.matches({"type": "http", "method": "GET", "path": "/", "headers": []})


def _make_a_database() -> None:
    """Create an empty database once, so that its migrations are loaded in this process."""
    from app.schema_revisions import make_file

    with tempfile.TemporaryDirectory() as folder:
        make_file(Path(folder) / "empty.sqlite")


if __name__ == "__main__":
    main()
