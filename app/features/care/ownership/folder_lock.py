"""The operating system's lock on a folder: held by an open file, released with its process.

The lock is on the file `owner.lock` in the folder, so every path that leads to the folder leads to
the same lock. The file stays, except in a folder that the lock itself created and nobody used. Its
text says who holds the lock, but only the lock itself counts. It is `flock`, which belongs to the
open file. No process that this one starts inherits the file, and a plain fork closes it,
so a worker that outlives its server holds no lock; and closing some other handle, unlike with POSIX
record locks, does not release it.
"""

import errno
import os
import sys
import time
import weakref
from contextlib import suppress
from pathlib import Path

from app.errors import NotDurable
from app.features.care.ownership.owner import Owned, Owner

NAME = "owner.lock"
_TRIES = 20
_SETTLES_S = 0.02
"""Far longer than an owner needs to write its text."""
_HELD = (errno.EACCES, errno.EAGAIN, errno.EDEADLK)


class FolderLock:
    """The lock on a folder, taken on construction.

    Raises Owned, and NotDurable if the folder cannot be written or its file system has no locks.
    """

    def __init__(self, folder: Path, owner: Owner) -> None:
        self.folder = folder.resolve()
        self._file, self._owner = self.folder / NAME, owner
        self._made = [one for one in (self.folder, *self.folder.parents) if not one.exists()]
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self._handle: int | None = self._taken()
        except OSError as error:
            raise NotDurable(
                f"the folder {self.folder} cannot be locked: {error.strerror or error}",
                value=str(self.folder),
                remedy="Check that it may be written here and is on a disk of this machine: some "
                "network file systems have no locks.",
            ) from error
        _HOLDING.add(self)
        self.announce(owner)

    def announce(self, owner: Owner) -> None:
        """Write the owner's description to the lock file; ignore a full disk."""
        self._owner = owner
        text = owner.as_text().encode()
        if self._handle is not None:
            try:
                # Overwrite in place: the block is allocated already, and a full disk has no other.
                os.lseek(self._handle, 0, os.SEEK_SET)
                os.write(self._handle, text)
                os.ftruncate(self._handle, len(text))
            except OSError:
                return

    def is_held(self) -> bool:
        """Return whether the lock is still effective: not if its file was removed or replaced."""
        return self._handle is not None and _is_at(self._handle, self._file)

    def take_again(self) -> None:
        """Lock the file that exists now; raise the same errors as the constructor."""
        before, self._handle = self._handle, self._taken()
        if before is not None:
            os.close(before)
        self.announce(self._owner)

    def release(self) -> None:
        """Release the lock, and remove a folder created for it that has nothing else in it."""
        unused = self._handle is not None and bool(self._made) and self._is_empty()
        with suppress(OSError):
            if unused:
                # Unlink while holding the lock: a process that opened the file will notice.
                self._file.unlink()
        self.forget()
        with suppress(OSError):
            if unused:
                for folder in self._made:
                    folder.rmdir()

    def forget(self) -> None:
        """Close the file; in a fork, the lock stays with the parent process."""
        handle, self._handle = self._handle, None
        _HOLDING.discard(self)
        if handle is not None:
            os.close(handle)

    def _is_empty(self) -> bool:
        """Return whether there is only the lock file in the folder."""
        try:
            return [one.name for one in self.folder.iterdir()] == [NAME]
        except OSError:
            return False

    def _taken(self) -> int:
        for _ in range(_TRIES):
            handle = os.open(self._file, os.O_RDWR | os.O_CREAT, 0o644)
            try:
                _lock(handle)
            except OSError as error:
                os.close(handle)
                if error.errno not in _HELD:
                    raise
                holder = self._holder()
                if holder is None and not self._file.exists():
                    # Its owner has just released it, and removed the file and perhaps the folder.
                    self.folder.mkdir(parents=True, exist_ok=True)
                    continue
                raise Owned(f"the data folder {self.folder}", holder) from None
            if _is_at(handle, self._file):
                return handle
            # The file was replaced in the meantime.
            os.close(handle)
        raise OSError(errno.EAGAIN, "its lock file is replaced again and again")

    def _holder(self) -> Owner | None:
        # A new holder may not have replaced the text of the previous owner yet.
        time.sleep(_SETTLES_S)
        try:
            return Owner.from_text(self._file.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None


_HOLDING: "weakref.WeakSet[FolderLock]" = weakref.WeakSet()


def _forget_all() -> None:
    for lock in list(_HOLDING):
        lock.forget()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_all)


def _is_at(handle: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(handle), path.stat())
    except OSError:
        return False


if sys.platform == "win32":
    import msvcrt

    _FAR = 1 << 30
    """On Windows a locked byte cannot be read, so one far after the text is locked."""

    def _lock(handle: int) -> None:
        os.lseek(handle, _FAR, os.SEEK_SET)
        msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _lock(handle: int) -> None:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
