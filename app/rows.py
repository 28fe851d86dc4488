"""Insert many rows of a table with few statements."""

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import chain
from typing import Any

from sqlalchemy import Dialect, Table
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

LARGEST = 64
"""Maximum number of rows per SQLite statement; counts are split into powers of two."""
Names = tuple[str, ...]


def insert_rows(
    db: Session, table: Table, rows: Sequence[Mapping[str, Any]], *, moving: Names = ()
) -> None:
    """Insert rows that all have the same keys; columns with a default must be given, too.

    If a row with the same primary key exists, its columns `moving` get the new values; without
    `moving` that is an error.

    Passing rows singly is expensive in every driver; Python's SQLite driver also releases the
    interpreter lock for each row and has to wait for it again. So SQLite gets many rows in one
    statement, and PostgreSQL, whose driver is slow to parse a long statement, gets arrays of
    columns.
    """
    connection = db.connection()
    names = tuple(column.name for column in table.c if column.name in rows[0])
    columns = [
        [row[name] if process is None else process(row[name]) for row in rows]
        for name, process in _processors(table, names, connection.dialect)
    ]
    if connection.dialect.name == "postgresql":
        connection.exec_driver_sql(_from_arrays(table, names, moving), tuple(columns))
        return
    at = 0
    for count in _powers(len(rows)):
        part = (column[at : at + count] for column in columns)
        values = chain.from_iterable(zip(*part, strict=True))
        connection.exec_driver_sql(_from_rows(table, names, moving, count), tuple(values))
        at += count


def _powers(count: int) -> Iterator[int]:
    while count:
        power = min(LARGEST, 1 << (count.bit_length() - 1))
        yield power
        count -= power


@lru_cache(maxsize=256)
def _from_rows(table: Table, names: Names, moving: Names, rows: int) -> str:
    """Return SQLite's statement for this number of rows, with a parameter for every value."""
    row = f"({', '.join('?' * len(names))})"
    return _statement(table, names, moving, f"VALUES {', '.join([row] * rows)}")


@lru_cache(maxsize=64)
def _from_arrays(table: Table, names: Names, moving: Names) -> str:
    """Return PostgreSQL's statement for any number of rows, with an array for every column."""
    dialect = postgresql.dialect()  # type: ignore[no-untyped-call]  # SQLAlchemy has no type for it
    types = (table.c[name].type.compile(dialect) for name in names)
    arrays = ", ".join(f"%b::{type_}[]" for type_ in types)
    return _statement(table, names, moving, f"SELECT * FROM unnest({arrays})")  # noqa: S608 - names of our schema


def _statement(table: Table, names: Names, moving: Names, source: str) -> str:
    """Return the insert statement, which differs between the databases only in its `source`."""
    statement = sqlite.insert(table).values(dict.fromkeys(names))
    if moving:
        statement = statement.on_conflict_do_update(
            index_elements=list(table.primary_key),
            set_={name: statement.excluded[name] for name in moving},
        )
    # Compiling all rows would be slow, and the writer holds the lock meanwhile.
    text = str(statement.compile(dialect=sqlite.dialect()))
    return text.replace(f"VALUES ({', '.join('?' * len(names))})", source)


@lru_cache(maxsize=64)
def _processors(table: Table, names: Names, dialect: Dialect) -> tuple[tuple[str, Any], ...]:
    """Return each column's converter of values for the driver; None where none is needed."""
    impls = {name: table.c[name].type.dialect_impl(dialect) for name in names}
    return tuple((name, impl.bind_processor(dialect)) for name, impl in impls.items())
