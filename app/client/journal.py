"""A journal of sent messages that are not yet acknowledged as being on the server's disk.

Every message goes into the journal first, in order, and leaves it when it is acknowledged. After a
reconnect the remaining messages are resent in the same order. The journal is bounded: when it is
full the producer has to wait (`is_full`); nothing is ever dropped. This one is in memory and lost
with its process; `FileJournal` is not.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

DEFAULT_LIMIT_BYTES = 256 * 1024 * 1024


@dataclass(frozen=True)
class Entry:
    """A message and the end of its range of seqs."""

    stream: str
    epoch: int
    seq_end: int
    message: bytes | str

    @property
    def size_bytes(self) -> int:
        """The number of bytes that count towards the journal's limit."""
        return len(self.message)


@dataclass
class Journal:
    """A bounded list of unacknowledged messages, each at its place: 0, 1, 2, ... since the start.

    An acknowledged message after an unacknowledged one stays until that one leaves, so that
    removing messages takes time proportional to their number only; resending it would do no harm.
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
        """The total size of the messages in the journal."""
        return self._bytes

    def __len__(self) -> int:
        return len(self._entries)

    def __iter__(self) -> Iterator[Entry]:
        entries = (self.at(place) for place in range(self.first, self.end))
        return iter(tuple(entry for entry in entries if entry is not None))

    def at(self, place: int) -> Entry | None:
        """Return the message at a place; None if it was removed or does not exist yet."""
        return self._entries.get(place)

    def stored_up_to(self, stream: str, epoch: int) -> int:
        """Return the first seq that is not known to be stored on the server."""
        return self._stored.get((stream, epoch), 0)

    @property
    def produced(self) -> dict[tuple[str, int], int]:
        """The next seq of the client in every (stream, epoch)."""
        return dict(self._produced)

    def produced_up_to(self, stream: str, epoch: int, next_seq: int) -> None:
        """Record that the client has produced all of `seq < next_seq`, journaled or not."""
        self._produced[stream, epoch] = next_seq

    def add(self, entry: Entry) -> None:
        """Add a message, which stays until it is acknowledged."""
        self._entries[self.end] = entry
        self.produced_up_to(entry.stream, entry.epoch, entry.seq_end)
        self._bytes += entry.size_bytes
        self.end += 1

    def acknowledge(self, positions: Iterable[tuple[str, int, int]]) -> None:
        """Remove messages that are stored on the server.

        A position (stream, epoch, next_seq) means that all of seq < next_seq is stored.
        """
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
