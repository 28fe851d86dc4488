"""Run the server with a database that does not flush, to show that tests detect this.

Usage: `python -m tests.faults.weakened NORMAL serve ...`.
"""

import sqlite3
import sys

from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.pool import ConnectionPoolEntry

from app import database
from app.cli import main
from app.sqlite_connections import prepare_connection


def weaken(level: str) -> None:
    """Set SQLite's `synchronous` option on every future connection."""

    def prepare(dbapi_connection: DBAPIConnection, _record: ConnectionPoolEntry) -> None:
        prepare_connection(dbapi_connection, _record)
        assert isinstance(dbapi_connection, sqlite3.Connection)
        dbapi_connection.execute(f"PRAGMA synchronous={level}")

    database.__dict__["prepare_connection"] = prepare


if __name__ == "__main__":
    weaken(sys.argv.pop(1))
    main()
