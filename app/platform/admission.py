"""Decide, before a request's body is read, whether its sender has a valid login or pairing.

A client without a valid token is a stranger: strangers share a budget per address and may send
little (`app.api.guards`). A request with a valid token is never counted, so a flood from the same
address (a lab often has one for all of its devices) does not block any paired tablet, headset or
login.

This authorises nothing: every route still checks the login or pairing itself. So a token that was
found valid may be treated as valid for another minute without a database query.
"""

from collections import OrderedDict
from dataclasses import dataclass, field
from itertools import chain

from anyio import CapacityLimiter
from anyio.to_thread import run_sync
from sqlalchemy import select
from sqlalchemy.exc import DBAPIError
from starlette.requests import HTTPConnection

from app.clock import Clock
from app.database import Database
from app.errors import NotSignedIn
from app.models import Device
from app.platform.tokens import account_of_token, hash_token, read_cookie

LOGIN_COOKIE = "reembody_login"
TABLET_COOKIE = "reembody_tablet"
BEARER_SUBPROTOCOL = "bearer."
VALID_FOR_S = 60.0
MOST_CACHED = 4096
CHECKING_THREADS = 2
"""Maximum number of threads that check tokens, so that a flood of them leaves others free."""
_TOKEN_LENGTH = 43
"""The length of `secrets.token_urlsafe(32)`; other tokens cannot be valid."""


def bearer_token(request: HTTPConnection) -> str | None:
    """Return the token of an `Authorization: Bearer` header, if there is one."""
    scheme, _, token = request.headers.get("authorization", "").partition(" ")
    return token.strip() if scheme.lower() == "bearer" and token else None


def tokens_of(connection: HTTPConnection) -> tuple[str, ...]:
    """Return every token that a request or a handshake presents, valid or not."""
    shown: list[str | None] = [bearer_token(connection)]
    if "cookie" in connection.headers:
        shown += [read_cookie(connection, LOGIN_COOKIE), read_cookie(connection, TABLET_COOKIE)]
    offered = connection.scope.get("subprotocols") or ()
    found = (
        name.removeprefix(BEARER_SUBPROTOCOL)
        for name in offered
        if name.startswith(BEARER_SUBPROTOCOL)
    )
    return tuple(token for token in chain(shown, found) if token)


@dataclass
class Admission:
    """Checks tokens, and caches those found valid within the last minute."""

    database: Database
    clock: Clock
    _valid_until_s: OrderedDict[str, float] = field(default_factory=OrderedDict)
    _checking: CapacityLimiter = field(default_factory=lambda: CapacityLimiter(CHECKING_THREADS))

    async def knows(self, tokens: tuple[str, ...]) -> bool:
        """Return whether one of the tokens belongs to a valid login or pairing."""
        for token in tokens[:4]:
            if len(token) == _TOKEN_LENGTH and await self._is_valid(token):
                return True
        return False

    async def _is_valid(self, token: str) -> bool:
        key, now_s = hash_token(token), self.clock.monotonic_ns() / 1e9
        until_s = self._valid_until_s.get(key)
        if until_s is not None and now_s < until_s:
            return True
        self._valid_until_s.pop(key, None)
        try:
            valid = await run_sync(self._opens_something, token, key, limiter=self._checking)
        except DBAPIError:
            # The route itself will report that the database is unavailable.
            return True
        if valid:
            self._valid_until_s[key] = now_s + VALID_FOR_S
            while len(self._valid_until_s) > MOST_CACHED:
                self._valid_until_s.popitem(last=False)
        return valid

    def _opens_something(self, token: str, key: str) -> bool:
        with self.database.reading() as db:
            try:
                account_of_token(db, token, self.clock.utc_now())
            except NotSignedIn:
                paired = select(Device.id).where(
                    Device.token_hash == key, Device.revoked_at.is_(None)
                )
                return db.scalar(paired.limit(1)) is not None
            return True
