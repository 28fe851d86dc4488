"""Read and write rows in a form that is the same on both engines, a few at a time."""

from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from typing import Any

from sqlalchemy import (
    JSON,
    BigInteger,
    Boolean,
    Column,
    ColumnElement,
    Connection,
    DateTime,
    Double,
    Integer,
    LargeBinary,
    MetaData,
    Result,
    Select,
    String,
    Table,
    Text,
    bindparam,
    cast,
    column,
    func,
    insert,
    literal,
    null,
    select,
    table,
)

from app.features.care.backups.shapes import ColumnShape, Kind, TableShape

Row = tuple[Any, ...]
SHORT_ROWS, LONG_ROWS = 2000, 64
"""How many rows are in memory simultaneously."""
CACHED_QUERIES = 256
_MOMENT = "YYYY-MM-DD HH24:MI:SS.US"
Progress = Callable[[str, int], None]
"""A callback with a table's name and how many more of its rows are done."""


def read_rows(connection: Connection, shape: TableShape) -> Iterator[list[Row]]:
    """Yield all rows in portions, ordered by the primary key; texts sort by code point."""
    size = LONG_ROWS if shape.has_bytes else SHORT_ROWS
    if connection.dialect.name == "sqlite":
        # A driver-level query: each file has an engine of its own, which would compile it again.
        result: Result[Any] = connection.exec_driver_sql(_sqlite_query(shape))
    else:
        query = _postgresql_query(shape)
        result = connection.execute(query, execution_options={"yield_per": size})
    for portion in result.partitions(size):
        yield [tuple(row) for row in portion]


def write_rows(connection: Connection, shape: TableShape, rows: Sequence[Row]) -> None:
    """Insert rows from `read_rows`, on the same or on the other engine."""
    if connection.dialect.name == "sqlite":
        connection.exec_driver_sql(sqlite_insert(shape), list(rows))
        return
    names = [f"v{at}" for at in range(len(shape.columns))]
    values = {
        one.name: _to_postgresql(one.kind, name)
        for one, name in zip(shape.columns, names, strict=True)
    }
    statement = insert(_bare(shape)).values(values)
    connection.execute(statement, [dict(zip(names, row, strict=True)) for row in rows])


def sqlite_insert(shape: TableShape) -> str:
    """Return the SQLite statement that inserts a row of this table, with a `?` for each column."""
    names = ", ".join(_quoted(one.name) for one in shape.columns)
    marks = ", ".join("?" * len(shape.columns))
    return f"INSERT INTO {_quoted(shape.name)} ({names}) VALUES ({marks})"  # noqa: S608 - names, quoted


@lru_cache(maxsize=CACHED_QUERIES)
def _sqlite_query(shape: TableShape) -> str:
    # SQLite converts JSON that looks like a number to a number.
    selected = ", ".join(
        f"CAST({_quoted(one.name)} AS TEXT)" if one.kind is Kind.JSON else _quoted(one.name)
        for one in shape.columns
    )
    order = f" ORDER BY {', '.join(map(_quoted, shape.key))}" if shape.key else ""
    return f"SELECT {selected} FROM {_quoted(shape.name)}{order}"  # noqa: S608 - names, quoted


def _quoted(name: str) -> str:
    # The names come from the file, which may be malicious.
    return '"' + name.replace('"', '""') + '"'


@lru_cache(maxsize=CACHED_QUERIES)
def _postgresql_query(shape: TableShape) -> Select[Any]:
    by_name = {one.name: one for one in shape.columns}
    return (
        select(*(_from_postgresql(one).label(f"v{at}") for at, one in enumerate(shape.columns)))
        .select_from(table(shape.name))
        .order_by(*(_ordered(by_name[name]) for name in shape.key))
    )


def _ordered(one: ColumnShape) -> ColumnElement[Any]:
    # PostgreSQL sorts texts by its locale, SQLite by their bytes.
    if one.kind is Kind.TEXT:
        return column(one.name, String).collate("C")
    return column(one.name)


def _from_postgresql(one: ColumnShape) -> ColumnElement[Any]:
    match one.kind:
        case Kind.MOMENT:
            moment = column(one.name, DateTime(timezone=True))
            return func.to_char(func.timezone("UTC", moment), _MOMENT)
        case Kind.JSON:
            return cast(column(one.name), Text)
        case Kind.TRUTH:
            return cast(column(one.name, Boolean), Integer)
        case Kind.NUMBER:
            not_a_number = cast(literal("NaN", String), Double)
            return func.nullif(column(one.name, Double), not_a_number) + cast(0, Double)
        case _:
            return column(one.name)


def _to_postgresql(kind: Kind, name: str) -> ColumnElement[Any]:
    match kind:
        case Kind.MOMENT:
            return func.timezone("UTC", cast(bindparam(name, type_=String), DateTime))
        case Kind.JSON:
            return cast(bindparam(name, type_=String), JSON)
        case Kind.TRUTH:
            return cast(bindparam(name, type_=Integer), Boolean)
        case Kind.NUMBER:
            return bindparam(name, type_=Double)
        case Kind.BYTES:
            return bindparam(name, type_=LargeBinary)
        case Kind.INTEGER:
            return bindparam(name, type_=BigInteger)
        case _:
            return bindparam(name, type_=String)


def _bare(shape: TableShape) -> Table:
    return Table(shape.name, MetaData(), *(Column(one.name, null().type) for one in shape.columns))


def silent(_table: str, _rows: int) -> None:
    """Ignore the progress (the default callback)."""
