"""The real server, as a process that tests can send requests to, kill and restart.

It runs what an operator runs (`reembody serve`): the tests go through argument parsing, settings,
migrations and the network, and a `kill()` is a real crash. Only the imports are done in advance
(tests/support/nursery.py).
"""

import os
import signal
import socket
import ssl
import subprocess
import sys
import time
import weakref
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import IO, ClassVar, Self

import httpx2

from tests.support.nursery import Child, Wish, nursery
from tests.support.unit_tests import needs

ADMIN_PASSWORD = "only-for-this-test-run"
STARTS_WITHIN_S = 240.0
STOPS_WITHIN_S = 60.0
LOG_CHARACTERS = 4000
# The server closes a connection that was idle for five seconds. If a busy machine lets a
# client send just then, the request fails; so the client closes first.
CONNECTIONS = httpx2.Limits(max_connections=100, max_keepalive_connections=20, keepalive_expiry=1.0)
REEMBODY = (str(Path(sys.executable).with_name("reembody")),)


@cache
def _certificates() -> ssl.SSLContext:
    """Return the system's certificates, read once: reading takes most of a client's lifetime."""
    return ssl.create_default_context()


class LiveServer:
    """A server on a free port of the loopback, with its data in `folder`.

    The port and the data stay the same over `kill()`, `stop()` and `start()`. `environment` adds
    `REEMBODY_*` variables (such as `REEMBODY_DATABASE_URL`); the caller's own are not passed on.
    """

    _running: ClassVar["weakref.WeakSet[LiveServer]"] = weakref.WeakSet()

    def __init__(
        self,
        folder: Path,
        *,
        environment: Mapping[str, str] | None = None,
        arguments: Sequence[str] = (),
        command: Sequence[str] = REEMBODY,
    ) -> None:
        self.data_dir = folder / "data"
        self.port = free_port()
        self._log_file = folder / "server.log"
        self._command = [*command, "serve", "--port", str(self.port), *arguments]
        self._lifeline: IO[bytes] | None = None
        self._as_installed = tuple(command) == REEMBODY
        self._environment = dict(environment or {})
        self._process: subprocess.Popen[bytes] | Child | None = None

    @property
    def url(self) -> str:
        """Return `http://localhost:PORT`, a name that browsers treat as secure."""
        return f"http://localhost:{self.port}"

    @property
    def pid(self) -> int:
        """Return the process id of the running server."""
        if self._process is None:
            raise RuntimeError("the server is not running: call start() first")
        return self._process.pid

    @property
    def log(self) -> str:
        """Return everything the server wrote to standard output and error, over all its starts."""
        return self._log_file.read_text(errors="replace") if self._log_file.exists() else ""

    @classmethod
    def logs_of_running(cls) -> str:
        """Return the ends of the logs of all servers that run, for the message of a failed test."""
        return "\n".join(f"{one.url}:\n{one.log[-LOG_CHARACTERS:]}" for one in cls._running)

    def start(self) -> Self:
        """Start the server and wait until it responds; raise `RuntimeError` with its log if not."""
        if self._process is not None:
            raise RuntimeError(f"the server already runs as process {self._process.pid}")
        needs("a server")
        self.data_dir.mkdir(parents=True, exist_ok=True)
        self._process = self._begin()
        self._running.add(self)
        try:
            self._wait_until_it_answers(self._process)
        except BaseException:
            self.kill()
            raise
        return self

    def _begin(self) -> "subprocess.Popen[bytes] | Child":
        environment = self._full_environment()
        folder = self.data_dir.parent
        if self._as_installed:
            wish = Wish(self._command[len(REEMBODY) :], environment, folder, self._log_file)
            return nursery().start(wish)
        with self._log_file.open("ab") as log:
            process = subprocess.Popen(
                [*self._command, "--until-input-ends"],
                env=environment,
                cwd=folder,
                stdin=subprocess.PIPE,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        self._lifeline = process.stdin
        return process

    def stop(self) -> None:
        """Terminate the server as a service manager does; kill it if it does not end."""
        self._end(signal.SIGTERM)

    def kill(self) -> None:
        """Send SIGKILL: the server has no chance to clean up."""
        self._end(signal.SIGKILL)

    def restart(self) -> Self:
        """Restart the server on the same port and data."""
        self.stop()
        return self.start()

    def client(self) -> httpx2.Client:
        """Return a client of this server, not signed in; close it, or use it with `with`."""
        return httpx2.Client(
            base_url=self.url, timeout=30.0, verify=_certificates(), limits=CONNECTIONS
        )

    def __enter__(self) -> Self:
        return self.start()

    def __exit__(self, *_error: object) -> None:
        self.stop()

    def _full_environment(self) -> dict[str, str]:
        inherited = {
            name: value for name, value in os.environ.items() if not name.startswith("REEMBODY_")
        }
        return {
            **inherited,
            "PYTHONUNBUFFERED": "1",
            "REEMBODY_DATA_DIR": str(self.data_dir),
            "REEMBODY_ADMIN_PASSWORD": ADMIN_PASSWORD,
            **self._environment,
        }

    def _wait_until_it_answers(self, process: "subprocess.Popen[bytes] | Child") -> None:
        deadline = time.monotonic() + STARTS_WITHIN_S
        with self.client() as client:
            while time.monotonic() < deadline:
                if process.poll() is not None:
                    raise RuntimeError(
                        f"{' '.join(self._command)} ended with exit code {process.returncode}; "
                        f"its log:\n{self.log[-LOG_CHARACTERS:]}"
                    )
                try:
                    if client.get("/api/health").is_success:
                        return
                except httpx2.TransportError:
                    pass
                time.sleep(0.05)
        raise RuntimeError(
            f"{self.url}/api/health did not answer within {STARTS_WITHIN_S:g} s; "
            f"its log:\n{self.log[-LOG_CHARACTERS:]}"
        )

    def _end(self, request: signal.Signals) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        self._running.discard(self)
        process.send_signal(request)
        try:
            process.wait(STOPS_WITHIN_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if self._lifeline is not None:
            self._lifeline.close()
            self._lifeline = None


def free_port() -> int:
    """Return a port of the loopback that is not in use and was not returned before."""
    while True:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port: int = probe.getsockname()[1]
        if port not in _GIVEN:
            _GIVEN.add(port)
            return port


# The system may offer a port again as soon as it is closed: a server that opens two needs two.
_GIVEN: set[int] = set()
