"""One rehearsal, in a process of its own that talks to this server as devices do.

It reads its plan from its input, token included, so nobody finds that among the machine's running
commands; it ends when the input is closed, so it cannot outlive the server.
"""

import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

NICENESS = 5
"""Running sessions go first where both want the processor."""
ENDS_WITHIN_S = 6.0
COMMAND = (sys.executable, "-m", "app.rehearsal")
News = Callable[[Mapping[str, Any]], None]


@dataclass(eq=False)
class Performance:
    """The process. `heard` is told each line, `ended` once, both from a thread of its own."""

    plan: Mapping[str, Any]
    heard: News
    ended: Callable[[], None]
    command: tuple[str, ...] = COMMAND
    _process: "subprocess.Popen[str] | None" = None
    _listener: threading.Thread | None = None

    def start(self) -> None:
        """Begin; raises OSError where no process can be started."""
        self._process = subprocess.Popen(  # noqa: S603 - our own command
            self.command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=_environment(),
            text=True,
            start_new_session=True,
        )
        self._listener = threading.Thread(target=self._listen, name="tryout", daemon=True)
        self._listener.start()

    def stop(self) -> None:
        """Ask it to end its session and itself; without asking where it takes too long."""
        process = self._process
        if process is None:
            return
        process.terminate()
        try:
            process.wait(ENDS_WITHIN_S)
        except subprocess.TimeoutExpired:
            process.kill()

    def kill(self) -> None:
        """End it at once, and wait until everything is told."""
        if self._process is not None:
            self._process.kill()
        if self._listener is not None:
            self._listener.join(ENDS_WITHIN_S)

    def _listen(self) -> None:
        process = self._process
        assert process is not None  # noqa: S101 - started
        assert process.stdin is not None and process.stdout is not None  # noqa: S101, PT018
        try:
            process.stdin.write(json.dumps(dict(self.plan)) + "\n")
            process.stdin.flush()
            for line in process.stdout:
                self.heard(json.loads(line))
        except (OSError, ValueError):
            # It broke off in the middle of a line: the end says the rest.
            pass
        finally:
            self.stop()
            for pipe in (process.stdin, process.stdout):
                try:
                    pipe.close()
                except OSError:
                    continue
            self.ended()


def _environment() -> dict[str, str]:
    """What a process needs to run at all; none of the installation's settings or secrets."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("REEMBODY_")}
    return {**kept, "PYTHONUNBUFFERED": "1", "OMP_NUM_THREADS": "1"}
