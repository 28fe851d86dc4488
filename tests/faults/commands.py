"""Commands of the product on the installation of a server, as an operator would type them."""

import json
import resource
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tests.support.server import REEMBODY, LiveServer

UNUSABLE = 2


@dataclass(frozen=True)
class Said:
    """How a command ended, what it said, and how long it took."""

    code: int
    out: str
    err: str
    took_s: float

    @property
    def json(self) -> dict[str, Any]:
        """What it printed with `--json`."""
        assert self.code == 0, self.err
        decoded: dict[str, Any] = json.loads(self.out)
        return decoded


def reembody(server: LiveServer, *arguments: object, max_file_bytes: int | None = None) -> Said:
    """Run a command; `max_file_bytes` is the longest file it can write."""
    began_s = time.monotonic()
    ended = subprocess.run(
        [*REEMBODY, *map(str, arguments)],
        env=server._full_environment(),
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=_limit(max_file_bytes),
    )
    return Said(ended.returncode, ended.stdout, ended.stderr, time.monotonic() - began_s)


def _limit(max_file_bytes: int | None) -> Callable[[], None] | None:
    if max_file_bytes is None:
        return None
    limits = (max_file_bytes, max_file_bytes)
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, limits)
