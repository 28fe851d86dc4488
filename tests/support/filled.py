"""Fill every table of a database with rows, whatever revision its schema has.

Columns, references and checks are read from the database, so a table of a later migration gets rows
too without a change here.
"""

import re
from collections import OrderedDict
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from typing import Any, TypeVar

from sqlalchemy import (
    JSON,
    BigInteger,
    Boolean,
    Column,
    Connection,
    DateTime,
    Engine,
    Float,
    Integer,
    LargeBinary,
    MetaData,
    Table,
    inspect,
    text,
)

ROWS = 3
KEPT = 16
T = TypeVar("T")
VERSION_TABLE = "alembic_version"
LISTED = re.compile(r"\(?\"?(\w+)\"?\)?(?:::\w+)? (?:IN \(|= ANY \()(.+)")
QUOTED = re.compile(r"'(\w+)'")


def tables_of(engine: Engine | Connection) -> list[Table]:
    """Return the product's current tables; a table comes before those that refer to it."""
    if isinstance(engine, Connection):
        return _tables_in(statements_of(engine), engine)
    return _reflected(engine)


def statements_of(connection: Connection) -> tuple[str, ...]:
    """Return the statements that define a database's schema.

    Databases with the same statements have the same schema, so its description can be cached.
    """
    query = _ON_SQLITE if connection.dialect.name == "sqlite" else _ON_POSTGRES
    return tuple(sorted(connection.scalars(query)))


_ON_SQLITE = text("SELECT type || ' ' || name || ' ' || sql FROM sqlite_master WHERE sql > ''")
# The standard's own view of columns asks about rights, and takes six times as long.
_ON_POSTGRES = text("""
    SELECT concat_ws(' ', 'column', a.attrelid::regclass, a.attnum, a.attname,
        format_type(a.atttypid, a.atttypmod), CASE WHEN a.attnotnull THEN 'NOT NULL' END,
        'DEFAULT ' || pg_get_expr(d.adbin, d.adrelid), concat('identity ', a.attidentity),
        concat('generated ', a.attgenerated), concat('collation ', a.attcollation))
    FROM pg_attribute AS a JOIN pg_class AS c ON c.oid = a.attrelid
    LEFT JOIN pg_attrdef AS d ON d.adrelid = a.attrelid AND d.adnum = a.attnum
    WHERE c.relnamespace = 'public'::regnamespace AND c.relkind = 'r'
    AND a.attnum > 0 AND NOT a.attisdropped
    UNION ALL
    SELECT concat_ws(' ', 'constraint', conrelid::regclass, conname, pg_get_constraintdef(oid))
    FROM pg_constraint WHERE connamespace = 'public'::regnamespace
    UNION ALL
    SELECT 'index ' || indexdef FROM pg_indexes WHERE schemaname = 'public'
""")


def remembered(
    ask: Callable[[Connection], T],
) -> Callable[[tuple[str, ...], Connection], T]:
    """Cache a function of a database's schema by the statements that define it."""
    told: OrderedDict[tuple[str, ...], T] = OrderedDict()

    def tell(schema: tuple[str, ...], connection: Connection) -> T:
        if schema not in told:
            told[schema] = ask(connection)
            while len(told) > KEPT:
                told.popitem(last=False)
        return told[schema]

    return tell


def _reflected(engine: Engine | Connection) -> list[Table]:
    metadata = MetaData()
    metadata.reflect(engine)
    return [table for table in metadata.sorted_tables if table.name != VERSION_TABLE]


_tables_in = remembered(_reflected)


def fill(engine: Engine, rows: int = ROWS) -> None:
    """Insert `rows` rows into every table; each row refers to the rows with the same number."""
    writes = engine.execution_options(reembody_writes=True)
    with writes.begin() as connection:
        schema = statements_of(connection)
        for table in _tables_in(schema, connection):
            listed = _listed_in(schema, connection).get(table.name, {})
            connection.execute(table.insert(), [_row(table, listed, at) for at in range(rows)])


def contents(engine: Engine) -> dict[str, list[dict[str, Any]]]:
    """Return all rows of all tables, sorted by primary key."""
    with engine.connect() as connection:
        return contents_by(statements_of(connection), connection)


def contents_by(schema: tuple[str, ...], connection: Connection) -> dict[str, list[dict[str, Any]]]:
    """Return `contents` of a database whose schema these statements define."""
    return {
        table.name: [
            dict(row)
            for row in connection.execute(
                table.select().order_by(*table.primary_key.columns)
            ).mappings()
        ]
        for table in _tables_in(schema, connection)
    }


def _listed(connection: Connection) -> dict[str, dict[str, list[str]]]:
    """Return the allowed words of each column that a check restricts, by table."""
    allowed: dict[str, dict[str, list[str]]] = {}
    for (_, table), checks in inspect(connection).get_multi_check_constraints().items():
        for check in checks:
            found = LISTED.search(check["sqltext"])
            if found:
                allowed.setdefault(table, {})[found[1]] = QUOTED.findall(found[2])
    return allowed


_listed_in = remembered(_listed)


def _row(table: Table, listed: dict[str, list[str]], at: int) -> dict[str, Any]:
    return {column.name: _value(column, listed.get(column.name), at) for column in table.columns}


def _value(column: Column[Any], words: list[str] | None, at: int) -> Any:
    if column.foreign_keys:
        return _value(next(iter(column.foreign_keys)).column, None, at)
    if column.name == "time_scale":
        return 1.0
    match column.type:
        case DateTime():
            moment = datetime(2026, 3, 29, 1, 59, 59, tzinfo=UTC) + timedelta(microseconds=at)
            # SQLite keeps no zone, and its reflected type takes none.
            return moment if column.type.timezone else moment.replace(tzinfo=None)
        case JSON():
            return {"ö": [at, 1.5, None, "\u2028"]}
        case LargeBinary():
            return bytes(range(256)) * (at + 1)
        case Boolean() | Float() | Integer():
            return _number(column.type, at)
    if words:
        return words[at % len(words)]
    written = f"{at}-{column.table.name[:8]}.{column.name[:12]}-naïve \U0001f9e0"
    return written[: getattr(column.type, "length", None)]


def _number(type_: Boolean | Float[Any] | Integer, at: int) -> bool | int | float:
    match type_:
        case Boolean():
            return at % 2 == 0
        case Float():
            return at + 1 / 3
        case BigInteger():
            return 2**53 - 1 - at
    return 2**31 - 1 - at
