"""This installation, for commands that work beside the server or without it: database, tokens."""

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import select

from app.clock import Clock
from app.database import Database, open_database
from app.features.care.opening import prepare_database
from app.features.care.ownership import own_data, prepared_beside_owner
from app.models import Account
from app.settings import read_settings


@contextmanager
def opened_database(command: str) -> Iterator[Database]:
    """The database, brought up to date as a starting server does; closed behind the block.

    For a `command` that reads, or adds rows of its own: beside a running server, too. Raises
    ReembodyError for a database that cannot be worked with, saying what to do.
    """
    settings = read_settings()

    def prepare() -> None:
        prepare_database(settings, Clock())

    with prepared_beside_owner(settings, command, prepare):
        database = open_database(settings.resolved_database_url)
        try:
            yield database
        finally:
            database.close()


@contextmanager
def owned_database(command: str) -> Iterator[Database]:
    """The same for a `command` that changes what a running server knows: nobody else has the data
    meanwhile. Raises Owned where somebody has.
    """
    settings = read_settings()
    with own_data(settings, command):
        prepare_database(settings, Clock())
        database = open_database(settings.resolved_database_url)
        try:
            yield database
        finally:
            database.close()


def new_token(username: str, hours: float) -> str:
    """A bearer token for an account of this installation; raises LookupError if there is none."""
    from app.features.people.accounts import issue_token  # only tokens need accounts

    with opened_database("token") as database, database.writing() as db:
        account = db.scalar(select(Account).where(Account.username == username))
        if account is None:
            known = db.scalars(select(Account.username).order_by(Account.username)).all()
            way_on = f"there are {', '.join(known)}" if known else "start the server for the first"
            raise LookupError(f"there is no account {username!r}; {way_on}")
        now = Clock().utc_now()
        return issue_token(db, account, purpose="script", now=now, hours=hours).token
