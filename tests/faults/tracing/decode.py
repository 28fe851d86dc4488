"""Decode a system call's number and arguments to an event: file or socket, bytes, offset."""

import os
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.faults.tracing.calls import AT_FDCWD, AT_REMOVEDIR, O_CREAT, O_TRUNC, OPEN_FLAGS_AT
from tests.faults.tracing.events import NEVER, Event
from tests.faults.tracing.kernel import read_memory

PATH_MAX = 4096
PAGE = 4096
WRITES = {"write", "writev", "pwrite64", "pwritev", "pwritev2"}
SENDS = {"sendto", "sendmsg"}
ON_FILES = {"fallocate": 0, "sendfile": 0, "copy_file_range": 2, "splice": 2, "sendmmsg": 0}
"""Calls that are not decoded, with the index of the argument that names the changed file."""
WITH_FOLDER = {"openat", "unlinkat", "renameat", "renameat2", "linkat"}
"""Calls whose paths may be relative to an open folder, named before each path."""
Arguments = Sequence[int]


@dataclass(frozen=True)
class Reader:
    """Decode the calls of traced threads; files outside `folder` are ignored."""

    folder: Path

    def read(self, thread: int, call: str, arguments: Arguments) -> Event | None:
        """Return the event without its result, or None if the call is ignored."""
        if call in WRITES or call in SENDS:
            return self._written(thread, call, arguments)
        if call in ("fsync", "fdatasync"):
            return self._on(thread, arguments[0], "sync", call)
        if call == "ftruncate":
            return self._on(thread, arguments[0], "truncate", call, size=arguments[1])
        if call in ON_FILES:
            return self._on(thread, arguments[ON_FILES[call]], "other", call)
        return self._named(thread, call, arguments)

    def _written(self, thread: int, call: str, arguments: Arguments) -> Event | None:
        target = target_of(thread, arguments[0])
        what = "send" if target.startswith("socket:") else "write"
        if what == "write" and not self._matters(target):
            return None
        offset = 0
        if what == "write":
            at = call.startswith("pwrite")
            offset = arguments[3] if at else _position(thread, arguments[0])
        return _event(what, call, target, offset=offset, data=_data(thread, call, arguments))

    def _on(self, thread: int, file: int, what: str, call: str, *, size: int = 0) -> Event | None:
        target = target_of(thread, file)
        if target.startswith("socket:") or not self._matters(target):
            return None
        return _event(what, call, target, size=size)

    def _named(self, thread: int, call: str, arguments: Arguments) -> Event | None:
        """Decode calls that name a file by its path."""
        at = call in WITH_FOLDER
        path = path_of(thread, arguments[0] if at else AT_FDCWD, arguments[1 if at else 0])
        if call.startswith(("rename", "link")):
            to_path = path_of(thread, arguments[2] if at else AT_FDCWD, arguments[3 if at else 1])
            if not (self._matters(path) or self._matters(to_path)):
                return None
            what = "rename" if call.startswith("rename") else "other"
            return _event(what, call, path, to_path=to_path)
        if not self._matters(path):
            return None
        if call == "truncate":
            return _event("truncate", call, path, size=arguments[1])
        if call.startswith("unlink"):
            folder = call == "unlinkat" and arguments[2] & AT_REMOVEDIR
            return _event("other" if folder else "unlink", call, path)
        return _opened(call, path, arguments)

    def _matters(self, target: str) -> bool:
        path = target.removesuffix(" (deleted)")
        return path == str(self.folder) or path.startswith(f"{self.folder}/")


def _opened(call: str, path: str, arguments: Arguments) -> Event | None:
    """Return the event of an open call that creates a missing file or empties an existing one."""
    flags = O_CREAT | O_TRUNC if call == "creat" else arguments[OPEN_FLAGS_AT[call]]
    exists = Path(path).exists()
    if not exists:
        return _event("create", call, path) if flags & O_CREAT else None
    return _event("truncate", call, path) if flags & O_TRUNC else None


def _event(
    what: str,
    call: str,
    path: str,
    *,
    offset: int = 0,
    size: int = 0,
    to_path: str = "",
    data: bytes = b"",
) -> Event:
    """Return an event that has no stamps yet."""
    return Event(
        what=what,
        call=call,
        path=path,
        began=0,
        ended=NEVER,
        began_ns=0,
        ended_ns=0,
        offset=offset,
        size=size,
        to_path=to_path,
        data=data,
    )


def target_of(thread: int, file: int) -> str:
    """Return the path of a thread's open file, or `socket:[NUMBER]`; empty if there is none."""
    try:
        return str(Path(f"/proc/{thread}/fd/{_signed(file)}").readlink())
    except OSError:
        return ""


def _position(thread: int, file: int) -> int:
    for line in Path(f"/proc/{thread}/fdinfo/{_signed(file)}").read_text().splitlines():
        if line.startswith("pos:"):
            return int(line.removeprefix("pos:"))
    raise RuntimeError(f"file {file} of thread {thread} has no position")


def _signed(value: int) -> int:
    """Return a descriptor as a C int; the upper half of the register is undefined."""
    low = value & 0xFFFFFFFF
    return low - 2**32 if low >= 2**31 else low


def _data(thread: int, call: str, arguments: Arguments) -> bytes:
    if call in ("write", "pwrite64", "sendto"):
        return read_memory(thread, arguments[1], arguments[2])
    if call == "sendmsg":
        # struct msghdr: name, length of the name, then the vector and its length.
        vector, count = struct.unpack_from("=QQ", read_memory(thread, arguments[1], 32), 16)
        return _gathered(thread, vector, count)
    return _gathered(thread, arguments[1], arguments[2])


def _gathered(thread: int, vector: int, count: int) -> bytes:
    """Return the bytes that an array of struct iovec points at."""
    raw = read_memory(thread, vector, 16 * count)
    pieces = struct.iter_unpack("=QQ", raw)
    return b"".join(read_memory(thread, address, length) for address, length in pieces if length)


def path_of(thread: int, folder: int, address: int) -> str:
    """Return a path as the kernel resolves it: relative to the thread's folder."""
    text = os.fsdecode(_string(thread, address, read_memory))
    if not text or text.startswith("/"):
        return os.path.normpath(text) if text else ""
    start = _signed(folder)
    link = f"/proc/{thread}/cwd" if start == AT_FDCWD else f"/proc/{thread}/fd/{start}"
    return os.path.normpath(f"{Path(link).readlink()}/{text}")


def _string(thread: int, address: int, read: Callable[[int, int, int], bytes]) -> bytes:
    found = b""
    while b"\0" not in found and len(found) < PATH_MAX:
        # Read to the end of a page: the next one may not be mapped.
        piece = read(thread, address + len(found), PAGE - (address + len(found)) % PAGE)
        if not piece:
            break
        found += piece
    return found.partition(b"\0")[0]
