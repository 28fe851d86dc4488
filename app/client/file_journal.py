"""A journal in files: unacknowledged messages survive the process, and need not be in memory.

    journal = FileJournal(folder=Path("journal") / session_id)

Messages are appended to segments of a few megabytes; a segment is deleted once all of it is
acknowledged. A process that opens the folder again finds the remaining messages, under their
original epoch, and `TelemetryClient` sends them before anything new. The last record may be
truncated if the process ended while writing it: it had not been accepted yet, and is skipped.

A record survives the death of the process as soon as `add` returns, but a power failure only once
the operating system has written it, some seconds later; `sync=True` waits for that at every
message.
"""

import os
import struct
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

from app.client.journal import Entry, Journal

SEGMENT_BYTES = 8 * 1024 * 1024
MEMORY_BYTES = 16 * 1024 * 1024
SUFFIX = ".journal"
_HEAD = struct.Struct("<II")
"""The head of a record: its length and CRC-32."""
_FIELDS = struct.Struct("<BBIQ")
"""Fields: 1 for bytes, 2 for text; length of the stream's name; epoch; seq_end; then the data."""
_BYTES, _TEXT = 1, 2


@dataclass(frozen=True)
class Filed(Entry):
    """An entry whose message is stored only in its segment."""

    path: Path
    offset: int
    length: int

    @property
    def size_bytes(self) -> int:
        """The message's length in its file."""
        return self.length


@dataclass
class FileJournal(Journal):
    """A `Journal` in files, of which up to `memory_bytes` are also kept in memory."""

    folder: Path = field(kw_only=True)
    segment_bytes: int = SEGMENT_BYTES
    memory_bytes: int = MEMORY_BYTES
    sync: bool = False
    _file: BinaryIO | None = None
    _segment: int = 0
    _last_places: dict[Path, int] = field(default_factory=dict)
    _at_hand: dict[int, int] = field(default_factory=dict)
    _at_hand_bytes: int = 0

    def __post_init__(self) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        for path in sorted(self.folder.glob(f"*{SUFFIX}")):
            self._segment = int(path.stem)
            for entry in _read(path):
                self._last_places[path] = self.end
                super().add(entry)
            if path not in self._last_places:
                path.unlink()

    def add(self, entry: Entry) -> None:
        """Write a message to its file and keep it until it is acknowledged."""
        path, offset, length = self._write(entry)
        self._last_places[path] = self.end
        if self._at_hand_bytes + length > self.memory_bytes:
            entry = Filed(entry.stream, entry.epoch, entry.seq_end, b"", path, offset, length)
        else:
            self._at_hand[self.end] = length
            self._at_hand_bytes += length
        super().add(entry)

    def at(self, place: int) -> Entry | None:
        """Return the message at a place, read from its file if it is not in memory."""
        entry = self._entries.get(place)
        return _loaded(entry) if isinstance(entry, Filed) else entry

    def acknowledge(self, positions: Iterable[tuple[str, int, int]]) -> None:
        """Remove the messages that are stored on the server, and delete empty segments."""
        first = self.first
        super().acknowledge(positions)
        for place in range(first, self.first):
            self._at_hand_bytes -= self._at_hand.pop(place, 0)
        if self.first != first:
            for path in [path for path, last in self._last_places.items() if last < self.first]:
                del self._last_places[path]
                self._close(path)
                path.unlink(missing_ok=True)

    def close(self) -> None:
        """Close the file; its messages are read again when the journal is reopened."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def _write(self, entry: Entry) -> tuple[Path, int, int]:
        """Append a record; return its file, and the offset and length of its message."""
        if self._file is None or self._file.tell() >= self.segment_bytes:
            self.close()
            self._segment += 1
            self._file = (self.folder / f"{self._segment:08d}{SUFFIX}").open("xb", buffering=0)
        text = isinstance(entry.message, str)
        message = entry.message.encode() if isinstance(entry.message, str) else entry.message
        name = str(entry.stream).encode()
        fields = _FIELDS.pack(_TEXT if text else _BYTES, len(name), entry.epoch, entry.seq_end)
        record = fields + name + message
        begin = self._file.tell()
        self._append(self._file, _HEAD.pack(len(record), zlib.crc32(record)) + record)
        offset = begin + _HEAD.size + len(fields) + len(name)
        return Path(self._file.name), offset, len(message)

    def _append(self, file: BinaryIO, record: bytes) -> None:
        """Write a complete record or nothing: records after a truncated one could not be read."""
        begin = file.tell()
        try:
            if file.write(record) < len(record):
                raise OSError(f"no space left for the journal in {self.folder}")
            if self.sync:
                os.fsync(file.fileno())
        except OSError:
            file.truncate(begin)
            file.seek(begin)
            raise

    def _close(self, path: Path) -> None:
        if self._file is not None and Path(self._file.name) == path:
            self.close()


def _read(path: Path) -> Iterator[Filed]:
    """Yield the complete records of a segment, up to the first truncated one."""
    with path.open("rb") as file:
        while len(head := file.read(_HEAD.size)) == _HEAD.size:
            length, crc = _HEAD.unpack(head)
            begin = file.tell()
            record = file.read(length)
            if len(record) < length or zlib.crc32(record) != crc:
                return
            _, name_length, epoch, seq_end = _FIELDS.unpack_from(record)
            name = record[_FIELDS.size : _FIELDS.size + name_length].decode()
            skipped = _FIELDS.size + name_length
            yield Filed(name, epoch, seq_end, b"", path, begin + skipped, length - skipped)


def _loaded(entry: Filed) -> Entry:
    kind_at = entry.offset - len(entry.stream.encode()) - _FIELDS.size
    with entry.path.open("rb") as file:
        file.seek(kind_at)
        text = file.read(1)[0] == _TEXT
        file.seek(entry.offset)
        message = file.read(entry.length)
    return Entry(entry.stream, entry.epoch, entry.seq_end, message.decode() if text else message)
