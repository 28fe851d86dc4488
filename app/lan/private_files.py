"""Files with keys: written whole or not at all, and readable by their owner only."""

import os
import secrets
import stat
from pathlib import Path

from app.errors import NotAllowed

OTHERS = stat.S_IRWXG | stat.S_IRWXO
POSIX = os.name == "posix"
"""Elsewhere a file's mode says nothing about who may read it; its folder's rights hold."""


def write_private(file: Path, content: bytes) -> None:
    """Put `content` at `file` for its owner alone, on disk before it replaces what was there."""
    file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    file.parent.chmod(0o700)
    part = file.with_name(f".{file.name}.{secrets.token_hex(4)}")
    try:
        handle = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(handle, "wb") as writing:
            writing.write(content)
            writing.flush()
            os.fsync(writing.fileno())
        part.replace(file)
    finally:
        part.unlink(missing_ok=True)
    _flush_folder(file.parent)


def read_private(file: Path) -> bytes:
    """The content of a file with a key; raises NotAllowed if others could have read it."""
    if POSIX and file.stat().st_mode & OTHERS:
        raise NotAllowed(
            f"{file} holds a private key, and others on this machine can read it",
            value=oct(stat.S_IMODE(file.stat().st_mode)),
            valid="0o600",
            remedy=(
                f"If nobody has: chmod 600 {file}. If somebody may have: delete it and start again;"
                " devices then install the new certificate"
            ),
        )
    return file.read_bytes()


def _flush_folder(folder: Path) -> None:
    if not POSIX:
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
