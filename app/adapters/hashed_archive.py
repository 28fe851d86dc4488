"""Store tables with a header as one file that notices damage: a NumPy archive without pickles.

The archive holds `header`, a JSON text, and tables. The header contains a hash of everything else,
so that a truncated or changed file is rejected. The file is written next to its destination and
then moved there: a reader finds either the old or the new file, complete.
"""

import errno
import hashlib
import json
import lzma
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Final

import numpy as np

from app.whole_files import write_whole

MOST_BYTES: Final = 2_000_000_000
UNREADABLE: Final = (
    ValueError,
    LookupError,
    TypeError,
    AttributeError,
    ArithmeticError,
    EOFError,
    SyntaxError,
    RuntimeError,
    MemoryError,
    OSError,
    struct.error,
    tokenize.TokenError,
    zlib.error,
    lzma.LZMAError,
    zipfile.BadZipFile,
)
"""What reading an archive raises if a single bit is wrong, or if it is another NumPy file.
An OSError counts if it comes from a decompressor (no number), or is about a place that no file can
have (EINVAL)."""


@dataclass(frozen=True)
class ArchiveKind:
    """A kind of file.

    Attributes:
        format: what its header calls it.
        version: of its format.
        tables: the names of its tables, in the order of the hash.
        title: what it is, as in "a walking model".
        command: the command that writes one.
        error: what is raised for a file that is none.
    """

    format: str
    version: int
    tables: Sequence[str]
    title: str
    command: str
    error: type[ValueError]

    def write(self, path: Path, header: Mapping[str, Any], tables: Mapping[str, Any]) -> str:
        """Write a file atomically and return its content hash; raise OSError."""
        whole = {**header, "format": self.format, "version": self.version}
        own = {name: np.ascontiguousarray(tables[name]) for name in self.tables}
        digest = self.content_hash(whole, own)
        text = json.dumps({**whole, "content_hash": digest}, sort_keys=True)
        letters = np.frombuffer(text.encode(), dtype=np.uint8)

        def write(file: IO[bytes]) -> None:
            np.savez_compressed(file, allow_pickle=False, header=letters, **own)

        write_whole(path, write)
        return digest

    def is_one(self, path: Path) -> bool:
        """Return whether a file is of this kind, of any version; raise OSError."""
        try:
            header, _ = self._contents(path, ())
        except ValueError:
            return False
        return isinstance(header, dict) and header.get("format") == self.format

    def read(self, path: Path) -> tuple[dict[str, Any], dict[str, Any], str]:
        """Read a file; return its header, its tables and its content hash.

        Raises:
            ValueError: (`error`) the file is of another kind, of a later version, or damaged.
            OSError: it cannot be opened.
        """
        header, tables = self._contents(path, self.tables)
        self._check_header(path, header)
        digest = str(header.pop("content_hash", ""))
        if digest != self.content_hash(header, tables):
            raise self.error(f"{path}: damaged, its content does not match its hash; fit it again.")
        return header, tables, digest

    def _contents(self, path: Path, names: Sequence[str]) -> tuple[Any, dict[str, Any]]:
        """Return the header, whatever it is, and the named tables; raise `error`, OSError."""
        if path.stat().st_size > MOST_BYTES:
            raise self.error(f"{path}: larger than {MOST_BYTES} bytes, which no model is.")
        try:
            with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
                header = json.loads(archive["header"].tobytes().decode())
                return header, {name: archive[name] for name in names}
        except UNREADABLE as error:
            if isinstance(error, OSError) and error.errno not in (None, errno.EINVAL):
                raise
            raise self.error(
                f"{path}: not {self.title}; `{self.command}` writes one. If it was one, it is"
                " damaged: fit it again."
            ) from error

    def content_hash(self, header: Mapping[str, Any], tables: Mapping[str, Any]) -> str:
        """Return the SHA-256 of the header, without its own hash, and the tables."""
        digest = hashlib.sha256(json.dumps(header, sort_keys=True).encode())
        for name in self.tables:
            table = tables[name]
            digest.update(f"{name} {table.dtype.str} {table.shape}".encode())
            digest.update(np.ascontiguousarray(table).tobytes())
        return digest.hexdigest()

    def _check_header(self, path: Path, header: object) -> None:
        if not isinstance(header, dict) or header.get("format") != self.format:
            raise self.error(f"{path}: not {self.title}.")
        if header.get("version") != self.version:
            raise self.error(
                f"{path}: version {header.get('version')} of the format, this program reads"
                f" {self.version}."
            )
