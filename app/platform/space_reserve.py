"""Reserve disk space in a file that is deleted when the disk is full.

To erase data, to end a session or to record that an export was fetched, something has to be written
first. Without this file none of that would be possible on a full disk. While the reserve is
released, nothing else is written, or telemetry would use up the space within a second.
"""

import contextlib
import os
import shutil
from dataclasses import dataclass
from pathlib import Path

NAME = "reserve"
MOST_BYTES = 32 * 1024 * 1024
LARGEST_SHARE = 8
"""The reserve takes at most one part in this many of the free bytes."""
FEWEST_BYTES = 1024 * 1024


@dataclass(eq=False)
class SpaceReserve:
    """The reserve's file in `folder`, which is None where the database is on another machine."""

    folder: Path | None
    is_released: bool = False
    _bytes: int = MOST_BYTES

    def create(self) -> None:
        """Create the file if there is space for it; a disk that is too small has no reserve."""
        if self.folder is None:
            return
        with contextlib.suppress(OSError):
            free = shutil.disk_usage(self.folder).free + self._size()
            self._bytes = min(MOST_BYTES, free // LARGEST_SHARE)
            if self._bytes >= FEWEST_BYTES:
                self._allocate()

    def release(self) -> None:
        """Delete the file; other writers must wait until `restore` succeeds."""
        if self.folder is None or self.is_released or not self._size():
            return
        with contextlib.suppress(OSError):
            (self.folder / NAME).unlink()
            self.is_released = True

    def restore(self) -> bool:
        """Try to restore the file; return whether it exists in full or was never deleted."""
        if not self.is_released:
            return True
        try:
            # Check first: an attempt would fill the disk for a moment and make other writes fail.
            if shutil.disk_usage(self._path().parent).free < self._bytes + FEWEST_BYTES:
                return False
            self._allocate()
        except OSError:
            with contextlib.suppress(OSError):
                self._path().unlink(missing_ok=True)
            return False
        self.is_released = False
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
