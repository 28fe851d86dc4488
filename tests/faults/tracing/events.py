"""The events of a trace: one per system call, with the bytes written or sent."""

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import BinaryIO

NEVER = 2**62
"""`ended` of a call that had not returned when the process ended."""


@dataclass(frozen=True)
class Event:
    """A system call. Stamps count all stops, so they order events of different threads.

    `what`: write, truncate, sync, create, unlink, rename, send, or other (a way to change a file
    that is not decoded). `path`: the file, or `socket:[NUMBER]`, which names a connection. `began`,
    `ended` and the times (ns, monotonic) are those of the call's entry and return: before the entry
    none of it has happened, after the return all of it has. `data`: what was written or sent, as
    much as the kernel accepted. `size`: that of a truncated file.
    """

    what: str
    call: str
    path: str
    began: int
    ended: int
    began_ns: int
    ended_ns: int
    offset: int = 0
    size: int = 0
    result: int = 0
    to_path: str = ""
    data: bytes = field(default=b"", repr=False)

    @property
    def failed(self) -> bool:
        """Return whether the kernel returned an error."""
        return self.result < 0


def write_event(file: BinaryIO, event: Event) -> None:
    """Append an event: a line of JSON, then its bytes."""
    fields = asdict(replace(event, data=b""))
    fields["data"] = len(event.data)
    file.write(json.dumps(fields).encode() + b"\n" + event.data)


def read_events(path: Path) -> list[Event]:
    """Return the events of a trace in the order in which they began."""
    with path.open("rb") as file:
        return sorted(_events(file), key=lambda event: event.began)


def _events(file: BinaryIO) -> Iterator[Event]:
    while line := file.readline():
        fields = json.loads(line)
        yield Event(**{**fields, "data": file.read(fields["data"])})
