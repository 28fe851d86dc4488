"""Database access: each request is one transaction, and a committed transaction is on disk.

SQLite allows one writer (`app/sqlite_connections.py`): writing transactions queue on an in-process
lock, which keeps their waiting fair and short. PostgreSQL needs no such lock and has none.

A request's transaction may start and end on different threads. The lock is therefore not owned by a
thread, and requests wait for it in a separate thread pool: if they waited on the threads that run
endpoints, the request that holds the lock might find no thread to finish on. PostgreSQL's row locks
are awaited on the endpoint threads, so the number of simultaneous writers is limited to fewer than
there are such threads.
"""

import asyncio
import threading
import time
from collections import deque
from collections.abc import AsyncIterator, Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager, contextmanager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol, TypeVar, cast

from anyio import CapacityLimiter
from anyio.to_thread import run_sync
from sqlalchemy import Connection, Engine, MetaData, create_engine, event
from sqlalchemy.exc import DatabaseError
from sqlalchemy.orm import DeclarativeBase, Session
from sqlalchemy.pool import NullPool

from app.database_address import connect_arguments, database_address
from app.errors import DamagedValue, NotDurable
from app.sqlite_connections import (
    BUSY_TIMEOUT_S,
    LogKeeper,
    SqliteBegin,
    has_changes,
    prepare_connection,
)

NAMING_CONVENTION = {
    "ix": "ix_%(table_name)s_%(column_0_N_name)s",
    "uq": "uq_%(table_name)s_%(column_0_N_name)s",
    "ck": "ck_%(table_name)s_%(constraint_name)s",
    "fk": "fk_%(table_name)s_%(column_0_N_name)s_%(referred_table_name)s",
    "pk": "pk_%(table_name)s",
}
TURN_TIMEOUT_S = 20.0
"""How long a request waits for other writers of this process before it is told to retry."""
MOST_TOGETHER = 64
"""How many writes may share a commit, so that other writers of the process get their turns."""
ON_COMMIT = "on_commit"
"""The key in `Session.info` of what to do once the commit that a session shares is on disk."""
WRITERS = 20
"""Maximum number of writers on PostgreSQL: half of the threads that endpoints run on."""
FORM_WRITERS = 2
"""How many of the writes that arrive in large numbers run at a time on PostgreSQL.

While one waits for the database, the other computes. More of them wait for the interpreter most of
the time: sixteen forms at once took 22 ms of processor time each, 16 ms two by two.
"""
Result = TypeVar("Result")
Row = TypeVar("Row", bound="Base")


class FairLock:
    """A lock that serves its waiters in the order in which they arrived.

    Python's own lock goes to any thread that requests it at the right moment: of many threads that
    want to write, most are served immediately and a few wait for all the others. One holder at a
    time; a thread may release the lock that another thread acquired.
    """

    def __init__(self) -> None:
        self._mutex = threading.Lock()
        self._taken = False
        self._waiting: deque[threading.Lock] = deque()

    def acquire(self, timeout: float = -1) -> bool:
        """Acquire the lock within `timeout` seconds; return whether it succeeded.

        A negative `timeout` means no limit.
        """
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
                # The lock was handed over just as the timeout expired.
                return True
            self._waiting.remove(mine)
            return False

    def release(self) -> None:
        """Release the lock, or hand it to the thread that has waited longest."""
        with self._mutex:
            if self._waiting:
                self._waiting.popleft().release()
            else:
                self._taken = False

    def __enter__(self) -> None:
        self.acquire()

    def __exit__(self, *_error: object) -> None:
        self.release()


class Base(DeclarativeBase):
    """Base class of all tables; constraint names are the same on every database engine."""

    metadata = MetaData(naming_convention=NAMING_CONVENTION)


class WriteObserver(Protocol):
    """Receives the outcome of writing transactions, from any thread."""

    def failed(self, error: DatabaseError) -> object:
        """Handle a transaction that the database refused with `error`."""

    def succeeded(self) -> object:
        """Handle a transaction whose changes are on disk."""


@dataclass(eq=False)
class CommitCount:
    """The number of transactions of this process that have changed something.

    `copied` is the value of `number` up to which SQLite's log was completely copied into the
    database file; `copying` is held by the one thread that copies it.
    """

    number: int = 0
    copied: int = 0
    copying: threading.Lock = field(default_factory=threading.Lock)


@dataclass(eq=False)
class Waiting:
    """A write that waits for its turn until `late_s`, by the monotonic clock, and its outcome."""

    work: Callable[[Session], Any]
    late_s: float
    result: Any = None
    error: Exception | None = None
    done: bool = False


@dataclass(frozen=True)
class Database:
    """A database engine, used through `reading()` and `writing()`."""

    engine: Engine
    observer: WriteObserver | None = None
    commits: CommitCount = field(default_factory=CommitCount)
    _write_lock: FairLock = field(default_factory=FairLock)
    _queue: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(1, "writes"))
    _waiting: deque[Waiting] = field(default_factory=deque)
    _waiting_room: CapacityLimiter = field(default_factory=lambda: CapacityLimiter(1000))
    _form_writers: CapacityLimiter = field(default_factory=lambda: CapacityLimiter(FORM_WRITERS))
    _writers: CapacityLimiter = field(default_factory=lambda: CapacityLimiter(WRITERS))

    @property
    def is_sqlite(self) -> bool:
        """Whether this is the embedded SQLite database."""
        return self.engine.dialect.name == "sqlite"

    @contextmanager
    def reading(self) -> Iterator[Session]:
        """Open a session on a consistent snapshot of the database; it must not write."""
        with Session(self.engine, expire_on_commit=False) as session:
            if not self.is_sqlite:
                # Every SQLite transaction reads one snapshot; PostgreSQL does so only at this
                # isolation level.
                session.connection(execution_options={"isolation_level": "REPEATABLE READ"})
            yield session

    @contextmanager
    def writing(self) -> Iterator[Session]:
        """Open a transaction that is committed at the end, or rolled back on an error.

        It cannot be nested.
        """
        with self.write_turn(), self._observed(), self._writer() as session:
            yield session
            self._commit(session)

    @contextmanager
    def write_turn(self) -> Iterator[None]:
        """On SQLite, block all other writers of this process for the duration of the block."""
        with self._write_lock if self.is_sqlite else nullcontext():
            yield

    @asynccontextmanager
    async def writing_async(self) -> AsyncIterator[Session]:
        """Open a writing transaction for a request without blocking the event loop.

        It is committed at the end, or rolled back if the block raises. Raises NotDurable if the
        write lock could not be acquired in time.
        """
        async with self._turn():
            with self._observed(), self._writer() as session:
                yield session
                await run_sync(self._commit, session)

    async def write(self, work: Callable[[Session], Result]) -> Result:
        """Run `work` in a writing transaction on one thread, which also waits and commits.

        For writes that arrive in large numbers. On SQLite those that wait for the same turn share
        one commit, and so one flush of the disk: each has a savepoint of its own, so one that
        raises is undone alone, and none returns before the commit is on disk. PostgreSQL flushes
        once for all transactions that commit at the same time, so there each has its own. `work`
        gets the session and must not wait for anything else; it is called again, by itself, if the
        database refused the shared transaction. Raises NotDurable if its turn does not come in
        time.
        """
        if not self.is_sqlite:
            return await run_sync(self._in_transaction, work, limiter=self._form_writers)
        waiting = Waiting(work, time.monotonic() + TURN_TIMEOUT_S)
        self._waiting.append(waiting)
        await asyncio.get_running_loop().run_in_executor(self._queue, self._write_until, waiting)
        if waiting.error is not None:
            raise waiting.error
        return cast("Result", waiting.result)

    def _write_until(self, last: Waiting) -> None:
        """Write what waits, in batches, until `last` is done; an earlier call may have done it."""
        while not last.done:
            first = self._waiting[0]
            try:
                self._take_turn(first.late_s - time.monotonic())
            except NotDurable as error:
                self._waiting.popleft()
                first.error, first.done = error, True
                continue
            try:
                self._write_batch()
            finally:
                self._write_lock.release()

    def _write_batch(self) -> None:
        """Write what waits by now that it is the turn of this thread."""
        batch = [self._waiting.popleft() for _ in range(min(len(self._waiting), MOST_TOGETHER))]
        try:
            if len(batch) == 1 or not self._written_together(batch):
                for one in batch:
                    self._write_alone(one)
        finally:
            for one in batch:
                one.done = True

    def _write_alone(self, one: Waiting) -> None:
        try:
            one.result, one.error = self._in_transaction(one.work), None
        except Exception as error:  # noqa: BLE001 - raised again where it is awaited
            one.error = error

    def _written_together(self, batch: Sequence[Waiting]) -> bool:
        """Commit a batch; return False, with nothing stored, if the database refused any of it.

        Many refusals, such as that of a full disk, end the whole transaction and not only the
        savepoint. Everything is then tried again one after the other, so that only those fail which
        have to, each with its own reason.
        """
        actions: list[Callable[[], None]] = []
        try:
            engine = self.engine.execution_options(reembody_writes=True)
            with engine.connect() as connection, connection.begin():
                for one in batch:
                    _run_at_savepoint(connection, one, actions)
                changes = has_changes(connection)
        except Exception:  # noqa: BLE001 - each is tried again alone, and then says why
            return False
        if changes:
            self._note_commit()
        for action in actions:
            action()
        return True

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
                "too many earlier requests are waiting to be stored; nothing was stored",
                value=f"waited {TURN_TIMEOUT_S:g} s",
                remedy="Try again in a moment.",
            )

    def _writer(self) -> Session:
        engine = self.engine.execution_options(reembody_writes=True)
        return Session(engine, expire_on_commit=False)

    def _commit(self, session: Session) -> None:
        session.flush()
        if not session.in_transaction():
            session.commit()
            return
        connection = session.connection()
        changes = has_changes(connection)
        try:
            session.commit()
        except DatabaseError:
            # SQLite may leave the transaction open, and the pool would lend it to the next request.
            connection.invalidate()
            raise
        # A commit without changes does not show whether the disk can be written.
        if changes:
            self._note_commit()

    def _note_commit(self) -> None:
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
        """Close the writing thread and every pooled connection."""
        self._queue.shutdown()
        self.engine.dispose()


def after_commit(db: Session, action: Callable[[], None]) -> None:
    """Run `action` once this transaction is on disk, or never if it is rolled back."""

    def run(session: Session) -> None:
        # SQLAlchemy also reports the release of a savepoint as a commit, yet nothing is on disk.
        if session.in_nested_transaction():
            return
        shared: list[Callable[[], None]] | None = session.info.get(ON_COMMIT)
        if shared is None:
            action()
        else:
            shared.append(action)

    event.listen(db, "after_commit", run)


def _run_at_savepoint(
    connection: Connection, one: Waiting, actions: list[Callable[[], None]]
) -> None:
    """Run one write of a batch, and undo it alone if it raises; raise only DatabaseError."""
    with Session(
        connection,
        expire_on_commit=False,
        join_transaction_mode="create_savepoint",
        info={ON_COMMIT: actions},
    ) as session:
        try:
            one.result = one.work(session)
            session.commit()
        except DatabaseError:
            raise
        except Exception as error:  # noqa: BLE001 - raised again where it is awaited
            session.rollback()
            one.error = error


def make_engine(url: str, *, pooled: bool = True) -> Engine:
    """Create an engine for `sqlite:///FILE` or `postgresql://...`, configured for durable commits.

    If not `pooled`, it opens a connection for every use. Statement parameters are kept out of error
    messages, which get into logs: they may be a participant's answers. Raises InvalidInput for any
    other address.
    """
    parsed = database_address(url)
    pool: dict[str, Any] = {} if pooled else {"poolclass": NullPool}
    if parsed.get_backend_name() != "sqlite":
        if pooled:
            # A connection beyond the pool's size is opened for one transaction and closed after it.
            pool = {
                "pool_size": WRITERS,
                "max_overflow": 10,
                "pool_pre_ping": True,
                "pool_use_lifo": True,
            }
        arguments = connect_arguments(parsed)
        return create_engine(parsed, hide_parameters=True, connect_args=arguments, **pool)
    if parsed.database:
        Path(parsed.database).parent.mkdir(parents=True, exist_ok=True)
        # An in-memory database has a single connection, hence no pool to size.
        # Reuse the most recently used connection first: each used connection has a cache of its
        # own.
        pool = pool or {"pool_size": 20, "max_overflow": 40, "pool_use_lifo": True}
    engine = create_engine(
        parsed,
        hide_parameters=True,
        connect_args={"timeout": BUSY_TIMEOUT_S, "check_same_thread": False},
        **pool,
    )
    event.listen(engine, "connect", prepare_connection)
    event.listen(engine, "begin", SqliteBegin())
    if pooled and parsed.database:
        keeper = LogKeeper(parsed.database)
        event.listen(engine, "connect", keeper.keep)
        event.listen(engine, "engine_disposed", keeper.release)
    return engine


def open_database(url: str, observer: WriteObserver | None = None) -> Database:
    """Open the database at `url` without changing its schema."""
    return Database(make_engine(url), observer)


def referenced_row(db: Session, kind: type[Row], key: str) -> Row:
    """Return the row that another row refers to, of a table whose rows are never deleted.

    Raises DamagedValue if it does not exist: foreign keys are enforced, so only damage can cause
    that. For a row that may have been deleted meanwhile, use `get` or `get_one` instead.
    """
    row = db.get(kind, key)
    if row is None:
        raise DamagedValue(f"{key!r} names no row of {kind.__name__}")
    return row
