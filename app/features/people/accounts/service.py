"""Logging in, and knowing who asks.

Passwords are argon2id hashes. A login is a random token (app.platform.tokens).
"""

import re
import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotSignedIn
from app.features.people.accounts.passwords import hash_password, is_password
from app.models import Account, LoginToken
from app.platform.tokens import hash_token

_USERNAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,79}")


@dataclass(frozen=True)
class Login:
    """A fresh login: the token leaves here once, in clear."""

    account: Account
    token: str
    expires_at: datetime


def create_account(
    db: Session, *, username: str, password: str, role: str, now: datetime
) -> Account:
    """Add an account that sees all studies; InvalidInput if the name is taken or unusable."""
    return add_account(db, username=username, hashed=hash_password(password), role=role, now=now)


def add_account(db: Session, *, username: str, hashed: str, role: str, now: datetime) -> Account:
    """The same with a password that was hashed before: hashing takes too long for a transaction."""
    if not is_username(username):
        raise InvalidInput(
            f"{username!r} cannot be a user name",
            value=username,
            valid="1 to 80 letters, digits, dots, - and _, beginning with a letter or digit",
            remedy="Choose another.",
        )
    # Two names that differ in capitals only would be mistaken for each other.
    if db.scalar(select(Account).where(func.lower(Account.username) == username.lower())):
        raise InvalidInput(
            f"the user name {username!r} is taken", value=username, remedy="Choose another."
        )
    account = Account(
        username=username,
        role=role,
        all_studies=True,
        password_hash=hashed,
        created_at=now,
    )
    db.add(account)
    db.flush()
    return account


def is_username(name: str) -> bool:
    """Whether an account may have this name."""
    return _USERNAME.fullmatch(name) is not None


def ensure_admin(db: Session, *, password: str | None, now: datetime) -> str | None:
    """Make the first account where there is none; the random password to print, if one was made."""
    if db.scalar(select(Account).limit(1)):
        return None
    chosen = password or secrets.token_urlsafe(12)
    create_account(db, username="admin", password=chosen, role="admin", now=now)
    return None if password else chosen


def account_named(db: Session, username: str) -> Account | None:
    """The account that can be logged in to by this name."""
    return db.scalar(
        select(Account).where(Account.username == username, Account.disabled_at.is_(None))
    )


def require_password(account: Account | None, password: str) -> Account:
    """The account, if the password is its own; the same NotSignedIn whatever was wrong.

    Takes a while on purpose, so it is not to be called inside a transaction. Raises Busy.
    """
    if not is_password(account.password_hash if account else None, password) or account is None:
        raise NotSignedIn(
            "user name and password do not match",
            remedy="Check both; the first start printed the admin's password in its terminal.",
        )
    return account


def issue_token(
    db: Session, account: Account, *, purpose: str, now: datetime, hours: float
) -> Login:
    """A new token for an account; `purpose` is browser or script."""
    token = secrets.token_urlsafe(32)
    expires_at = now + timedelta(hours=hours)
    db.add(
        LoginToken(
            token_hash=hash_token(token),
            account_id=account.id,
            purpose=purpose,
            created_at=now,
            expires_at=expires_at,
        )
    )
    db.flush()
    return Login(account, token, expires_at)


def revoke_token(db: Session, token: str, now: datetime) -> None:
    """End a login; unknown tokens are ignored."""
    row = db.get(LoginToken, hash_token(token))
    if row is not None and row.revoked_at is None:
        row.revoked_at = now


def is_alive(db: Session, token: str) -> bool:
    """Whether this is a login that was not ended yet."""
    row = db.get(LoginToken, hash_token(token))
    return row is not None and row.revoked_at is None
