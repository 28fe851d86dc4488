"""Tokens, which prove who is calling, and the cookies that store one in a browser.

A token is 256 random bits. The database stores its SHA-256, so a stolen database gives no access,
and every token can be revoked.

A cookie is inaccessible to scripts, other sites and other hosts. Over https its name begins with
`__Host-`: the browser then accepts the cookie only if it is Secure, for this host alone and for
every path, so nobody who controls plain http or a neighbouring name can plant one. Over http (this
machine, a USB cable) that prefix is not allowed and the name is plain. Only the cookie name that
belongs to a request's own scheme is read.
"""

import hashlib
from datetime import datetime

from sqlalchemy import bindparam, select
from sqlalchemy.orm import Session, aliased
from starlette.requests import HTTPConnection, Request
from starlette.responses import Response

from app.errors import NotSignedIn, Withdrawn
from app.models import Account, Device, Erasure, LoginToken, StudySession

_BY_TOKEN = select(Device).where(Device.token_hash == bindparam("token_hash"))
HOST_ONLY = "__Host-"


def hash_token(token: str) -> str:
    """Return the hash that is stored in place of a random token."""
    return hashlib.sha256(token.encode()).hexdigest()


def account_of_token(db: Session, token: str, now: datetime) -> Account:
    """Return the account of a login; raise NotSignedIn if it is unknown, expired or revoked."""
    return login_of_token(db, token, now)[1]


def login_of_token(db: Session, token: str, now: datetime) -> tuple[LoginToken, Account]:
    """Return a login and its account; raise NotSignedIn as `account_of_token` does."""
    row = db.get(LoginToken, hash_token(token))
    if row is None or row.revoked_at is not None or row.expires_at <= now:
        raise NotSignedIn("your sign-in has ended", remedy="Sign in again.")
    account = db.get(Account, row.account_id)
    if account is None or account.disabled_at is not None:
        raise NotSignedIn("the account is closed", remedy="Ask the administrator of the lab.")
    return row, account


def device_of_token(db: Session, token: str, kind: str) -> Device:
    """Return the device with this token.

    Raises Withdrawn if the data of its session were erased, so that the device deletes what it
    still has of them; NotSignedIn if it is unknown or was revoked.
    """
    device = db.scalar(_BY_TOKEN, {"token_hash": hash_token(token)})
    if device is not None and device.revoked_at is not None and _is_erased(db, device):
        raise Withdrawn(
            "the data of this session were erased: nothing more of it is stored",
            remedy="Discard what this device still has of it.",
        )
    if device is None or device.kind != kind or device.revoked_at is not None:
        raise NotSignedIn(
            f"this {kind} is no longer paired",
            remedy="Ask the experimenter for a new code, and enter it here.",
        )
    return device


def _is_erased(db: Session, device: Device) -> bool:
    session, erasure = aliased(StudySession), aliased(Erasure)
    query = (
        select(erasure.id)
        .join(session, session.participant_id == erasure.participant_id)
        .where(session.id == device.session_id)
    )
    return db.scalar(query.limit(1)) is not None


def cookie_name(request: HTTPConnection, name: str) -> str:
    """Return the full name of the cookie `name` under the scheme of `request`."""
    return f"{HOST_ONLY}{name}" if _is_secure(request) else name


def read_cookie(request: HTTPConnection, name: str) -> str | None:
    """Return the token in the cookie `name`; None if there is no such cookie."""
    return request.cookies.get(cookie_name(request, name))


def set_cookie(request: Request, response: Response, name: str, token: str, age_s: int) -> None:
    """Store a token in the browser's cookie `name` for `age_s`."""
    response.set_cookie(
        cookie_name(request, name),
        token,
        max_age=age_s,
        path="/",
        httponly=True,
        samesite="strict",
        secure=_is_secure(request),
    )


def delete_cookie(request: Request, response: Response, name: str) -> None:
    """Delete the browser's cookie `name`; browsers do so only if all attributes match."""
    response.delete_cookie(
        cookie_name(request, name),
        path="/",
        httponly=True,
        samesite="strict",
        secure=_is_secure(request),
    )


def _is_secure(request: HTTPConnection) -> bool:
    # The whole address would be put together first for `request.url`, several times a request.
    return request.scope.get("scheme") in ("https", "wss")
