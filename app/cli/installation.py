"""Open this installation's database for commands that run with or without the server."""

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import select

from app.clock import Clock
from app.database import Database, open_database
from app.features.care.opening import prepare_database
from app.features.care.ownership import prepared_beside_owner
from app.models import Account
from app.settings import read_settings


@contextmanager
def opened_database(command: str) -> Iterator[Database]:
    """Open the database, migrated as a starting server does, and close it after the block.

    For a `command` that only reads, or adds rows of its own: a server may run meanwhile. Raises
    ReembodyError, with a remedy, if the database cannot be used.
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


def new_token(username: str, hours: float) -> str:
    """Issue a bearer token for an account; raise LookupError if there is no such account."""
    from app.features.people.accounts import issue_token  # only needed here

    with opened_database("token") as database, database.writing() as db:
        account = db.scalar(select(Account).where(Account.username == username))
        if account is None:
            names = db.scalars(select(Account.username).order_by(Account.username)).all()
            remedy = f"there are {', '.join(names)}" if names else "start the server for the first"
            raise LookupError(f"there is no account {username!r}; {remedy}")
        now = Clock().utc_now()
        return issue_token(db, account, purpose="script", now=now, hours=hours).token
