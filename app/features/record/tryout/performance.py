"""Run a rehearsal in a separate process, which talks to this server as devices do.

The process reads its plan, including the token, from its standard input, so that the token does not
appear in the machine's process list. It ends when its input is closed, so it cannot outlive the
server.
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
"""The process has a lower priority than running sessions."""
ENDS_WITHIN_S = 6.0
COMMAND = (sys.executable, "-m", "app.rehearsal")
News = Callable[[Mapping[str, Any]], None]


@dataclass(eq=False)
class Performance:
    """The process of a rehearsal.

    A thread calls `heard` with every line of its output, and `ended` once at the end.
    """

    plan: Mapping[str, Any]
    heard: News
    ended: Callable[[], None]
    command: tuple[str, ...] = COMMAND
    _process: "subprocess.Popen[str] | None" = None
    _listener: threading.Thread | None = None

    def start(self) -> None:
        """Start the process; raises OSError if that is impossible."""
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
        """Ask the process to end its session and itself; kill it if that takes too long."""
        process = self._process
        if process is None:
            return
        process.terminate()
        try:
            process.wait(ENDS_WITHIN_S)
        except subprocess.TimeoutExpired:
            process.kill()

    def kill(self) -> None:
        """Kill the process immediately, and wait until its output has been processed."""
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
            # The process ended in the middle of a line; `ended` reports that.
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
    """Return the process's environment, without the installation's settings and secrets."""
    inherited = {
        name: value for name, value in os.environ.items() if not name.startswith("REEMBODY_")
    }
    return {**inherited, "PYTHONUNBUFFERED": "1", "OMP_NUM_THREADS": "1"}
