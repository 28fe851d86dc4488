"""Taking the data, keeping hold of them, and working beside whoever owns them.

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
"""How long a command that ends by itself is waited for."""
TRY_EVERY_S = 0.1
LOOK_EVERY_S = 1.0
OWNER = "owner"
"""The name of the watch among what runs in the background."""


class _Lock(Protocol):
    def announce(self, owner: Owner) -> None: ...
    def is_held(self) -> bool: ...
    def take_again(self) -> None: ...
    def release(self) -> None: ...


class Ownership:
    """The locks of one owner; they end with `release`, or with the process."""

    def __init__(self, owner: Owner, locks: list[_Lock]) -> None:
        self.owner = owner
        self._locks = locks
        self._mutex = threading.Lock()

    def announce(self, port: int) -> None:
        """Say which port it is."""
        with self._mutex:
            self.owner = self.owner.at(port)
            for lock in self._locks:
                lock.announce(self.owner)

    def hold(self) -> bool:
        """Take again what was lost; whether anything was. Raises Owned where somebody else was
        quicker, and NotDurable where it cannot be had at the moment.
        """
        with self._mutex:
            lost = [lock for lock in self._locks if not lock.is_held()]
            for lock in lost:
                lock.take_again()
            return bool(lost)

    def release(self) -> None:
        """Let go of everything."""
        with self._mutex:
            while self._locks:
                self._locks.pop().release()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self.release()


def own_data(settings: Settings, command: str = SERVER, *, port: int | None = None) -> Ownership:
    """Become the owner of the data, before anything is done with them.

    Raises Owned, naming the owner there is; a command, which ends by itself, is waited for a
    little. Raises NotDurable, InvalidInput or Conflict where data cannot be locked or could not be
    worked with at all.
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
    """All locks or none, always in the same order: of two that start, one gets them.

    They are locks on folders, which hold nobody off who has the database by another name.
    """
    require_one_name(settings)
    folders = {settings.data_dir.resolve()}
    file = database_file(settings)
    if file is not None:
        # SQLite keeps its log beside the file itself, wherever a link to it stands.
        folders |= {home_of(settings).resolve(), file.resolve().parent}
    with ExitStack() as otherwise:
        taken: list[_Lock] = []

        def keep(lock: _Lock) -> None:
            taken.append(lock)
            otherwise.callback(lock.release)

        for folder in sorted(folders):
            keep(FolderLock(folder, owner))
        if settings.resolved_database_url.startswith("postgres"):
            keep(DatabaseLock(settings.resolved_database_url, owner))
        otherwise.pop_all()
        return taken


@contextmanager
def prepared_beside_owner(
    settings: Settings, command: str, prepare: Callable[[], object]
) -> Iterator[None]:
    """For a command that reads, or adds rows in transactions of its own.

    Without an owner the data are its own while it prepares them (`prepare`), as a server would.
    Beside an owner, who has done that, nothing is prepared; raises NotNow while the owner is still
    at it, or where the database is not that of this version.
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
            remedy="Try again in a moment; if it stays, that is another version of Reembody.",
        ) from owned


class OwnerWatch(Part):
    """Looks now and then whether the data are still ours, and takes them again where it can.

    Where somebody else has them, `taken_over` is called: two servers on the same data are worse
    than none.
    """

    def __init__(
        self, own: Ownership, background: Background, taken_over: Callable[[], object]
    ) -> None:
        self._own, self._background, self._taken_over = own, background, taken_over
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Begin to look."""
        self._thread = self._background.thread(OWNER, self._watch, critical=True)

    def stop(self) -> None:
        """Look no more."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join(timeout=10.0)

    def _watch(self) -> None:
        while not self._stop.wait(LOOK_EVERY_S):
            self.look()

    def look(self) -> None:
        """Once."""
        try:
            lost = self._own.hold()
        except Owned as error:
            self._background.failed(OWNER, error)
            log.critical("%s; this server ends, so that only one works with them", error.message)
            self._taken_over()
            self._stop.set()
        except ReembodyError as error:
            # Nobody else has them, as far as anybody can tell: tried again at the next look.
            self._background.failed(OWNER, error)
        else:
            if lost:
                log.warning("the lock on the data was lost, and was taken again")
            self._background.well(OWNER)
