"""Checksums over rows: equal exactly if the rows are, on whichever engine they are.

A table's checksum is SHA-256 over lines of compact ASCII JSON, each with a line feed: first the
names of its columns, then every row in the order of the primary key, with
`{"sha256": "..."}` in the place of bytes. Numbers are written with as few digits as bring them back
exactly. Everybody can compute it again with the tools of their choice.
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
    """How many rows a table has, and their checksum."""

    rows: int
    sha256: str


@dataclass
class Digester:
    """Adds up the checksum of one table, portion by portion."""

    shape: TableShape
    rows: int = 0
    _hash: Any = field(default_factory=hashlib.sha256)

    def __post_init__(self) -> None:
        self._hash.update(_line([column.name for column in self.shape.columns]))

    def add(self, rows: Iterable[Row]) -> None:
        """The next rows."""
        for row in rows:
            self._hash.update(_line(row))
            self.rows += 1

    @property
    def digest(self) -> TableDigest:
        """The checksum of the rows so far."""
        return TableDigest(self.rows, self._hash.hexdigest())


def digest_of(
    connection: Connection, shape: TableShape, progress: Progress = silent
) -> TableDigest:
    """The checksum of a table as it is now."""
    digester = Digester(shape)
    for rows in read_rows(connection, shape):
        digester.add(rows)
        progress(shape.name, len(rows))
    return digester.digest


def overall(revision: str, tables: Mapping[str, TableDigest]) -> str:
    """One checksum over a whole database: its schema's revision and the checksum of each table."""
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
