"""Check every request before its route: size, host name, origin, text; add security headers.

For a stranger only a few kilobytes of a body are read, and strangers share a budget per address; a
client with a valid token has neither limit (`app.platform.admission`). Text that no database can
store is rejected here, once for every route (`app.platform.text`).

Cookies are SameSite=Strict already; the origin check is a second protection for requests that
change something, and the first for WebSockets, which no cookie rule of the browser covers.

The host name is checked so that no page on the internet can reach this server as its own: a hostile
page can make its own name resolve to an address inside the lab (DNS rebinding), and the browser
then takes this server for that page's own. It cannot do so under a name that only a local network
assigns, nor under an IP address.
"""

import asyncio
from collections.abc import Callable, Iterable, Mapping
from ipaddress import ip_address
from types import MappingProxyType
from urllib.parse import urlsplit

from anyio.to_thread import run_sync
from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import ClientDisconnect, HTTPConnection
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.errors import error_response
from app.errors import (
    InvalidInput,
    NotAllowed,
    NotSignedIn,
    ReembodyError,
    TooLarge,
    TooManyAttempts,
)
from app.lan import STRANGER
from app.platform.admission import Admission, tokens_of
from app.platform.rate_limit import Budget, network_of
from app.platform.text import require_text_in_head, require_text_in_json

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
STRANGERS_BODY_BYTES = 16 * 1024
"""Maximum size of a stranger's body; a login, pairing or invitation takes a few hundred."""
SOCKET_COST = 10.0
"""Cost of a stranger's socket: it is closed immediately, but may have sent a message."""
DELAY_S, MOST_DELAYED = 1.0, 512
"""Delay of refused requests, and how many may be delayed; each may keep 64 KiB of its body."""
TOO_LARGE_COST = 10.0
LARGE_BODY_BYTES = 64 * 1024
"""Larger bodies are searched for invalid characters in a thread."""
# No Strict-Transport-Security: a browser applies it to every port of a host and, once it has seen
# it, lets nobody past a certificate that it does not trust. A device would then lose the help page,
# which must be plain http, and a headset by USB cable its http://localhost.
SECURITY_HEADERS: Mapping[str, str] = {
    "content-security-policy": (
        "default-src 'self'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
        "img-src 'self' data: blob:; font-src 'self' data:; connect-src 'self'; "
        "worker-src 'self' blob:; object-src 'none'; base-uri 'none'; form-action 'self'; "
        "frame-ancestors 'none'"
    ),
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
}
LOCAL_ENDINGS = (".local", ".localhost", ".lan", ".home.arpa", ".internal")


class Guards:
    """The ASGI middleware that checks every request to the application."""

    def __init__(
        self,
        app: ASGIApp,
        *,
        admission: Admission,
        strangers: Budget,
        max_body_bytes: int,
        host_names: Callable[[], Iterable[str]],
        larger_bodies: Mapping[tuple[str, str], int] = MappingProxyType({}),
    ) -> None:
        """Set the limits; `larger_bodies` has those of some routes, by method and path.

        These routes read their bodies themselves, in pieces, after they have authorised the caller.
        """
        self._app = app
        self._admission, self._strangers = admission, strangers
        self._max_body_bytes = max_body_bytes
        self._larger_bodies = larger_bodies
        self._host_names = host_names
        self._delayed = 0
        self._turnstile = asyncio.Lock()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check a request, then pass it on to the application."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        send = _headed(scope, send)
        try:
            known = await self._has_valid_token(scope)
            headers = Headers(scope=scope)
            self._check(scope, headers)
            if scope["type"] == "http":
                receive = await self._read(scope, headers, receive, known=known)
        except ClientDisconnect:
            return
        except ReembodyError as error:
            if isinstance(error, TooManyAttempts):
                await self._delay()
            await _refuse(scope, receive, send, error)
            return
        await self._app(scope, receive, send)

    async def _delay(self) -> None:
        """Delay the response to a stranger who sends too many requests, at next to no cost.

        A client that retries as soon as it gets a response then does so once a second, and not as
        fast as this machine can refuse. No more of a body is read meanwhile.
        """
        if self._delayed >= MOST_DELAYED:
            return
        self._delayed += 1
        try:
            await asyncio.sleep(DELAY_S)
        finally:
            self._delayed -= 1

    async def _has_valid_token(self, scope: Scope) -> bool:
        """Return whether a valid token was presented; otherwise charge the stranger's budget.

        A token counts only after the database has confirmed it: otherwise anybody could pose as a
        device. Raises TooManyAttempts if the budget is spent.
        """
        connection = HTTPConnection(scope)
        tokens = tokens_of(connection)
        if tokens and await self._admission.knows(tokens):
            return True
        scope[STRANGER] = True
        # One at a time, with a turn of the event loop for each: messages of headsets and tablets
        # are processed between any two strangers, not after a whole crowd of them.
        async with self._turnstile:
            await asyncio.sleep(0)
        self._strangers.spend(_network(scope), SOCKET_COST if scope["type"] == "websocket" else 1.0)
        return False

    def _check(self, scope: Scope, headers: Headers) -> None:
        require_text_in_head(
            scope.get("raw_path") or b"", scope.get("query_string", b""), scope["headers"]
        )
        require_known_host(headers.get("host", ""), self._host_names())
        if scope["type"] == "http" and scope["method"] in SAFE_METHODS:
            return
        site, origin = headers.get("sec-fetch-site"), headers.get("origin")
        foreign_site = site not in (None, "same-origin", "none")
        foreign_origin = origin is not None and _netloc(origin) != headers.get("host")
        if foreign_site or foreign_origin:
            raise NotAllowed(
                "this request comes from another site",
                value=origin,
                remedy="Open the page at the address of this server.",
            )

    async def _read(
        self, scope: Scope, headers: Headers, receive: Receive, *, known: bool
    ) -> Receive:
        """Return the receiver of the body; raise TooLarge if the body is larger than allowed."""
        declared = headers.get("content-length", "")
        if declared in ("", "0") and "transfer-encoding" not in headers:
            return receive
        route = (scope["method"], scope["path"])
        limit = self._larger_bodies.get(route, self._max_body_bytes)
        if not known:
            limit = min(limit, STRANGERS_BODY_BYTES)
        try:
            if declared.isdigit() and int(declared[:20]) > limit:
                raise _too_large(int(declared[:20]), limit)
            if route in self._larger_bodies:
                return _Limited(receive, limit)
            body = await _whole(receive, limit)
        except TooLarge as error:
            if not known:
                # Part of it was read, and the response may be delayed.
                self._strangers.charge(_network(scope), TOO_LARGE_COST)
            if not known and tokens_of(HTTPConnection(scope)):
                # Somebody whose login has expired needs to know that, not that they sent too much.
                raise NotSignedIn(
                    "the login or the pairing has ended", remedy="Sign in again."
                ) from error
            raise
        if len(body) > LARGE_BODY_BYTES:
            await run_sync(require_text_in_json, body)
        else:
            require_text_in_json(body)
        return _Replayed(body, receive)


def _network(scope: Scope) -> str:
    client = scope.get("client")
    return network_of(client[0] if client else None)


async def _whole(receive: Receive, limit: int) -> bytes:
    """Read the body; raise TooLarge beyond `limit`, ClientDisconnect if the client disconnects."""
    pieces, size, more = [], 0, True
    while more:
        message = await receive()
        if message["type"] == "http.disconnect":
            raise ClientDisconnect
        piece = message.get("body", b"")
        pieces.append(piece)
        size, more = size + len(piece), message.get("more_body", False)
        if size > limit:
            raise _too_large(size, limit)
    return b"".join(pieces)


class _Replayed:
    """Passes on a body that was already read, then the messages that follow it."""

    def __init__(self, body: bytes, receive: Receive) -> None:
        self._body: bytes | None = body
        self._receive = receive

    async def __call__(self) -> Message:
        if self._body is None:
            return await self._receive()
        body, self._body = self._body, None
        return {"type": "http.request", "body": body, "more_body": False}


class _Limited:
    """Limits the size of a body that does not declare its length."""

    def __init__(self, receive: Receive, limit: int) -> None:
        self._receive, self._limit, self._seen = receive, limit, 0

    async def __call__(self) -> Message:
        message = await self._receive()
        if message["type"] == "http.request":
            self._seen += len(message.get("body", b""))
            if self._seen > self._limit:
                raise _too_large(self._seen, self._limit)
        return message


async def _refuse(scope: Scope, receive: Receive, send: Send, error: ReembodyError) -> None:
    response = error_response(error)
    if scope["type"] == "http":
        await response(scope, receive, send)
    elif isinstance(error, TooManyAttempts) and "websocket.http.response" in scope.get(
        "extensions", {}
    ):
        # Before the handshake is accepted: opening the socket first would cost more.
        await response(scope, receive, send)
    else:
        await send({"type": "websocket.close", "code": 4403, "reason": error.message[:100]})


def _too_large(size: int, limit: int) -> TooLarge:
    return TooLarge(
        f"this is too large: {_readable(size)}; at most {_readable(limit)} are accepted",
        value=size,
        valid=f"at most {limit} bytes",
        remedy="Choose a smaller file, or send less in one request.",
    )


def _readable(size: int) -> str:
    return f"{size / 2**20:,.1f} MiB" if size >= 2**20 else f"{size / 2**10:,.0f} KiB"


def _headed(scope: Scope, send: Send) -> Send:
    if scope["type"] == "websocket":
        return send

    async def send_with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in SECURITY_HEADERS.items():
                headers.setdefault(name, value)
            if scope["path"].startswith("/api/"):
                headers.setdefault("cache-control", "no-store")
        await send(message)

    return send_with_headers


def require_known_host(host: str, known: Iterable[str]) -> None:
    """Raise NotAllowed if a request uses a host name that does not belong to this server.

    `host` is the Host header; `known` are the names that the lab gave to the server.
    """
    try:
        name = (urlsplit(f"//{host}").hostname or "").rstrip(".")
    except ValueError as error:
        raise InvalidInput("the header Host is not a host name", value=host[:100]) from error
    if "." not in name or name.endswith(LOCAL_ENDINGS) or _is_address(name):
        return
    if name not in {one.lower() for one in known}:
        raise NotAllowed(
            "this server does not answer to that host name",
            value=host,
            valid="an address, a name of the local network, or one of REEMBODY_HOST_NAMES",
            remedy="If the lab gave the server that name, set "
            'REEMBODY_HOST_NAMES=["name.example.org"].',
        )


def _netloc(origin: str) -> str | None:
    try:
        return urlsplit(origin).netloc
    except ValueError:
        return None


def _is_address(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True
