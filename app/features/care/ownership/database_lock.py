"""The lock of a PostgreSQL database: a session's advisory lock, on a connection of its own.

The connection belongs to no pool, so nothing recycles it, and the server releases the lock when
the connection ends for any reason. The connection's name says who holds the lock. It has to
reach the server itself: behind a pooler that shares connections (PgBouncer's transaction mode)
a session's lock has no effect, which `is_held` detects.
"""

import contextlib
import re

from sqlalchemy import Connection, text
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from app.database_address import disconnect, first_line, open_connection, shown_address
from app.errors import NotDurable
from app.features.care.ownership.owner import Owned, Owner

KEY = int.from_bytes(b"reembody", "big")
"""The key of the lock in every database; its halves are `classid` and `objid` in `pg_locks`."""
LONGEST_NAME = 63
"""The longest name of a connection in PostgreSQL."""
_NAME = re.compile(r"reembody (\S+) (\d+) (\d+|-) (\S*)")
"""The name of an owner's connection: command, process id, port, machine."""
_MINE = "locktype = 'advisory' AND classid = :high AND objid = :low AND objsubid = 1 AND granted"
_KEYS = {"key": KEY, "high": KEY >> 32, "low": KEY & 0xFFFFFFFF}
_ENDED_NOTICED_BY_SERVER = (
    "SET tcp_keepalives_idle = 10",
    "SET tcp_keepalives_interval = 5",
    "SET tcp_keepalives_count = 3",
)
"""Detect a dead client within half a minute; by default its lock would last for two hours."""


class DatabaseLock:
    """The lock on the database at `url`, taken on construction.

    Raises Owned, and the errors of `open_connection`.
    """

    def __init__(self, url: str, owner: Owner) -> None:
        self._url, self._owner = url, owner
        self._connection = self._taken()

    def announce(self, owner: Owner) -> None:
        """Set the connection's name to the owner's description."""
        self._owner = owner
        with contextlib.suppress(SQLAlchemyError):
            _name(self._connection, owner)

    def is_held(self) -> bool:
        """Return whether this connection still holds the lock, according to the server."""
        query = f"SELECT count(*) FROM pg_locks WHERE pid = pg_backend_pid() AND {_MINE}"  # noqa: S608 - constants
        try:
            return bool(self._connection.execute(text(query), _KEYS).scalar())
        except SQLAlchemyError:  # including the error of a closed connection
            return False

    def take_again(self) -> None:
        """Reconnect and take the lock; raise the same errors as the constructor."""
        disconnect(self._connection)
        self._connection = self._taken()

    def release(self) -> None:
        """Release the lock by closing the connection."""
        disconnect(self._connection)

    def _taken(self) -> Connection:
        connection = open_connection(self._url)
        try:
            for statement in _ENDED_NOTICED_BY_SERVER:
                connection.execute(text(statement))
            _name(connection, self._owner)
            if not connection.execute(text("SELECT pg_try_advisory_lock(:key)"), _KEYS).scalar():
                what = f"the database {shown_address(self._url)}"
                raise Owned(what, _holder(connection))
        except DBAPIError as error:
            disconnect(connection)
            raise NotDurable(
                f"the database {shown_address(self._url)} cannot be locked: {first_line(error)}",
                remedy="Check that it is running and intact, then try again.",
            ) from error
        except Owned:
            disconnect(connection)
            raise
        return connection


def _name(connection: Connection, owner: Owner) -> None:
    host = re.sub(r"[^\x21-\x7e]", "?", owner.host)
    name = f"reembody {owner.command} {owner.pid} {owner.port or '-'} {host}"
    connection.execute(
        text("SELECT set_config('application_name', :name, false)"), {"name": name[:LONGEST_NAME]}
    )


def _holder(connection: Connection) -> Owner | None:
    """Return the owner of the lock; None if this role may not read other connections."""
    found = connection.execute(
        text(
            "SELECT application_name, backend_start FROM pg_stat_activity WHERE pid IN "  # noqa: S608 - constants
            f"(SELECT pid FROM pg_locks WHERE {_MINE} AND database ="
            " (SELECT oid FROM pg_database WHERE datname = current_database()))"
        ),
        _KEYS,
    ).first()
    named = None if found is None else _NAME.match(found.application_name or "")
    if found is None or named is None:
        return None
    command, pid, port, host = named.groups()
    return Owner(
        pid=int(pid),
        port=None if port == "-" else int(port),
        host=host,
        since=found.backend_start.isoformat(timespec="seconds"),
        command=command,
    )
