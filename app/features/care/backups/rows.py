"""Rows in one form that is the same on both engines, read and written a few at a time."""

from collections.abc import Callable, Iterator, Sequence
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
"""How many rows are in memory at once."""
_MOMENT = "YYYY-MM-DD HH24:MI:SS.US"
Progress = Callable[[str, int], None]
"""Called with a table's name and how many more of its rows are done."""


def read_rows(connection: Connection, shape: TableShape) -> Iterator[list[Row]]:
    """All rows in the order of the primary key, texts ordered by code point, in portions."""
    size = LONG_ROWS if shape.has_bytes else SHORT_ROWS
    query = _query(shape, postgresql=connection.dialect.name == "postgresql")
    result = connection.execute(query, execution_options={"yield_per": size})
    for portion in result.partitions():
        yield [tuple(row) for row in portion]


def write_rows(connection: Connection, shape: TableShape, rows: Sequence[Row]) -> None:
    """Insert rows that `read_rows` gave, on this engine or on the other."""
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
    """The statement that stores such a row in SQLite, with a `?` for each column."""
    # The words are the schema's own, from our migrations.
    quoted = ", ".join(f'"{one.name}"' for one in shape.columns)
    marks = ", ".join("?" * len(shape.columns))
    return f'INSERT INTO "{shape.name}" ({quoted}) VALUES ({marks})'  # noqa: S608 - names of our schema


def _query(shape: TableShape, *, postgresql: bool) -> Select[Any]:
    convert = _from_postgresql if postgresql else _from_sqlite
    by_name = {one.name: one for one in shape.columns}
    return (
        select(*(convert(one).label(f"v{at}") for at, one in enumerate(shape.columns)))
        .select_from(table(shape.name))
        .order_by(*(_ordered(by_name[name], postgresql=postgresql) for name in shape.key))
    )


def _ordered(one: ColumnShape, *, postgresql: bool) -> ColumnElement[Any]:
    plain: ColumnElement[Any] = column(one.name, String) if _is_text(one) else column(one.name)
    # PostgreSQL sorts texts as its locale likes; SQLite sorts their bytes.
    return plain.collate("C") if postgresql and _is_text(one) else plain


def _is_text(one: ColumnShape) -> bool:
    return one.kind is Kind.TEXT


def _from_sqlite(one: ColumnShape) -> ColumnElement[Any]:
    # SQLite makes a number of JSON that looks like one.
    return cast(column(one.name), Text) if one.kind is Kind.JSON else column(one.name)


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
    """Tell nobody."""
