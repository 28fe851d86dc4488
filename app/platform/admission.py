"""Whether a request comes from somebody the lab knows, before anything of its body is read.

Whoever shows no token that opens something is a stranger: strangers share a budget per address and
may send little (`app.api.guards`). A valid token is never counted, so a flood from the same address
(a lab often has one for all of its devices) refuses no paired tablet, headset or login.

This lets nobody in: every route still asks for the login or pairing itself. So a token that was
found valid may be taken for known for a minute longer, without a look into the database.
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
KNOWN_FOR_S = 60.0
MOST_KNOWN = 4096
LOOKS_AT_ONCE = 2
"""A flood of invented tokens takes this many threads and leaves the others to those who are in."""
_TOKEN_LENGTH = 43
"""Of `secrets.token_urlsafe(32)`; nothing else is worth a look."""


def bearer_token(request: HTTPConnection) -> str | None:
    """The token of an `Authorization: Bearer` header, if there is one."""
    scheme, _, token = request.headers.get("authorization", "").partition(" ")
    return token.strip() if scheme.lower() == "bearer" and token else None


def tokens_of(connection: HTTPConnection) -> tuple[str, ...]:
    """Every token that a request or a handshake shows, valid or not."""
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
    """Knows the tokens that opened something within the last minute."""

    database: Database
    clock: Clock
    _known: OrderedDict[str, float] = field(default_factory=OrderedDict)
    _looking: CapacityLimiter = field(default_factory=lambda: CapacityLimiter(LOOKS_AT_ONCE))

    async def knows(self, tokens: tuple[str, ...]) -> bool:
        """Whether one of them opens something."""
        for token in tokens[:4]:
            if len(token) == _TOKEN_LENGTH and await self._is_valid(token):
                return True
        return False

    async def _is_valid(self, token: str) -> bool:
        key, now_s = hash_token(token), self.clock.monotonic_ns() / 1e9
        until_s = self._known.get(key)
        if until_s is not None and now_s < until_s:
            return True
        self._known.pop(key, None)
        try:
            valid = await run_sync(self._opens_something, token, key, limiter=self._looking)
        except DBAPIError:
            # The route will say that the database cannot answer.
            return True
        if valid:
            self._known[key] = now_s + KNOWN_FOR_S
            while len(self._known) > MOST_KNOWN:
                self._known.popitem(last=False)
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
