"""What was sent and is not known to be on the server's disk.

Everything goes into the journal first, in order, and leaves it when it is acknowledged. After a
reconnect what is left is sent again, in the same order. The journal is bounded: when it is full the
producer has to wait, which it can see; nothing is ever dropped. This one lives in memory and dies
with its process; `FileJournal` does not.
"""

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

    @property
    def size_bytes(self) -> int:
        """What it counts for against the journal's limit."""
        return len(self.message)


@dataclass
class Journal:
    """Unacknowledged messages, oldest first, each under its place: 0, 1, 2, ... since the start.

    An acknowledged message behind one that is not stays until that one leaves, so that forgetting
    costs no more than what is forgotten; sending it again would do no harm.
    """

    limit_bytes: int = DEFAULT_LIMIT_BYTES
    first: int = 0
    end: int = 0
    _entries: dict[int, Entry] = field(default_factory=dict)
    _stored: dict[tuple[str, int], int] = field(default_factory=dict)
    _produced: dict[tuple[str, int], int] = field(default_factory=dict)
    _bytes: int = 0

    @property
    def is_full(self) -> bool:
        """Whether the producer must wait."""
        return self._bytes >= self.limit_bytes

    @property
    def waiting_bytes(self) -> int:
        """How much is kept."""
        return self._bytes

    def __len__(self) -> int:
        return len(self._entries)

    def __iter__(self) -> Iterator[Entry]:
        entries = (self.at(place) for place in range(self.first, self.end))
        return iter(tuple(entry for entry in entries if entry is not None))

    def at(self, place: int) -> Entry | None:
        """The message at a place, None if it has left or has not come."""
        return self._entries.get(place)

    def stored_up_to(self, stream: str, epoch: int) -> int:
        """The first seq that is not known to be stored."""
        return self._stored.get((stream, epoch), 0)

    @property
    def produced(self) -> dict[tuple[str, int], int]:
        """How far the client itself has come: the next seq of every (stream, epoch)."""
        return dict(self._produced)

    def produced_up_to(self, stream: str, epoch: int, next_seq: int) -> None:
        """The client has made all of `seq < next_seq`, whether or not it is journaled yet."""
        self._produced[stream, epoch] = next_seq

    def add(self, entry: Entry) -> None:
        """Keep a message until it is acknowledged."""
        self._entries[self.end] = entry
        self.produced_up_to(entry.stream, entry.epoch, entry.seq_end)
        self._bytes += entry.size_bytes
        self.end += 1

    def acknowledge(self, positions: Iterable[tuple[str, int, int]]) -> None:
        """Forget what is stored: (stream, epoch, next_seq) says that all seq < next_seq is."""
        for stream, epoch, next_seq in positions:
            key = (stream, epoch)
            self._stored[key] = max(next_seq, self.stored_up_to(stream, epoch))
        while self._entries:
            entry = self._entries[self.first]
            if entry.seq_end > self.stored_up_to(entry.stream, entry.epoch):
                break
            del self._entries[self.first]
            self._bytes -= entry.size_bytes
            self.first += 1
