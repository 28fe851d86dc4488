"""What commands share that load and store avatar configurations in the lab's database."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from pydantic import TypeAdapter, ValidationError
from sqlalchemy.exc import OperationalError
from sqlalchemy.orm import Session

from app.cli.installation import opened_database
from app.clock import Clock
from app.database import Database
from app.errors import NotNow
from app.features.movement.avatar import (
    SHIPPED,
    AvatarKey,
    AvatarTitle,
    Note,
    add_shipped_avatar,
    newest_numbers,
)
from app.features.movement.humanoids import add_shipped_bodies
from app.platform.trouble import LOCKED, explain

T = TypeVar("T")
WAIT_S = 20.0
"""How long a command waits for the database while others write to it."""
_KEY: TypeAdapter[str] = TypeAdapter(AvatarKey)
_TITLE: TypeAdapter[str] = TypeAdapter(AvatarTitle)
_NOTE: TypeAdapter[str] = TypeAdapter(Note)


def check_key(option: str, key: str) -> None:
    """Raise ValueError for an invalid key, so that it is reported before any work."""
    try:
        _KEY.validate_python(key)
    except ValidationError:
        raise ValueError(
            f"{option} {key!r}: a key begins with a lower-case letter and has lower-case letters,"
            " digits, - and _, 80 at most"
        ) from None


def check_words(title: str | None, note: str) -> None:
    """Raise ValueError for a title or a note that cannot be stored, before any work."""
    for option, words, adapter in (("--title", title or "-", _TITLE), ("--note", note, _NOTE)):
        try:
            adapter.validate_python(words)
        except ValidationError as error:
            said = error.errors(include_url=False)[0]["msg"].removeprefix("Value error, ")
            raise ValueError(f"{option} {words[:60]!r}: {said}") from None


@contextmanager
def lab_database(command: str) -> Iterator[Database]:
    """Open the lab's database for a command, with what is shipped; a server may run meanwhile.

    A version of an avatar is only ever added, so a server needs no notice of it.
    """
    with opened_database(command) as database:
        with database.reading() as db:
            shipped = SHIPPED in newest_numbers(db)
        if not shipped:  # no server was started with this database yet
            written(database, _add_shipped)
        yield database


def written(database: Database, work: Callable[[Session], T], *, wait_s: float = WAIT_S) -> T:
    """Run `work` in a transaction of its own, again while another process holds the database.

    Raises NotNow if that takes longer than `wait_s`; then nothing was stored.
    """
    give_up_s = time.monotonic() + wait_s
    while True:
        try:
            with database.writing() as db:
                return work(db)
        except OperationalError as error:
            if explain(error) is not LOCKED:
                raise
            if time.monotonic() > give_up_s:
                raise NotNow(
                    f"another program has been writing to the database for {wait_s:g} s, so "
                    "nothing was stored",
                    remedy="Try again. If this remains, close what has the file open (a viewer, a "
                    "backup, a file sync), or store it through the server with --url and --token.",
                ) from error


def _add_shipped(db: Session) -> None:
    add_shipped_bodies(db, Clock().utc_now())
    add_shipped_avatar(db, Clock().utc_now())
