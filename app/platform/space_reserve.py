"""Room on the disk that is kept for what frees some: a file that is given up when it is full.

To erase, to end a session or to put on record that an export was fetched, something has to be
written first. Without this file none of it could be done on a disk that has no byte left. While it
is given up, nothing else is written, or movement would take that room within a second.
"""

import contextlib
import os
import shutil
from dataclasses import dataclass
from pathlib import Path

NAME = "reserve"
MOST_BYTES = 32 * 1024 * 1024
LARGEST_SHARE = 8
"""At most one in so many of the bytes that are free when it is made."""
FEWEST_BYTES = 1024 * 1024


@dataclass(eq=False)
class SpaceReserve:
    """The file in `folder`; None where the database is on another machine."""

    folder: Path | None
    given_up: bool = False
    _bytes: int = MOST_BYTES

    def keep(self) -> None:
        """Make the file where there is room for it; a disk that is too small goes without."""
        if self.folder is None:
            return
        with contextlib.suppress(OSError):
            free = shutil.disk_usage(self.folder).free + self._size()
            self._bytes = min(MOST_BYTES, free // LARGEST_SHARE)
            if self._bytes >= FEWEST_BYTES:
                self._allocate()

    def give_up(self) -> None:
        """Let go of the room; `take_back` has to succeed before anybody else may have it."""
        if self.folder is None or self.given_up or not self._size():
            return
        with contextlib.suppress(OSError):
            (self.folder / NAME).unlink()
            self.given_up = True

    def take_back(self) -> bool:
        """Whether all of it is there again, or was never gone."""
        if not self.given_up:
            return True
        try:
            # Looked at first: an attempt would fill the disk for a moment, in somebody's way.
            if shutil.disk_usage(self._path().parent).free < self._bytes + FEWEST_BYTES:
                return False
            self._allocate()
        except OSError:
            with contextlib.suppress(OSError):
                self._path().unlink(missing_ok=True)
            return False
        self.given_up = False
        return True

    def _path(self) -> Path:
        assert self.folder is not None  # noqa: S101 - asked for by whoever has one
        return self.folder / NAME

    def _size(self) -> int:
        try:
            return self._path().stat().st_size
        except OSError:
            return 0

    def _allocate(self) -> None:
        handle = os.open(self._path(), os.O_RDWR | os.O_CREAT, 0o600)
        try:
            if hasattr(os, "posix_fallocate"):
                os.posix_fallocate(handle, 0, self._bytes)
                os.ftruncate(handle, self._bytes)
            else:
                os.write(handle, bytes(self._bytes))
        finally:
            os.close(handle)
