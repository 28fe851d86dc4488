"""Run the product's commands on a server's installation, as an operator would type them."""

import json
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.support.nursery import Wish, nursery
from tests.support.server import LiveServer

UNUSABLE = 2


@dataclass(frozen=True)
class CommandResult:
    """The result of a command: exit code, output, error output and duration."""

    code: int
    out: str
    err: str
    took_s: float

    @property
    def json(self) -> dict[str, Any]:
        """Return the decoded output of a command that was run with `--json`."""
        assert self.code == 0, self.err
        decoded: dict[str, Any] = json.loads(self.out)
        return decoded


def reembody(
    server: LiveServer, *arguments: object, max_file_bytes: int | None = None
) -> CommandResult:
    """Run a command in the server's environment; `max_file_bytes` limits the files it can write."""
    return command(server._full_environment(), *arguments, max_file_bytes=max_file_bytes)


def command(
    environment: Mapping[str, str], *arguments: object, max_file_bytes: int | None = None
) -> CommandResult:
    """Run a command in the given environment; `max_file_bytes` limits the files it can write."""
    with tempfile.TemporaryDirectory() as folder:
        out, err = Path(folder) / "out", Path(folder) / "err"
        wish = Wish(
            list(map(str, arguments)),
            dict(environment),
            Path(folder),
            out,
            errors=err,
            max_file_bytes=max_file_bytes,
        )
        began_s = time.monotonic()
        code = nursery().start(wish).wait()
        took_s = time.monotonic() - began_s
        return CommandResult(code, out.read_text(), err.read_text(), took_s)
