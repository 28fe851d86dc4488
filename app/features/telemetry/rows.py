"""Writing many rows of a table with few statements."""

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any

from sqlalchemy import Dialect, Table
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

LARGEST = 64
"""Rows in one statement; numbers of rows are cut into powers of two, so that few texts suffice."""
Names = tuple[str, ...]


def insert_rows(
    db: Session, table: Table, rows: Sequence[Mapping[str, Any]], *, moving: Names = ()
) -> None:
    """Insert rows that all have the same keys; what has a default must be among them, too.

    A row that is there already, by its primary key, gets the new values of the columns `moving`;
    without them it is an error.

    Python's SQLite driver lets go of the interpreter for every row that it hands over singly, and
    has to wait for it again. So there rows go many to a statement.
    """
    connection = db.connection()
    if connection.dialect.name != "sqlite":
        connection.execute(_insert(table, moving), [dict(row) for row in rows])
        return
    names = tuple(column.name for column in table.c if column.name in rows[0])
    processors = _processors(table, names, connection.dialect)
    at = 0
    for count in _powers(len(rows)):
        values = tuple(
            row[name] if process is None else process(row[name])
            for row in rows[at : at + count]
            for name, process in processors
        )
        connection.exec_driver_sql(_text(table, names, moving, count), values)
        at += count


def _powers(count: int) -> Iterator[int]:
    while count:
        power = min(LARGEST, 1 << (count.bit_length() - 1))
        yield power
        count -= power


@lru_cache
def _insert(table: Table, moving: Names) -> postgresql.Insert:
    statement = postgresql.insert(table)
    if not moving:
        return statement
    return statement.on_conflict_do_update(
        constraint=table.primary_key, set_={name: statement.excluded[name] for name in moving}
    )


@lru_cache(maxsize=256)
def _text(table: Table, names: Names, moving: Names, rows: int) -> str:
    """The statement for so many rows; `names` are in the order of the table."""
    statement = sqlite.insert(table).values(dict.fromkeys(names))
    if moving:
        statement = statement.on_conflict_do_update(
            index_elements=list(table.primary_key),
            set_={name: statement.excluded[name] for name in moving},
        )
    text = str(statement.compile(dialect=sqlite.dialect()))
    # Compiling them all would take long, and the writer holds the lock meanwhile.
    row = f"({', '.join('?' * len(names))})"
    return text.replace(f"VALUES {row}", f"VALUES {', '.join([row] * rows)}")


@lru_cache(maxsize=64)
def _processors(table: Table, names: Names, dialect: Dialect) -> tuple[tuple[str, Any], ...]:
    """What turns a column's values into the driver's; None where they are the same."""
    impls = {name: table.c[name].type.dialect_impl(dialect) for name in names}
    return tuple((name, impl.bind_processor(dialect)) for name, impl in impls.items())
