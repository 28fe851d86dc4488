"""What stands before every route: the name asked for, size limit, same-origin check, headers.

Cookies are SameSite=Strict already; the origin check is the second lock for requests that change
something, and the first for WebSockets, which no cookie rule of the browser covers.

The name is checked because no page of the internet may pass for this server: a hostile page can
make its own name lead to an address inside the lab (DNS rebinding), and the browser then takes this
server for that page's own. It cannot do so under a name that only a local network gives out, nor
under an address.
"""

from collections.abc import Callable, Iterable, Mapping
from ipaddress import ip_address
from types import MappingProxyType
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.errors import error_response
from app.errors import NotAllowed, ReembodyError, TooLarge

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
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
    """ASGI middleware around the whole application."""

    def __init__(
        self,
        app: ASGIApp,
        *,
        max_body_bytes: int,
        host_names: Callable[[], Iterable[str]],
        larger_bodies: Mapping[tuple[str, str], int] = MappingProxyType({}),
    ) -> None:
        """`larger_bodies` by method and path: routes that let people in before reading a body."""
        self._app = app
        self._max_body_bytes = max_body_bytes
        self._larger_bodies = larger_bodies
        self._host_names = host_names

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check, then pass on."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        try:
            self._check(scope, Headers(scope=scope))
        except ReembodyError as error:
            if scope["type"] == "websocket":
                await send({"type": "websocket.close", "code": 4403, "reason": error.message})
            else:
                await error_response(error)(scope, receive, _headed(scope, send))
            return
        if scope["type"] == "websocket":
            await self._app(scope, receive, send)
        else:
            await self._app(scope, _Limited(receive, self._limit(scope)), _headed(scope, send))

    def _check(self, scope: Scope, headers: Headers) -> None:
        require_known_host(headers.get("host", ""), self._host_names())
        declared = headers.get("content-length", "0")
        limit = self._limit(scope)
        if declared.isdigit() and int(declared) > limit:
            raise _too_large(int(declared), limit)
        if scope["type"] == "http" and scope["method"] in SAFE_METHODS:
            return
        site, origin = headers.get("sec-fetch-site"), headers.get("origin")
        foreign_site = site not in (None, "same-origin", "none")
        foreign_origin = origin is not None and urlsplit(origin).netloc != headers.get("host")
        if foreign_site or foreign_origin:
            raise NotAllowed(
                "this request comes from another site",
                value=origin,
                remedy="Open the page on the address of this server.",
            )

    def _limit(self, scope: Scope) -> int:
        route = (scope.get("method", ""), scope["path"])
        return self._larger_bodies.get(route, self._max_body_bytes)


class _Limited:
    """Counts a body that does not say its length."""

    def __init__(self, receive: Receive, limit: int) -> None:
        self._receive, self._limit, self._seen = receive, limit, 0

    async def __call__(self) -> Message:
        message = await self._receive()
        if message["type"] == "http.request":
            self._seen += len(message.get("body", b""))
            if self._seen > self._limit:
                raise _too_large(self._seen, self._limit)
        return message


def _too_large(size: int, limit: int) -> TooLarge:
    return TooLarge(
        "the request is too large",
        value=size,
        valid=f"at most {limit} bytes",
        remedy="Send less at once.",
    )


def _headed(scope: Scope, send: Send) -> Send:
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
    """Raise NotAllowed where a request asks for this server under a name of somebody else's.

    `host` is the Host header; `known` are the names that the lab gave to the server.
    """
    name = (urlsplit(f"//{host}").hostname or "").rstrip(".")
    if "." not in name or name.endswith(LOCAL_ENDINGS) or _is_address(name):
        return
    if name not in {one.lower() for one in known}:
        raise NotAllowed(
            "this server is not known by that name",
            value=host,
            valid="an address, a name of the local network, or one of REEMBODY_HOST_NAMES",
            remedy='Set REEMBODY_HOST_NAMES=["name.example.org"] where the lab gave it that name.',
        )


def _is_address(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True
