"""The database of this installation, for commands that work beside the server or without it."""

from collections.abc import Iterator
from contextlib import contextmanager

from app.clock import Clock
from app.database import Database, open_database
from app.features.care.opening.service import prepare_database
from app.settings import Settings


@contextmanager
def opened_database() -> Iterator[Database]:
    """The database, brought up to date as a starting server does; closed behind the block.

    Raises ReembodyError for one that cannot be worked with, saying what to do.
    """
    settings = Settings()
    prepare_database(settings, Clock())
    database = open_database(settings.resolved_database_url)
    try:
        yield database
    finally:
        database.close()
