"""The tables of a schema, as far as copying needs to know them.

They are read from a SQLite file, not from the models: a backup keeps the schema that it was made
with, and a later version of the product, whose models differ, must still be able to read it.
"""

from collections import OrderedDict
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from typing import Any

from sqlalchemy import (
    JSON,
    Boolean,
    Connection,
    Date,
    DateTime,
    Float,
    Integer,
    LargeBinary,
    String,
    Table,
    Time,
    inspect,
    text,
)
from sqlalchemy.types import TypeDecorator, TypeEngine

from app.database import Base
from app.schema_revisions import VERSION_TABLE

MANIFEST_TABLE = "backup_manifest"


class Kind(StrEnum):
    """The type of a column's values."""

    TEXT = "text"
    INTEGER = "integer"
    NUMBER = "number"
    TRUTH = "truth"
    MOMENT = "moment"
    JSON = "json"
    BYTES = "bytes"


_KINDS: tuple[tuple[type[TypeEngine[Any]], Kind], ...] = (
    (DateTime, Kind.MOMENT),
    (Boolean, Kind.TRUTH),
    (JSON, Kind.JSON),
    (LargeBinary, Kind.BYTES),
    (Float, Kind.NUMBER),
    (Integer, Kind.INTEGER),
    (String, Kind.TEXT),
)


@dataclass(frozen=True)
class ColumnShape:
    """A column with its type of values."""

    name: str
    kind: Kind


@dataclass(frozen=True)
class TableShape:
    """A table: its columns in the schema's order, and the column names of its primary key."""

    name: str
    columns: tuple[ColumnShape, ...]
    key: tuple[str, ...]

    @property
    def has_bytes(self) -> bool:
        """Return whether the table has a column of bytes, and so may have long rows."""
        return any(column.kind is Kind.BYTES for column in self.columns)


def shapes_of(connection: Connection) -> tuple[TableShape, ...]:
    """Return the product's tables in a SQLite file, referenced ones first.

    Raises ValueError for a column of a type that cannot be copied exactly.
    """
    # A backup needs one schema several times; it is cached by the SQL that created it.
    definition = tuple(
        connection.scalars(text("SELECT sql FROM sqlite_master ORDER BY type, name"))
    )
    if definition not in _cache:
        _cache[definition] = _read(connection)
        while len(_cache) > _MAX_CACHED:
            _cache.popitem(last=False)
    return _cache[definition]


@lru_cache(maxsize=1)
def shapes_of_models() -> tuple[TableShape, ...]:
    """Return the tables of this program's models, referenced ones first."""
    return tuple(_shape(table) for table in Base.metadata.sorted_tables)


_MAX_CACHED = 16
_cache: OrderedDict[tuple[str | None, ...], tuple[TableShape, ...]] = OrderedDict()


def _read(connection: Connection) -> tuple[TableShape, ...]:
    # Not `MetaData.reflect`: most of its time goes into constraints that no copy needs.
    inspector = inspect(connection)
    columns, keys = inspector.get_multi_columns(), inspector.get_multi_pk_constraint()
    return tuple(
        TableShape(
            name,
            tuple(
                ColumnShape(one["name"], _kind(name, one["name"], one["type"]))
                for one in columns[None, name]
            ),
            tuple(keys[None, name]["constrained_columns"]),
        )
        for name, _ in inspector.get_sorted_table_and_fkc_names()
        if name is not None and name not in {VERSION_TABLE, MANIFEST_TABLE}
    )


def _shape(table: Table) -> TableShape:
    columns = tuple(
        ColumnShape(column.name, _kind(table.name, column.name, column.type))
        for column in table.columns
    )
    return TableShape(table.name, columns, tuple(column.name for column in table.primary_key))


def _kind(table: str, column: str, type_: TypeEngine[Any]) -> Kind:
    if isinstance(type_, TypeDecorator):
        type_ = type_.impl_instance
    for of, kind in _KINDS:
        if isinstance(type_, of) and not isinstance(type_, Date | Time):
            return kind
    raise ValueError(f"column {table}.{column} is of type {type_!r}, which no backup can hold")
