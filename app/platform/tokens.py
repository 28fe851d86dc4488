"""Tokens: what proves who is calling.

A token is random and of 256 bits. The database keeps its SHA-256, so a stolen database opens
nothing, and every token can be revoked.
"""

import hashlib
from datetime import datetime

from sqlalchemy import bindparam, select
from sqlalchemy.orm import Session

from app.errors import NotSignedIn
from app.models import Account, Device, LoginToken

_BY_TOKEN = select(Device).where(Device.token_hash == bindparam("token_hash"))


def hash_token(token: str) -> str:
    """What is stored of a random token."""
    return hashlib.sha256(token.encode()).hexdigest()


def account_of_token(db: Session, token: str, now: datetime) -> Account:
    """Whose login this is; raises NotSignedIn when it is unknown, expired or revoked."""
    row = db.get(LoginToken, hash_token(token))
    if row is None or row.revoked_at is not None or row.expires_at <= now:
        raise NotSignedIn("the login has ended", remedy="Log in again.")
    account = db.get(Account, row.account_id)
    if account is None or account.disabled_at is not None:
        raise NotSignedIn("the account is closed", remedy="Ask the administrator of the lab.")
    return account


def device_of_token(db: Session, token: str, kind: str) -> Device:
    """The device that holds this token; raises NotSignedIn when it is unknown or was revoked."""
    device = db.scalar(_BY_TOKEN, {"token_hash": hash_token(token)})
    if device is None or device.kind != kind or device.revoked_at is not None:
        raise NotSignedIn(
            f"this {kind} is not paired any more", remedy="Enter a new code from the console."
        )
    return device
