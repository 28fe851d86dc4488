"""Parse and check the database's address, and show it without its secrets.

No other module parses an address. Error messages leave out every part of it that could belong to a
password. A PostgreSQL database's encoding, mode and permissions are checked before it is used.
"""

import os
import re
from typing import Any

from sqlalchemy import URL, Connection, create_engine, make_url, text
from sqlalchemy.exc import ArgumentError, DBAPIError
from sqlalchemy.pool import NullPool

from app.errors import Conflict, InvalidInput, NotDurable

VARIABLE = "REEMBODY_DATABASE_URL"
DRIVERS = {
    "sqlite": "sqlite",
    "sqlite+pysqlite": "sqlite",
    "postgresql": "postgresql+psycopg",
    "postgres": "postgresql+psycopg",
    "postgresql+psycopg": "postgresql+psycopg",
}
"""The driver for each scheme that an address may begin with."""
FORMS = ("postgresql://ROLE:PASSWORD@HOST:5432/DATABASE", "sqlite:////absolute/path.sqlite")
LARGEST_PORT = 65_535
IN_MEMORY = ":memory:"
_SQLITE_OPTIONS = frozenset(
    {
        *("uri", "mode", "vfs", "immutable", "cache", "nolock", "psow", "modeof"),
        *("timeout", "isolation_level", "detect_types", "check_same_thread", "cached_statements"),
    }
)
"""Options of SQLite and its driver: error messages may show only these names."""
_SCHEME = re.compile(r"([A-Za-z0-9+.-]{1,30}):")
_ESCAPED = "In a role or password write @ as %40, : as %3A, / as %2F, ? as %3F and % as %25"
_PAGE = "See docs/postgresql.md"


def database_address(url: str) -> URL:
    """Parse an address and add its driver; an embedded database's path becomes absolute.

    Raises InvalidInput for an invalid address, showing no more of it than its scheme and the names
    of SQLite's options.
    """
    if not url.strip():
        raise _unusable("is empty", f"Unset {VARIABLE} to work with the embedded database")
    if url != url.strip() or any(ord(character) < ord(" ") for character in url):
        raise _unusable("begins or ends with a space, or contains a line break", "Remove it")
    scheme = _scheme_of(url)
    if scheme.startswith("postgres"):
        return _postgres_address(url, scheme)
    return _sqlite_address(url, scheme)


def shown_address(url: str) -> str:
    """Return the address for display: host, port and name, never a role or a password."""
    address = database_address(url)
    if address.get_backend_name() == "sqlite":
        return address.database or "in memory"
    place = address.host or str(address.query.get("host") or "this machine")
    port = "" if address.port is None else f":{address.port}"
    return f"{place}{port}/{address.database or ''}"


def connect_arguments(address: URL) -> dict[str, Any]:
    """Return the driver's arguments for opening a connection."""
    return {} if address.get_backend_name() == "sqlite" else {"client_encoding": "utf8"}


def open_connection(url: str) -> Connection:
    """Open a separate connection to the PostgreSQL database at `url`, outside any transaction.

    It belongs to no pool; close it together with its engine (`disconnect`). Raises InvalidInput or
    NotDurable if no connection can be made, Conflict if the database could not store the record.
    """
    address = database_address(url)
    try:
        engine = create_engine(
            address,
            poolclass=NullPool,
            isolation_level="AUTOCOMMIT",
            connect_args=connect_arguments(address),
        )
    except ImportError as error:
        raise InvalidInput(
            "the driver for PostgreSQL is not installed",
            remedy="Install it: pip install 'psycopg[binary]'",
        ) from error
    try:
        connection = engine.connect()
    except DBAPIError as error:
        engine.dispose()
        raise NotDurable(
            f"the database {shown_address(url)} cannot be reached: {first_line(error)}",
            remedy=f"Check that it runs, and the role, password, host and port of {VARIABLE}. "
            f"{_ESCAPED}. {_PAGE}",
        ) from error
    try:
        _require_usable(connection, shown_address(url))
    except BaseException:
        disconnect(connection)
        raise
    return connection


def disconnect(connection: Connection) -> None:
    """Close a connection and its engine, even if the server has already dropped it."""
    engine = connection.engine
    try:
        connection.close()
    except DBAPIError:
        connection.invalidate()
    finally:
        engine.dispose()


def first_line(error: DBAPIError) -> str:
    """Return the first line of a database error; the lines after it are SQL or hints."""
    lines = str(error.orig).strip().splitlines()
    return lines[0].strip().rstrip(".") if lines else type(error.orig).__name__


def _scheme_of(url: str) -> str:
    found = _SCHEME.match(url)
    scheme = found[1] if found and url.startswith("://", found.end() - 1) else None
    if scheme is None:
        raise _unusable("does not begin with a scheme and ://")
    if scheme not in DRIVERS:
        raise _unusable(f"begins with {scheme}://, which is not supported")
    return scheme


def _sqlite_address(url: str, scheme: str) -> URL:
    """Return the address of one file, whose name every reader understands in the same way.

    Locks, permissions and logs depend on the file's name. So anything is refused that makes SQLite
    open a file other than the one named.
    """
    address = _parsed(url)
    if address.host is not None or address.port is not None:
        raise _unusable(
            "names a host, which an embedded database does not have",
            "Write three slashes before a relative path and four before an absolute one",
        )
    if address.username is not None or address.password is not None:
        raise _unusable("names a role or a password, which an embedded database does not have")
    file = address.database or ""
    if file.lower().startswith("file:"):
        raise _unusable(
            "names its file as file:, which SQLite would interpret as a URI",
            "Write the path alone",
            value="file:",
        )
    if "?" in url:
        names = ", ".join(sorted(_SQLITE_OPTIONS & set(address.query)))
        raise _unusable(
            f"has options after a question mark{f' ({names})' if names else ''}, which can make "
            "SQLite open a file other than the one that is locked",
            "Write the path alone, without a question mark; the path of a folder "
            "(REEMBODY_DATA_DIR) may not contain one either",
            value=names or None,
        )
    if file not in ("", IN_MEMORY):
        # As the driver does: `..` is resolved without following a link before it.
        absolute = os.path.abspath(file)  # noqa: PTH100 - `Path.resolve` follows links
        address = address.set(database=absolute)
    return address.set(drivername=DRIVERS[scheme])


def _postgres_address(url: str, scheme: str) -> URL:
    if url.count("@") > 1:
        raise _unusable("has more than one @", _ESCAPED)
    address = _parsed(url).set(drivername=DRIVERS[scheme])
    # Neither may be shown: after an unescaped character they contain the rest of a password.
    if address.host is not None and not re.fullmatch(r"[\w.:%-]+", address.host):
        raise _unusable("has a host name with a space or another character it cannot have")
    if address.port is not None and not 0 < address.port <= LARGEST_PORT:
        raise _unusable(f"has a port that is not between 1 and {LARGEST_PORT}")
    return address


def _parsed(url: str) -> URL:
    try:
        return make_url(url)
    except ValueError:
        raise _unusable("has a port that is not a number", _ESCAPED) from None
    except ArgumentError:
        raise _unusable("cannot be read", _ESCAPED) from None


def _unusable(what: str, remedy: str = "", value: str | None = None) -> InvalidInput:
    forms = f"Valid are {' and '.join(FORMS)}"
    return InvalidInput(
        f"the address of the database ({VARIABLE}) {what}",
        value=value,
        valid=list(FORMS),
        remedy=f"{remedy}. {forms}. {_PAGE}" if remedy else f"{forms}. {_PAGE}",
    )


_FACTS = text(
    "SELECT current_setting('server_encoding') AS encoding,"
    " current_setting('transaction_read_only') AS read_only,"
    " current_user AS role, current_schema() AS schema,"
    " current_schema() IS NOT NULL AND has_schema_privilege(current_schema(), 'CREATE') AS creates,"
    " to_regclass('alembic_version') IS NOT NULL AS begun"
)


def _require_usable(connection: Connection, shown: str) -> None:
    """Raise Conflict if text, tables or rows could not be stored in the database."""
    facts = connection.execute(_FACTS).one()
    if facts.encoding != "UTF8":
        raise Conflict(
            f"the database {shown} stores text as {facts.encoding}, which cannot hold every name "
            "and answer; it was left as it is",
            value=facts.encoding,
            valid="UTF8",
            remedy="Make one with: CREATE DATABASE reembody ENCODING 'UTF8' TEMPLATE template0. "
            f"{_PAGE}",
        )
    if facts.read_only == "on":
        raise Conflict(
            f"the database {shown} is read-only (a replica, or set so)",
            remedy=f"Use the address of the server that accepts changes. {_PAGE}",
        )
    if not facts.begun and not facts.creates:
        where = "has no schema" if facts.schema is None else f"may not create in {facts.schema}"
        raise Conflict(
            f"the role {facts.role} {where} in the database {shown}",
            value=facts.schema,
            remedy=f"Make the role the owner of the database, or grant it the schema. {_PAGE}",
        )
