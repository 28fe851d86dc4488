"""The address of the database: read once, checked in words, and shown without its secrets.

Nobody else reads an address. What is wrong with one is said without any of it that could be part of
a password, and what a PostgreSQL database must offer is looked at before anything works with it.
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
"""How an address may begin, and what works with it."""
FORMS = ("postgresql://ROLE:PASSWORD@HOST:5432/DATABASE", "sqlite:////absolute/path.sqlite")
LARGEST_PORT = 65_535
IN_MEMORY = ":memory:"
_SQLITE_OPTIONS = frozenset(
    {
        *("uri", "mode", "vfs", "immutable", "cache", "nolock", "psow", "modeof"),
        *("timeout", "isolation_level", "detect_types", "check_same_thread", "cached_statements"),
    }
)
"""Names that SQLite or its driver knows, and which may therefore be shown."""
_SCHEME = re.compile(r"([A-Za-z0-9+.-]{1,30}):")
_ESCAPED = "In a role or password write @ as %40, : as %3A, / as %2F, ? as %3F and % as %25"
_PAGE = "See docs/postgresql.md"


def database_address(url: str) -> URL:
    """An address with the driver that works with it; an embedded database's path is absolute.

    Raises InvalidInput for one that cannot be one, without showing more of it than its scheme and
    the names of SQLite's options.
    """
    if not url.strip():
        raise _unusable("is empty", f"Unset {VARIABLE} to work with the embedded database")
    if url != url.strip() or any(ord(character) < ord(" ") for character in url):
        raise _unusable("begins or ends with a space, or holds a line break", "Remove it")
    scheme = _scheme_of(url)
    if scheme.startswith("postgres"):
        return _postgres_address(url, scheme)
    return _sqlite_address(url, scheme)


def shown_address(url: str) -> str:
    """Where the database is, for people: host, port and name, never a role or a password."""
    address = database_address(url)
    if address.get_backend_name() == "sqlite":
        return address.database or "in memory"
    place = address.host or str(address.query.get("host") or "this machine")
    port = "" if address.port is None else f":{address.port}"
    return f"{place}{port}/{address.database or ''}"


def connect_arguments(address: URL) -> dict[str, Any]:
    """What each connection to a PostgreSQL server is opened with."""
    return {} if address.get_backend_name() == "sqlite" else {"client_encoding": "utf8"}


def connected(url: str) -> Connection:
    """A connection of its own to the PostgreSQL database at `url`, in no transaction.

    No pool knows it; close it together with its engine (`disconnect`). Raises InvalidInput or
    NotDurable where there is none to be had, Conflict where the database could not hold the record.
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
    """Close what `connected` opened, also where the other end is gone."""
    engine = connection.engine
    try:
        connection.close()
    except DBAPIError:
        connection.invalidate()
    finally:
        engine.dispose()


def first_line(error: DBAPIError) -> str:
    """What a database says of an error, on one line: the lines behind it are SQL or hints."""
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
    """The address of one file, which everybody who reads it takes for the same one.

    Locks, permissions and logs depend on the file's name. So nothing is taken that lets SQLite open
    another file than the one that is written there.
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
            "names its file as file:, which SQLite would read as an address of its own",
            "Write the path alone",
            value="file:",
        )
    if "?" in url:
        names = ", ".join(sorted(_SQLITE_OPTIONS & set(address.query)))
        raise _unusable(
            f"has options behind a question mark{f' ({names})' if names else ''}, which can lead "
            "SQLite to another file than the one that is locked",
            "Write the path alone, without a question mark; the path of a folder "
            "(REEMBODY_DATA_DIR) may hold none either",
            value=names or None,
        )
    if file not in ("", IN_MEMORY):
        # As the driver does: `..` is taken off without following a link before it.
        absolute = os.path.abspath(file)  # noqa: PTH100 - `Path.resolve` follows links
        address = address.set(database=absolute)
    return address.set(drivername=DRIVERS[scheme])


def _postgres_address(url: str, scheme: str) -> URL:
    if url.count("@") > 1:
        raise _unusable("has more than one @", _ESCAPED)
    address = _parsed(url).set(drivername=DRIVERS[scheme])
    # Neither may be shown: behind a character that was not escaped stands the rest of a password.
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
    """Raises Conflict where texts, tables or rows could not be stored."""
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
            remedy=f"Name the server that takes changes. {_PAGE}",
        )
    if not facts.begun and not facts.creates:
        where = "has no schema" if facts.schema is None else f"may not create in {facts.schema}"
        raise Conflict(
            f"the role {facts.role} {where} in the database {shown}",
            value=facts.schema,
            remedy=f"Make the role the owner of the database, or grant it the schema. {_PAGE}",
        )
