"""Write an export as a ZIP file while it is sent, never holding all of it in memory or on disk."""

import io
import zipfile
from collections.abc import Iterable, Iterator
from datetime import datetime

from app.features.results.exports.writing.contents import Member

LEVEL = 1
"""The lowest level: higher ones hardly compress digits better, and the client waits."""
SEND_FROM_BYTES = 256 * 1024


def zip_pieces(members: Iterable[Member], now: datetime) -> Iterator[bytes]:
    """Yield the archive in pieces; one that breaks off has no directory, so no program opens it."""
    sink = _Sink()
    with zipfile.ZipFile(sink, "w") as archive:
        for member in members:
            with archive.open(_Entry(member.path, now), "w", force_zip64=True) as file:
                for piece in member.pieces:
                    file.write(piece)
                    if sink.waiting >= SEND_FROM_BYTES:
                        yield sink.take()
    yield sink.take()


class _Entry(zipfile.ZipInfo):
    """A file in the archive, with its own level: the archive's is only for files without a date."""

    def __init__(self, path: str, now: datetime) -> None:
        super().__init__(path, now.timetuple()[:6])
        self.compress_type = zipfile.ZIP_DEFLATED
        self.external_attr = 0o644 << 16
        self._compresslevel = LEVEL


class _Sink(io.RawIOBase):
    """The file object that the archive is written to; it buffers bytes until they are sent."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self.waiting = 0

    def writable(self) -> bool:
        """Return True; without seeking, sizes are written after each file."""
        return True

    def write(self, data: object) -> int:
        """Buffer the bytes until they are taken."""
        part = bytes(data)  # type: ignore[call-overload]  # any buffer
        self._parts.append(part)
        self.waiting += len(part)
        return len(part)

    def take(self) -> bytes:
        """Return and clear everything in the buffer."""
        taken = b"".join(self._parts)
        self._parts, self.waiting = [], 0
        return taken
