"""Write files that people name: completely, or not at all.

The new content is first written beside the file, and then takes its place. So a full disk or a
crash leaves what was there before, and nobody reads half a file.
"""

import errno
import os
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

Content = str | bytes | Callable[[IO[bytes]], object]
"""A text, written as UTF-8; bytes; or a function that writes to the open file it is given."""
_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
_NO_PERMISSION = {errno.EACCES, errno.EPERM, errno.EROFS}


class NotWritten(OSError):
    """A file was not written; the message names it, the reason and what to do."""

    def __init__(self, path: Path, error: OSError) -> None:
        super().__init__(error.errno, _reason(path, error))

    def __str__(self) -> str:
        return str(self.args[1])


def write_whole(path: Path, content: Content) -> None:
    """Write the content as the file `path`; raise NotWritten."""
    with prepared(path, content):
        pass


@contextmanager
def prepared(path: Path, content: Content) -> Iterator[None]:
    """Write the content beside `path` on entering, and move it there on leaving without an error.

    What must only happen if the file can be written goes into the `with` block; if it fails, the
    file is as it was. A device or a pipe has no old content, and is written to at once. Raises
    NotWritten.
    """
    with _told(path):
        is_plain = not path.exists() or path.is_file()
        to = path.resolve() if is_plain else path
    part = to.with_name(f".{to.name[:50]}.{os.getpid()}.part") if is_plain else to
    try:
        with _told(path), part.open("xb" if is_plain else "wb") as file:
            _write(file, content)
            file.flush()
            if is_plain:
                os.fsync(file.fileno())
        yield
        if is_plain:
            with _told(path):
                if to.exists():
                    part.chmod(stat.S_IMODE(to.stat().st_mode))
                part.replace(to)
    finally:
        if is_plain:
            with suppress(OSError):
                part.unlink(missing_ok=True)


def _write(file: IO[bytes], content: Content) -> None:
    if isinstance(content, str):
        file.write(content.encode())
    elif isinstance(content, bytes):
        file.write(content)
    else:
        content(file)


@contextmanager
def _told(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise NotWritten(path, error) from error


def _reason(path: Path, error: OSError) -> str:
    folder = path.absolute().parent
    match error.errno:
        case number if number in _FULL:
            said = f"{path} was not written: its disk is full, or your quota or limit of a file's"
            said += " size is reached. Make space, or name a file on another disk."
        case number if number in _NO_PERMISSION:
            said = f"{path} was not written: your account cannot make files in {folder}."
            said += " Name a file in another folder."
        case errno.ENOENT:
            said = f"{path} was not written: there is no folder {folder}. Make it, or name another."
        case errno.ENOTDIR:
            said = f"{path} was not written: part of that path is a file, not a folder."
        case errno.EISDIR:
            said = f"{path} was not written: it is a folder. Name a file in it."
        case _:
            said = f"{path} was not written: {error.strerror}. Name another file."
    with suppress(OSError):  # such as a name that is too long
        if path.is_file():
            said += " The file that is there is unchanged."
    return said
