"""Tokens for scripts."""

from sqlalchemy import select

from app.cli.installation import opened_database
from app.clock import Clock
from app.features.people.accounts.service import issue_token
from app.models import Account


def new_token(username: str, hours: float) -> str:
    """A bearer token for an account of this installation; raises LookupError if there is none."""
    with opened_database() as database, database.writing() as db:
        account = db.scalar(select(Account).where(Account.username == username))
        if account is None:
            raise LookupError(
                f"there is no account {username!r}; start the server once to make the first"
            )
        now = Clock().utc_now()
        return issue_token(db, account, purpose="script", now=now, hours=hours).token
