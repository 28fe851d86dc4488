"""How connections to SQLite are set up, and how their transactions begin.

Another program may hold the lock that writers need. Whoever meets it waits `BUSY_TIMEOUT_S`; as
long as it stays locked those behind are told almost at once, so that a queue never adds up waits.
"""

import sqlite3

from sqlalchemy import Connection
from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.exc import OperationalError
from sqlalchemy.pool import ConnectionPoolEntry

BUSY_TIMEOUT_S, STILL_BUSY_TIMEOUT_S = 2.0, 0.1
LONGEST_LOG_PAGES = 65_536


def prepare_connection(dbapi_connection: DBAPIConnection, _record: ConnectionPoolEntry) -> None:
    """Set a new connection up for durable commits."""
    if not isinstance(dbapi_connection, sqlite3.Connection):
        return
    # Transactions are opened explicitly by `SqliteBegin`.
    dbapi_connection.isolation_level = None
    pragmas = (
        "journal_mode=WAL",
        "synchronous=FULL",
        "foreign_keys=ON",
        # What is deleted is overwritten with zeros: else erased data could be read in the file.
        "secure_delete=ON",
        # The server copies the log itself, beside its commits; this is only a limit to its length.
        f"wal_autocheckpoint={LONGEST_LOG_PAGES}",
    )
    for pragma in pragmas:
        dbapi_connection.execute(f"PRAGMA {pragma}")


class SqliteBegin:
    """Opens the transactions of an engine, and remembers whether another program held the lock."""

    def __init__(self) -> None:
        self._locked = False

    def __call__(self, connection: Connection) -> None:
        """Begin; a transaction that will write takes the lock at once."""
        if not connection.get_execution_options().get("reembody_writes", False):
            connection.exec_driver_sql("BEGIN")
            return
        timeout_s = STILL_BUSY_TIMEOUT_S if self._locked else BUSY_TIMEOUT_S
        if connection.info.get("busy_timeout_s") != timeout_s:
            connection.exec_driver_sql(f"PRAGMA busy_timeout={round(1000 * timeout_s)}")
            connection.info["busy_timeout_s"] = timeout_s
        try:
            connection.exec_driver_sql("BEGIN IMMEDIATE")
        except OperationalError as error:
            self._locked = _is_locked(error)
            raise
        self._locked = False
        connection.info["changes_before"] = _total_changes(connection)


def has_changes(connection: Connection) -> bool:
    """Whether its transaction changed anything; True where nobody counts, as on PostgreSQL."""
    before = connection.info.get("changes_before")
    return before is None or _total_changes(connection) > before


def _is_locked(error: OperationalError) -> bool:
    code: int = getattr(error.orig, "sqlite_errorcode", 0)
    return code & 0xFF == sqlite3.SQLITE_BUSY


def _total_changes(connection: Connection) -> int:
    return int(getattr(connection.connection.dbapi_connection, "total_changes", 0))
