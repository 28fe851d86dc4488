"""Answer the most frequent calls ahead of the framework's own machinery.

For a call of a few milliseconds, finding the route, resolving dependencies and validating the
answer again take longer than the work itself. A direct route stands before the declared route of
the same address and answers what is in order; everything else it leaves to the declared one, which
then refuses it as it refuses any request. So errors, and the description of the interface, have one
place.
"""

from collections.abc import Awaitable, Callable

from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import BaseRoute, Match
from starlette.types import Message, Receive, Scope, Send

LEFT_TO_DECLARED = "reembody_left_to_declared"
JSON = "application/json"
Answer = Callable[[Request], Awaitable[Response | None]]
"""Answers a request, or returns None to leave it to the declared route."""


class DirectRoute(BaseRoute):
    """One method at one address without parameters."""

    def __init__(self, method: str, path: str, answer: Answer) -> None:
        self.method, self.path = method, path
        self._answer = answer

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        """Match the exact address, unless the request was left to the declared route."""
        if (
            scope["type"] != "http"
            or scope["path"] != self.path
            or scope["method"] != self.method
            or LEFT_TO_DECLARED in scope
        ):
            return Match.NONE, {}
        return Match.FULL, {"endpoint": self._answer, "path_params": {}, "route": self}

    async def handle(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer the request, or route it again past this route."""
        request = Request(scope, receive, send)
        response = await self._answer(request)
        if response is not None:
            await response(scope, receive, send)
            return
        body = await request.body()
        scope[LEFT_TO_DECLARED] = True
        await scope["router"](scope, _from_start(body, receive), send)


def _from_start(body: bytes, receive: Receive) -> Receive:
    """Return a receiver that passes on a body which was already read, then what follows it."""
    unread = [body]

    async def again() -> Message:
        if unread:
            return {"type": "http.request", "body": unread.pop(), "more_body": False}
        return await receive()

    return again


def is_json(request: Request) -> bool:
    """Return whether the body is declared as JSON, in the usual spelling."""
    return request.headers.get("content-type") == JSON


def json_response(text: str) -> Response:
    """Return a response whose body is already JSON."""
    return Response(text, media_type=JSON)
