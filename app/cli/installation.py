"""This installation, for commands that work beside the server or without it: database, tokens."""

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import select

from app.clock import Clock
from app.database import Database, open_database
from app.features.care.opening import prepare_database
from app.models import Account
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


def new_token(username: str, hours: float) -> str:
    """A bearer token for an account of this installation; raises LookupError if there is none."""
    from app.features.people.accounts import issue_token  # only tokens need accounts

    with opened_database() as database, database.writing() as db:
        account = db.scalar(select(Account).where(Account.username == username))
        if account is None:
            raise LookupError(
                f"there is no account {username!r}; start the server once to make the first"
            )
        now = Clock().utc_now()
        return issue_token(db, account, purpose="script", now=now, hours=hours).token
