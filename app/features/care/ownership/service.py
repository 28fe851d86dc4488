"""Take ownership of the data, keep it, and allow some commands alongside an owner.

The data of an installation are the folder of its settings, the folder of its embedded database
(often the same one), and its PostgreSQL database. An owner holds the locks of all of them, and
takes them before anything in them is read or written.
"""

import logging
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Protocol, Self

from app.database import open_database
from app.errors import NotNow, ReembodyError
from app.features.care.ownership.database_lock import DatabaseLock
from app.features.care.ownership.folder_lock import FolderLock
from app.features.care.ownership.owner import SERVER, Owned, Owner
from app.platform.background import Background
from app.platform.context import Part
from app.platform.folders import database_file, home_of, require_one_name
from app.schema_revisions import newest_revision, revision_of
from app.settings import Settings

log = logging.getLogger(__name__)
WAIT_S = 5.0
"""How long to wait for a command that ends by itself."""
TRY_EVERY_S = 0.1
CHECK_EVERY_S = 1.0
OWNER = "owner"
"""The name of the watch among the background tasks."""


class _Lock(Protocol):
    def announce(self, owner: Owner) -> None: ...
    def is_held(self) -> bool: ...
    def take_again(self) -> None: ...
    def release(self) -> None: ...


class Ownership:
    """The locks of one owner, held until `release` or the end of the process."""

    def __init__(self, owner: Owner, locks: list[_Lock]) -> None:
        self.owner = owner
        self._locks = locks
        self._mutex = threading.Lock()

    def announce(self, port: int) -> None:
        """Add the server's port to the owner's description."""
        with self._mutex:
            self.owner = self.owner.at(port)
            for lock in self._locks:
                lock.announce(self.owner)

    def hold(self) -> bool:
        """Take lost locks again; return whether there were any.

        Raises Owned if another process has taken them, and NotDurable if they cannot be taken now.
        """
        with self._mutex:
            lost = [lock for lock in self._locks if not lock.is_held()]
            for lock in lost:
                lock.take_again()
            return bool(lost)

    def release(self) -> None:
        """Release all locks."""
        with self._mutex:
            while self._locks:
                self._locks.pop().release()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self.release()


def own_data(settings: Settings, command: str = SERVER, *, port: int | None = None) -> Ownership:
    """Become the owner of the data, before anything is done with them.

    Raises Owned, naming the current owner; if that is a command, which ends by itself, waits for a
    short time first. Raises NotDurable, InvalidInput or Conflict if data cannot be locked or are
    unusable.
    """
    owner, give_up_s = Owner.myself(command, port), time.monotonic() + WAIT_S
    while True:
        try:
            return Ownership(owner, _locks(settings, owner))
        except Owned as error:
            waits = error.owner is not None and error.owner.ends_by_itself
            if not waits or time.monotonic() > give_up_s:
                raise
            time.sleep(TRY_EVERY_S)


def _locks(settings: Settings, owner: Owner) -> list[_Lock]:
    """Take all locks or none, always in the same order, so that one of two processes gets them.

    Locks on folders have no effect on processes that open the database by another name, so it must
    have only one.
    """
    require_one_name(settings)
    folders = {settings.data_dir.resolve()}
    file = database_file(settings)
    if file is not None:
        # SQLite keeps its log beside the file itself, not beside a link to it.
        folders |= {home_of(settings).resolve(), file.resolve().parent}
    with ExitStack() as cleanup:
        acquired: list[_Lock] = []

        def keep(lock: _Lock) -> None:
            acquired.append(lock)
            cleanup.callback(lock.release)

        for folder in sorted(folders):
            keep(FolderLock(folder, owner))
        if settings.resolved_database_url.startswith("postgres"):
            keep(DatabaseLock(settings.resolved_database_url, owner))
        cleanup.pop_all()
        return acquired


@contextmanager
def prepared_beside_owner(
    settings: Settings, command: str, prepare: Callable[[], object]
) -> Iterator[None]:
    """Allow a command that reads, or adds rows in its own transactions, alongside an owner.

    Without an owner, the command owns the data while it prepares them (`prepare`), as a server
    does. If there is an owner, which has prepared them, it does not; it raises NotNow if the owner
    is still preparing them, or if the database is of another version.
    """
    try:
        own = own_data(settings, command)
    except Owned as error:
        _require_prepared(settings, error)
    else:
        with own:
            prepare()
    yield


def _require_prepared(settings: Settings, owned: Owned) -> None:
    file = database_file(settings)
    found = None
    if file is None or file.exists():
        database = open_database(settings.resolved_database_url)
        try:
            with database.reading() as db:
                found = revision_of(db.connection())
        finally:
            database.close()
    if found != newest_revision():
        raise NotNow(
            f"the database has the schema {found or 'of nobody yet'}, and {owned.owner} works "
            "with it",
            value=found,
            valid=newest_revision(),
            remedy="Try again in a moment; if this remains, it is another version of Reembody.",
        ) from owned


class OwnerWatch(Part):
    """A regular check that this server still owns the data, which takes lost locks again.

    If another process has taken them, `taken_over` is called: two servers on the same data are
    worse than none.
    """

    def __init__(
        self, own: Ownership, background: Background, taken_over: Callable[[], object]
    ) -> None:
        self._own, self._background, self._taken_over = own, background, taken_over
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Start the thread that checks the locks."""
        self._thread = self._background.thread(OWNER, self._watch, critical=True)

    def stop(self) -> None:
        """Stop checking the locks."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join(timeout=10.0)

    def _watch(self) -> None:
        while not self._stop.wait(CHECK_EVERY_S):
            self.look()

    def look(self) -> None:
        """Check the locks once, and take lost ones again."""
        try:
            lost = self._own.hold()
        except Owned as error:
            self._background.failed(OWNER, error)
            log.critical("%s; this server stops, so that only one uses them", error.message)
            self._taken_over()
            self._stop.set()
        except ReembodyError as error:
            # No other owner is known, so the next check tries again.
            self._background.failed(OWNER, error)
        else:
            if lost:
                log.warning("the lock on the data was lost, and was taken again")
            self._background.recovered(OWNER)
