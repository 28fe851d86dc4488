"""Share compiled SQL between all databases of a test process.

SQLAlchemy caches compiled SQL per engine and per dialect object. Almost every test has its own
database and so its own engine, which would compile the same hundred statements again: this takes
longer than the database takes to answer them. Here all engines of a process share one cache, and
two dialects count as the same key if they generate the same SQL.
"""

from typing import Any

from sqlalchemy import Engine
from sqlalchemy.dialects.postgresql.psycopg import PGDialect_psycopg
from sqlalchemy.dialects.sqlite.pysqlite import SQLiteDialect_pysqlite
from sqlalchemy.engine.interfaces import Dialect
from sqlalchemy.util import LRUCache

MOST_STATEMENTS = 2000
SETTINGS = (
    "server_version_info",
    "default_schema_name",
    "paramstyle",
    "_json_serializer",
    "_json_deserializer",
)
"""The attributes of two dialects of one class that change the compiled SQL."""
_compiled: LRUCache[Any, Any] = LRUCache(MOST_STATEMENTS)


def share_statement_caches() -> None:
    """Share compiled statements between all engines that this process creates from now on."""
    for dialect in (SQLiteDialect_pysqlite, PGDialect_psycopg):
        methods = {"engine_created": classmethod(_use), "__eq__": _alike, "__hash__": _hash}
        for name, method in methods.items():
            setattr(dialect, name, method)


def _use(_dialect: type[Dialect], engine: Engine) -> None:
    engine.update_execution_options(compiled_cache=_compiled)


def _alike(one: Dialect, other: object) -> bool:
    return type(one) is type(other) and all(
        getattr(one, name, None) == getattr(other, name, None) for name in SETTINGS
    )


def _hash(dialect: Dialect) -> int:
    # Not by its settings: the version is unknown before it has connected.
    return hash(type(dialect))
