"""The database edge: one request is one transaction, and committed means on disk.

SQLite runs in WAL mode with synchronous FULL, so that a commit survives a power loss. It has one
writer: writing transactions start with BEGIN IMMEDIATE (a deferred transaction that upgrades from
reading to writing fails at once, whatever the busy time-out) and queue on an in-process lock, which
keeps their waiting fair and short. PostgreSQL needs neither and gets neither. Another program may
hold the lock that writers need: whoever meets it waits `BUSY_TIMEOUT_S`; as long as it stays locked
those behind are told almost at once, so that a queue never adds up waits.

A request's transaction may begin and end on different threads. So the lock belongs to nobody in
particular, and requests wait for it on threads of their own: if they waited on the threads that run
endpoints, the one that holds the lock could find no thread to finish on. PostgreSQL's row locks are
waited for where endpoints run, so fewer requests may write at once than there are such threads.
"""

import asyncio
import sqlite3
import threading
import time
from collections import deque
from collections.abc import AsyncIterator, Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager, contextmanager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol, TypeVar

from anyio import CapacityLimiter
from anyio.to_thread import run_sync
from sqlalchemy import Connection, Engine, MetaData, create_engine, event
from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.exc import DatabaseError, OperationalError
from sqlalchemy.orm import DeclarativeBase, Session
from sqlalchemy.pool import ConnectionPoolEntry, NullPool

from app.database_address import connect_arguments, database_address
from app.errors import DamagedValue, NotDurable

BUSY_TIMEOUT_S, STILL_BUSY_TIMEOUT_S = 2.0, 0.1
LONGEST_LOG_PAGES = 65_536
NAMING_CONVENTION = {
    "ix": "ix_%(table_name)s_%(column_0_N_name)s",
    "uq": "uq_%(table_name)s_%(column_0_N_name)s",
    "ck": "ck_%(table_name)s_%(constraint_name)s",
    "fk": "fk_%(table_name)s_%(column_0_N_name)s_%(referred_table_name)s",
    "pk": "pk_%(table_name)s",
}
TURN_TIMEOUT_S = 20.0
"""How long a request waits for the writers of this process before it is told to come again."""
WRITERS = 20
"""Half of the threads that endpoints run on."""
Result = TypeVar("Result")
Row = TypeVar("Row", bound="Base")


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


class FairLock:
    """A lock whose waiters get it in the order in which they came.

    Python's own lock goes to whoever asks at the right moment: of a crowd that wants to write, most
    are served at once and a few wait for all the others. One holder at a time; it may be given back
    by another thread than the one that took it.
    """

    def __init__(self) -> None:
        self._mutex = threading.Lock()
        self._taken = False
        self._waiting: deque[threading.Lock] = deque()

    def acquire(self, timeout: float = -1) -> bool:
        """Take it, after at most `timeout` seconds (no limit if negative); False if it did not."""
        with self._mutex:
            if not self._taken:
                self._taken = True
                return True
            mine = threading.Lock()
            mine.acquire()
            self._waiting.append(mine)
        if mine.acquire(timeout=timeout):
            return True
        with self._mutex:
            if mine not in self._waiting:
                # Handed over while the time ran out.
                return True
            self._waiting.remove(mine)
            return False

    def release(self) -> None:
        """Hand it to the one who waits longest."""
        with self._mutex:
            if self._waiting:
                self._waiting.popleft().release()
            else:
                self._taken = False

    def __enter__(self) -> None:
        self.acquire()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.release()


class Base(DeclarativeBase):
    """Base of all tables; constraint names are the same on every engine."""

    metadata = MetaData(naming_convention=NAMING_CONVENTION)


class WriteObserver(Protocol):
    """Hears what becomes of writing transactions, from any thread."""

    def failed(self, error: DatabaseError) -> object:
        """The database refused."""

    def succeeded(self) -> object:
        """Changes are on disk."""


@dataclass(eq=False)
class CommitCount:
    """How many transactions of this process have changed something.

    `copied`: the number up to which SQLite's log was copied completely; one at a time copies it.
    """

    number: int = 0
    copied: int = 0
    copying: threading.Lock = field(default_factory=threading.Lock)


@dataclass(frozen=True)
class Database:
    """An engine with its two ways in: `reading()` and `writing()`."""

    engine: Engine
    observer: WriteObserver | None = None
    commits: CommitCount = field(default_factory=CommitCount)
    _write_lock: FairLock = field(default_factory=FairLock)
    _queue: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(1, "writes"))
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
        with self.write_turn(), self._observed(), self._writer() as session:
            yield session
            self._commit(session)

    @contextmanager
    def write_turn(self) -> Iterator[None]:
        """Keep every other writer of this process out, on SQLite."""
        with self._write_lock if self.is_sqlite else nullcontext():
            yield

    @asynccontextmanager
    async def writing_async(self) -> AsyncIterator[Session]:
        """The same for a request: waits and commits without holding up the event loop.

        Raises NotDurable when its turn does not come.
        """
        async with self._turn():
            with self._observed(), self._writer() as session:
                yield session
                await run_sync(self._commit, session)

    async def write(self, work: Callable[[Session], Result]) -> Result:
        """The same on one thread, which waits, works and commits: for what comes in crowds.

        `work` gets the transaction and must not wait for anything else. On SQLite a crowd queues
        for one thread, which goes from commit to commit. Raises NotDurable likewise.
        """
        if not self.is_sqlite:
            return await run_sync(self._in_transaction, work, limiter=self._writers)
        late_s = time.monotonic() + TURN_TIMEOUT_S

        def in_turn() -> Result:
            self._take_turn(late_s - time.monotonic())
            try:
                return self._in_transaction(work)
            finally:
                self._write_lock.release()

        return await asyncio.get_running_loop().run_in_executor(self._queue, in_turn)

    def _in_transaction(self, work: Callable[[Session], Result]) -> Result:
        with self._observed(), self._writer() as session:
            result = work(session)
            self._commit(session)
            return result

    @asynccontextmanager
    async def _turn(self) -> AsyncIterator[None]:
        if self.is_sqlite:
            await run_sync(self._take_turn, limiter=self._waiting_room)
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

    def _take_turn(self, timeout_s: float = TURN_TIMEOUT_S) -> None:
        if not self._write_lock.acquire(timeout=max(0.0, timeout_s)):
            raise NotDurable(
                "too much waits to be stored before this; nothing was promised",
                value=f"waited {TURN_TIMEOUT_S:g} s",
                remedy="Try again in a moment.",
            )

    def _writer(self) -> Session:
        engine = self.engine.execution_options(reembody_writes=True)
        return Session(engine, expire_on_commit=False)

    def _commit(self, session: Session) -> None:
        session.flush()
        changes = session.in_transaction() and has_changes(session.connection())
        session.commit()
        # A commit without changes says nothing of the disk.
        if changes:
            self.commits.number += 1
            if self.observer is not None:
                self.observer.succeeded()

    @contextmanager
    def _observed(self) -> Iterator[None]:
        try:
            yield
        except DatabaseError as error:
            if self.observer is not None:
                self.observer.failed(error)
            raise

    def close(self) -> None:
        """Return every connection."""
        self._queue.shutdown()
        self.engine.dispose()


def make_engine(url: str, *, pooled: bool = True) -> Engine:
    """An engine for `sqlite:///FILE` or `postgresql://...`, set up for durable commits.

    Not `pooled`, it opens a connection for every use. What a statement stores stays out of the
    messages of errors, which get into logs: it may be somebody's answers. Raises InvalidInput for
    another address.
    """
    parsed = database_address(url)
    pool: dict[str, Any] = {} if pooled else {"poolclass": NullPool}
    if parsed.get_backend_name() != "sqlite":
        if pooled:
            pool = {"pool_size": 10, "max_overflow": 20, "pool_pre_ping": True}
        arguments = connect_arguments(parsed)
        return create_engine(parsed, hide_parameters=True, connect_args=arguments, **pool)
    if parsed.database:
        Path(parsed.database).parent.mkdir(parents=True, exist_ok=True)
        # Without a file there is one connection for all, and so no pool to size.
        # The connection used last comes first: every one that is used keeps a cache of its own.
        pool = pool or {"pool_size": 20, "max_overflow": 40, "pool_use_lifo": True}
    engine = create_engine(
        parsed,
        hide_parameters=True,
        connect_args={"timeout": BUSY_TIMEOUT_S, "check_same_thread": False},
        **pool,
    )
    event.listen(engine, "connect", prepare_connection)
    event.listen(engine, "begin", SqliteBegin())
    return engine


def open_database(url: str, observer: WriteObserver | None = None) -> Database:
    """Open `url` without touching its schema."""
    return Database(make_engine(url), observer)


def kept_row(db: Session, kind: type[Row], key: str) -> Row:
    """The row that another row names, of a table whose rows are never deleted.

    Raises DamagedValue where it is not there: foreign keys hold, so only damage brings that about.
    A row that may be deleted meanwhile is looked for with `get` or `get_one`.
    """
    row = db.get(kind, key)
    if row is None:
        raise DamagedValue(f"{key!r} names no row of {kind.__name__}")
    return row
