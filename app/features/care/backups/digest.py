"""Checksums over rows: equal if and only if the rows are equal, whichever engine they are on.

A table's checksum is SHA-256 over lines of compact ASCII JSON, each with a line feed: first the
names of its columns, then every row in the order of the primary key, with `{"sha256": "..."}` in
the place of bytes. Numbers are written with the fewest digits that restore them exactly. Anybody
can compute it again with other tools.
"""

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from sqlalchemy import Connection

from app.features.care.backups.rows import Progress, Row, read_rows, silent
from app.features.care.backups.shapes import TableShape


@dataclass(frozen=True)
class TableDigest:
    """The number of rows of a table, and their checksum."""

    rows: int
    sha256: str


@dataclass
class Digester:
    """The checksum of one table, computed from its rows a few at a time."""

    shape: TableShape
    rows: int = 0
    _hash: Any = field(default_factory=hashlib.sha256)

    def __post_init__(self) -> None:
        self._hash.update(_line([column.name for column in self.shape.columns]))

    def add(self, rows: Iterable[Row]) -> None:
        """Add the next rows."""
        for row in rows:
            self._hash.update(_line(row))
            self.rows += 1

    @property
    def digest(self) -> TableDigest:
        """Return the checksum of the rows so far."""
        return TableDigest(self.rows, self._hash.hexdigest())


def digest_of(
    connection: Connection, shape: TableShape, progress: Progress = silent
) -> TableDigest:
    """Return the current checksum of a table."""
    digester = Digester(shape)
    for rows in read_rows(connection, shape):
        digester.add(rows)
        progress(shape.name, len(rows))
    return digester.digest


def overall(revision: str, tables: Mapping[str, TableDigest]) -> str:
    """Return one checksum over a whole database: its schema revision and all tables' checksums."""
    listed = {name: [one.rows, one.sha256] for name, one in sorted(tables.items())}
    return hashlib.sha256(_line([revision, listed])).hexdigest()


def _bytes_as_checksum(value: object) -> dict[str, str]:
    if isinstance(value, bytes | memoryview):
        return {"sha256": hashlib.sha256(value).hexdigest()}
    raise TypeError(f"{type(value).__name__} is in a row, and no backup can hold it")


_encode = json.JSONEncoder(
    ensure_ascii=True, separators=(",", ":"), default=_bytes_as_checksum
).encode


def _line(values: object) -> bytes:
    return _encode(values).encode("ascii") + b"\n"
