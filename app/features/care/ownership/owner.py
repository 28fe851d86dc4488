"""The owner of an installation's data, as text that another process can read and print."""

import json
import os
import socket
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Self

from app.errors import Conflict

SERVER = "serve"
"""The command of a server, which runs until it is stopped; other commands end by themselves."""
_PID_NAMESPACE = Path("/proc/self/ns/pid")


@dataclass(frozen=True)
class Owner:
    """A process that owns data.

    Attributes:
        pid: Its id, as it sees itself; in a container that differs from the id outside.
        port: Where a server is reached on this machine; None for a command.
        host: The name of its machine.
        since: When it took the data, ISO 8601 in UTC.
        command: The command, as typed after `reembody`.
        namespace: The namespace of its process id; empty if unknown.
    """

    pid: int
    port: int | None
    host: str
    since: str
    command: str
    namespace: str = ""

    @classmethod
    def myself(cls, command: str, port: int | None = None) -> Self:
        """Return a description of this process as an owner, starting now."""
        now = datetime.now(UTC).isoformat(timespec="seconds")
        return cls(os.getpid(), port, socket.gethostname(), now, command, _namespace())

    def at(self, port: int) -> "Owner":
        """Return a copy of the owner with another port."""
        return replace(self, port=port)

    def as_text(self) -> str:
        """Return the owner as the JSON text of the lock file."""
        return json.dumps(asdict(self), indent=2) + "\n"

    @classmethod
    def from_text(cls, text: str) -> Self | None:
        """Parse an owner from the text of a lock file; return None for any other text."""
        try:
            return cls(**json.loads(text))
        except (ValueError, TypeError):
            return None

    @property
    def ends_by_itself(self) -> bool:
        """Return whether to wait for this owner: a command, or a server that has just ended."""
        return self.command != SERVER or self._is_dead()

    def __str__(self) -> str:
        """Describe the owner for a message: process id, port, machine and start time."""
        what = "server" if self.command == SERVER else f"command `{self.command}`"
        port = "" if self.port is None else f" on port {self.port}"
        where = "" if self._is_here else " of another container or machine"
        return (
            f"the {what} with the process id {self.pid}{port}{where} "
            f"(machine {self.host}, since {self.since})"
        )

    @property
    def _is_here(self) -> bool:
        return self.host == socket.gethostname() and self.namespace in ("", _namespace())

    def _is_dead(self) -> bool:
        if not self._is_here:
            return False
        try:
            os.kill(self.pid, 0)
        except ProcessLookupError:
            return True
        except OSError:
            return False
        return False


class Owned(Conflict):
    """The data have another owner; `owner` is None if it could not be identified."""

    code = "owned"

    def __init__(self, what: str, owner: Owner | None) -> None:
        who = "another process of Reembody" if owner is None else str(owner)
        super().__init__(
            f"{what} is in use by {who}; nothing was changed",
            value=None if owner is None else owner.pid,
            remedy="Stop it first, or use other data: set REEMBODY_DATA_DIR and, for "
            "PostgreSQL, REEMBODY_DATABASE_URL.",
        )
        self.owner = owner


def _namespace() -> str:
    try:
        return str(_PID_NAMESPACE.readlink())
    except OSError:
        return ""
