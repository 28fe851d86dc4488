"""How connections to SQLite are set up, and how their transactions begin.

SQLite runs in WAL mode with synchronous FULL, so that a commit survives a power loss. It allows one
writer, whose transaction starts with BEGIN IMMEDIATE: a deferred transaction that upgrades from
reading to writing fails immediately, whatever the busy timeout. Another program may hold the write
lock: the first writer to find it locked waits `BUSY_TIMEOUT_S`; while it stays locked, the writers
after it fail almost immediately, so that waits in the queue do not add up.
"""

import sqlite3
import threading

from sqlalchemy import Connection, Engine
from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.exc import OperationalError
from sqlalchemy.pool import ConnectionPoolEntry

BUSY_TIMEOUT_S, STILL_BUSY_TIMEOUT_S = 2.0, 0.1
LONGEST_LOG_PAGES = 65_536


def prepare_connection(dbapi_connection: DBAPIConnection, _record: ConnectionPoolEntry) -> None:
    """Configure a new SQLite connection for durable commits; leave other connections unchanged."""
    if not isinstance(dbapi_connection, sqlite3.Connection):
        return
    # Transactions are opened explicitly by `SqliteBegin`.
    dbapi_connection.isolation_level = None
    pragmas = (
        "journal_mode=WAL",
        "synchronous=FULL",
        "foreign_keys=ON",
        # Overwrite deleted content with zeros: otherwise erased data could still be read from the
        # file.
        "secure_delete=ON",
        # The server checkpoints the log itself, outside its commits; this only limits the log's
        # length.
        f"wal_autocheckpoint={LONGEST_LOG_PAGES}",
    )
    for pragma in pragmas:
        dbapi_connection.execute(f"PRAGMA {pragma}")


class SqliteBegin:
    """Opens the transactions of an engine, and remembers whether another program held the lock."""

    def __init__(self) -> None:
        self._locked = False

    def __call__(self, connection: Connection) -> None:
        """Begin a transaction; one that will write takes the write lock immediately."""
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
    """Return whether the transaction changed anything; True if unknown, as on PostgreSQL."""
    before = connection.info.get("changes_before")
    return before is None or _total_changes(connection) > before


def _is_locked(error: OperationalError) -> bool:
    code: int = getattr(error.orig, "sqlite_errorcode", 0)
    return code & 0xFF == sqlite3.SQLITE_BUSY


def _total_changes(connection: Connection) -> int:
    return int(getattr(connection.connection.dbapi_connection, "total_changes", 0))


class LogKeeper:
    """Keeps SQLite's log open while the connections of a pool come and go.

    With its last connection SQLite removes the log and the log's index. A full disk has no room for
    new ones, so nobody could even read until there is room again.
    """

    def __init__(self, file: str) -> None:
        self._file = file
        self._mutex = threading.Lock()
        self._kept: sqlite3.Connection | None = None

    def keep(self, _connection: DBAPIConnection, _record: ConnectionPoolEntry) -> None:
        """Open the log, unless it is open already."""
        with self._mutex:
            if self._kept is None:
                kept = sqlite3.connect(self._file, check_same_thread=False)
                # SQLite opens the log with the first statement that reads.
                kept.execute("PRAGMA schema_version").fetchone()
                self._kept = kept

    def release(self, _engine: Engine) -> None:
        """Close the log with the engine, so that SQLite can tidy up."""
        with self._mutex:
            if self._kept is not None:
                self._kept.close()
                self._kept = None
