"""What was sent and is not known to be on the server's disk.

Everything goes into the journal first, in order, and leaves it when it is acknowledged. After a
reconnect what is left is sent again, in the same order. The journal is bounded: when it is full the
producer has to wait, which it can see; nothing is ever dropped.
"""

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

DEFAULT_LIMIT_BYTES = 256 * 1024 * 1024


@dataclass(frozen=True)
class Entry:
    """A message with the seqs it carries."""

    stream: str
    epoch: int
    seq_end: int
    message: bytes | str


@dataclass
class Journal:
    """Unacknowledged messages, oldest first."""

    limit_bytes: int = DEFAULT_LIMIT_BYTES
    _entries: deque[Entry] = field(default_factory=deque)
    _bytes: int = 0

    @property
    def is_full(self) -> bool:
        """Whether the producer must wait."""
        return self._bytes >= self.limit_bytes

    @property
    def waiting_bytes(self) -> int:
        """How much is not acknowledged yet."""
        return self._bytes

    def __len__(self) -> int:
        return len(self._entries)

    def __iter__(self) -> Iterator[Entry]:
        return iter(tuple(self._entries))

    def add(self, entry: Entry) -> None:
        """Keep a message until it is acknowledged."""
        self._entries.append(entry)
        self._bytes += len(entry.message)

    def acknowledge(self, positions: Iterable[tuple[str, int, int]]) -> None:
        """Forget what is stored: (stream, epoch, next_seq) says that all seq < next_seq is."""
        stored = {(stream, epoch): next_seq for stream, epoch, next_seq in positions}
        kept = deque(
            entry
            for entry in self._entries
            if entry.seq_end > stored.get((entry.stream, entry.epoch), 0)
        )
        self._bytes = sum(len(entry.message) for entry in kept)
        self._entries = kept
