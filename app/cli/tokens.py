"""Tokens for scripts."""

from sqlalchemy import select

from app.clock import Clock
from app.database import migrate, open_database
from app.features.accounts.service import issue_token
from app.models import Account
from app.settings import Settings


def new_token(username: str, hours: float) -> str:
    """A bearer token for an account of this installation; raises LookupError if there is none."""
    url = Settings().resolved_database_url
    migrate(url)
    database = open_database(url)
    try:
        with database.writing() as db:
            account = db.scalar(select(Account).where(Account.username == username))
            if account is None:
                raise LookupError(
                    f"there is no account {username!r}; start the server once to make the first"
                )
            now = Clock().utc_now()
            return issue_token(db, account, purpose="script", now=now, hours=hours).token
    finally:
        database.close()
