"""Run the real server under the tracer."""

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from tests.faults.tracing.tracer import REFUSED
from tests.support.server import REEMBODY, LiveServer

REPOSITORY = Path(__file__).resolve().parents[3]
RECORD = "trace"


def traced(record: Path, folder: Path, command: Sequence[str]) -> list[str]:
    """Return the command that runs `command` under the tracer.

    It needs the repository as PYTHONPATH.
    """
    tracer = [sys.executable, "-m", "tests.faults.tracing"]
    return [*tracer, str(record), str(folder), "--", *command]


def traced_server(folder: Path, command: Sequence[str] = REEMBODY) -> LiveServer:
    """Return a server whose trace is `folder / RECORD`, complete once it has stopped."""
    return LiveServer(
        folder,
        command=traced(folder / RECORD, folder / "data", command),
        environment={"PYTHONPATH": str(REPOSITORY)},
    )


def why_not(folder: Path) -> str | None:
    """Return why tracing is impossible here, or None; this traces a small command."""
    done = subprocess.run(
        traced(folder / RECORD, folder, ["true"]),
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    if done.returncode not in (0, REFUSED):
        raise RuntimeError(f"the tracer failed:\n{done.stderr}")
    return f"no process can be traced here: {done.stderr.strip()}" if done.returncode else None
