"""An export as one ZIP file, sent while it is made: neither disk nor memory holds the whole."""

import io
import zipfile
from collections.abc import Iterable, Iterator
from datetime import datetime

from app.features.results.exports.writing.contents import Member

LEVEL = 1
"""Digits hardly compress better with more effort, and the reader waits."""
SEND_FROM_BYTES = 256 * 1024


def zip_pieces(members: Iterable[Member], now: datetime) -> Iterator[bytes]:
    """The archive in pieces; one that breaks off has no directory, so no reader takes it."""
    sink = _Sink()
    with zipfile.ZipFile(sink, "w", zipfile.ZIP_DEFLATED, compresslevel=LEVEL) as archive:
        for member in members:
            entry = zipfile.ZipInfo(member.path, now.timetuple()[:6])
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            with archive.open(entry, "w", force_zip64=True) as file:
                for piece in member.pieces:
                    file.write(piece)
                    if sink.waiting >= SEND_FROM_BYTES:
                        yield sink.take()
    yield sink.take()


class _Sink(io.RawIOBase):
    """Where the archive is written: what is in it is sent and forgotten."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self.waiting = 0

    def writable(self) -> bool:
        """It can be written to, but not searched: sizes stand behind each file."""
        return True

    def write(self, data: object) -> int:
        """Keep the bytes until they are taken."""
        part = bytes(data)  # type: ignore[call-overload]  # any buffer
        self._parts.append(part)
        self.waiting += len(part)
        return len(part)

    def take(self) -> bytes:
        """Everything written since the last time."""
        taken = b"".join(self._parts)
        self._parts, self.waiting = [], 0
        return taken
