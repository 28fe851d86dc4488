"""The database edge: one request is one transaction, and committed means on disk.

SQLite runs in WAL mode with synchronous FULL, so that a commit survives a power loss. It has one
writer: writing transactions start with BEGIN IMMEDIATE (a deferred transaction that upgrades from
reading to writing fails at once, whatever the busy time-out) and queue on an in-process lock, which
keeps their waiting fair and short. PostgreSQL needs neither and gets neither.

A request's transaction may begin and end on different threads. So the lock belongs to nobody in
particular, and requests wait for it on threads of their own: if they waited on the threads that run
endpoints, the one that holds the lock could find no thread to finish on. PostgreSQL's row locks are
waited for where endpoints run, so fewer requests may write at once than there are such threads.
"""

import sqlite3
import threading
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path

from alembic import command
from alembic.config import Config
from anyio import CapacityLimiter
from anyio.to_thread import run_sync
from sqlalchemy import Connection, Engine, MetaData, create_engine, event, make_url
from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.orm import DeclarativeBase, Session
from sqlalchemy.pool import ConnectionPoolEntry

from app.resources import migrations_dir

NAMING_CONVENTION = {
    "ix": "ix_%(table_name)s_%(column_0_N_name)s",
    "uq": "uq_%(table_name)s_%(column_0_N_name)s",
    "ck": "ck_%(table_name)s_%(constraint_name)s",
    "fk": "fk_%(table_name)s_%(column_0_N_name)s_%(referred_table_name)s",
    "pk": "pk_%(table_name)s",
}
BUSY_TIMEOUT_S = 30.0
LONGEST_LOG_PAGES = 65_536
WRITERS = 20
"""Half of the threads that endpoints run on."""


class Base(DeclarativeBase):
    """Base of all tables; constraint names are the same on every engine."""

    metadata = MetaData(naming_convention=NAMING_CONVENTION)


@dataclass(frozen=True)
class Database:
    """An engine with its two ways in: `reading()` and `writing()`."""

    engine: Engine
    _write_lock: threading.Lock = field(default_factory=threading.Lock)
    _waiting_room: CapacityLimiter = field(default_factory=lambda: CapacityLimiter(1000))
    _writers: CapacityLimiter = field(default_factory=lambda: CapacityLimiter(WRITERS))

    @property
    def is_sqlite(self) -> bool:
        """Whether this is the embedded database."""
        return self.engine.dialect.name == "sqlite"

    @contextmanager
    def reading(self) -> Iterator[Session]:
        """A consistent snapshot, however long it is read; nothing in it is ever written."""
        with Session(self.engine, expire_on_commit=False) as session:
            if not self.is_sqlite:
                # On SQLite every transaction sees one moment; PostgreSQL must be asked for it.
                session.connection(execution_options={"isolation_level": "REPEATABLE READ"})
            yield session

    @contextmanager
    def writing(self) -> Iterator[Session]:
        """One transaction: committed as the block ends, rolled back if it raises. Not nestable."""
        with self.write_turn(), self._writer() as session:
            yield session
            session.commit()

    @contextmanager
    def write_turn(self) -> Iterator[None]:
        """Keep every other writer of this process out, on SQLite."""
        with self._write_lock if self.is_sqlite else nullcontext():
            yield

    @asynccontextmanager
    async def writing_async(self) -> AsyncIterator[Session]:
        """The same for a request: waits and commits without holding up the event loop."""
        async with self._turn():
            with self._writer() as session:
                yield session
                await run_sync(session.commit)

    @asynccontextmanager
    async def _turn(self) -> AsyncIterator[None]:
        if self.is_sqlite:
            await run_sync(self._write_lock.acquire, limiter=self._waiting_room)
            try:
                yield
            finally:
                self._write_lock.release()
        else:
            request = object()
            await self._writers.acquire_on_behalf_of(request)
            try:
                yield
            finally:
                self._writers.release_on_behalf_of(request)

    def _writer(self) -> Session:
        engine = self.engine.execution_options(reembody_writes=True)
        return Session(engine, expire_on_commit=False)

    def close(self) -> None:
        """Return every connection."""
        self.engine.dispose()


def make_engine(url: str) -> Engine:
    """An engine for `sqlite:///FILE` or `postgresql://...`, set up for durable commits."""
    parsed = make_url(url)
    if parsed.drivername in {"postgresql", "postgres"}:
        parsed = parsed.set(drivername="postgresql+psycopg")
    if parsed.get_backend_name() != "sqlite":
        return create_engine(parsed, pool_size=10, max_overflow=20, pool_pre_ping=True)
    if parsed.database:
        Path(parsed.database).parent.mkdir(parents=True, exist_ok=True)
    # Without a file there is one connection for all, and so no pool to size.
    pool = {"pool_size": 20, "max_overflow": 40} if parsed.database else {}
    engine = create_engine(
        parsed,
        connect_args={"timeout": BUSY_TIMEOUT_S, "check_same_thread": False},
        **pool,
    )
    event.listen(engine, "connect", _prepare_sqlite)
    event.listen(engine, "begin", _begin_sqlite)
    return engine


def open_database(url: str) -> Database:
    """Open `url` without touching its schema."""
    return Database(make_engine(url))


def alembic_config(url: str) -> Config:
    """Alembic's configuration for `url`, pointing at the migrations that ship with the product."""
    config = Config()
    config.set_main_option("script_location", str(migrations_dir()))
    config.attributes["url"] = url
    return config


def migrate(url: str) -> None:
    """Bring the schema of `url` to the newest version, from whatever version it has."""
    command.upgrade(alembic_config(url), "head")


def _prepare_sqlite(dbapi_connection: DBAPIConnection, _record: ConnectionPoolEntry) -> None:
    if not isinstance(dbapi_connection, sqlite3.Connection):
        return
    # Transactions are opened explicitly by `_begin_sqlite`.
    dbapi_connection.isolation_level = None
    pragmas = (
        "journal_mode=WAL",
        "synchronous=FULL",
        "foreign_keys=ON",
        # The server copies the log itself, beside its commits; this is only a limit to its length.
        f"wal_autocheckpoint={LONGEST_LOG_PAGES}",
    )
    for pragma in pragmas:
        dbapi_connection.execute(f"PRAGMA {pragma}")


def _begin_sqlite(connection: Connection) -> None:
    writes = connection.get_execution_options().get("reembody_writes", False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")
