"""Create accounts, verify passwords, and issue and revoke login tokens.

Passwords are argon2id hashes. A login is a random token (app.platform.tokens).
"""

import re
import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import func, select, update
from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotSignedIn
from app.features.people.accounts.passwords import hash_password, is_password
from app.models import Account, LoginToken
from app.platform.tokens import hash_token

_USERNAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,79}")


@dataclass(frozen=True)
class Login:
    """A new login with its token, which is available in plain text only here."""

    account: Account
    token: str
    expires_at: datetime


def create_account(
    db: Session, *, username: str, password: str, role: str, now: datetime
) -> Account:
    """Create an account that sees all studies; raises InvalidInput for a taken or invalid name."""
    return add_account(db, username=username, hashed=hash_password(password), role=role, now=now)


def add_account(db: Session, *, username: str, hashed: str, role: str, now: datetime) -> Account:
    """Create an account from a password hash; raises InvalidInput for a taken or invalid name.

    Hashing a password takes too long to be done inside a transaction, so it is done beforehand.
    """
    if not is_username(username):
        raise InvalidInput(
            f"{username!r} cannot be a user name",
            value=username,
            valid="1 to 80 letters, digits, dots, - and _, beginning with a letter or digit",
            remedy="Choose another.",
        )
    # Two names that differ only in upper and lower case would be mistaken for each other.
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
    """Return whether `name` is a valid user name."""
    return _USERNAME.fullmatch(name) is not None


def ensure_admin(db: Session, *, password: str | None, now: datetime) -> str | None:
    """Create the account `admin` if there are no accounts at all.

    Returns the random password, to be printed, if one was generated.
    """
    if db.scalar(select(Account).limit(1)):
        return None
    chosen = password or secrets.token_urlsafe(12)
    create_account(db, username="admin", password=chosen, role="admin", now=now)
    return None if password else chosen


def account_named(db: Session, username: str) -> Account | None:
    """Return the account with this user name, unless it is closed."""
    return db.scalar(
        select(Account).where(Account.username == username, Account.disabled_at.is_(None))
    )


def require_password(account: Account | None, password: str) -> Account:
    """Return the account if the password is correct; otherwise raise NotSignedIn.

    The error does not reveal whether the name or the password was wrong. Verifying is slow on
    purpose, so do not call this inside a transaction. Raises Busy.
    """
    if not is_password(account.password_hash if account else None, password) or account is None:
        raise NotSignedIn(
            "user name and password do not match",
            remedy="Check both. The admin's password was printed in the terminal at the first "
            "start.",
        )
    return account


def issue_token(
    db: Session, account: Account, *, purpose: str, now: datetime, hours: float
) -> Login:
    """Issue a login token for an account; `purpose` is one of `PURPOSES`."""
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
    """End the login that has this token; unknown tokens are ignored."""
    row = db.get(LoginToken, hash_token(token))
    if row is not None and row.revoked_at is None:
        row.revoked_at = now


def revoke_purpose(db: Session, purpose: str, now: datetime) -> None:
    """End all logins of a purpose, such as those of processes that ended with the server."""
    unended = LoginToken.revoked_at.is_(None)
    db.execute(
        update(LoginToken)
        .where(LoginToken.purpose == purpose, unended)
        .values(revoked_at=now)
        .execution_options(synchronize_session=False)
    )


def is_active(db: Session, token: str) -> bool:
    """Return whether this token belongs to a login that has not been revoked."""
    row = db.get(LoginToken, hash_token(token))
    return row is not None and row.revoked_at is None
