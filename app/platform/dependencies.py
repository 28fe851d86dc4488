"""What an endpoint asks for: the application's parts, a transaction, and who is calling.

`Writing` commits before the response leaves, so whoever hears "stored" can rely on it.
"""

from collections.abc import AsyncIterator, Callable, Iterator
from typing import Annotated, TypeVar, cast

from anyio.to_thread import run_sync
from fastapi import Depends, Request
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from app.errors import KeptConflict, NotAllowed, NotSignedIn
from app.models import Device
from app.platform.access import Caller, caller_of, require_object
from app.platform.admission import LOGIN_COOKIE, TABLET_COOKIE, bearer_token
from app.platform.context import AppContext
from app.platform.policy import HEADSET, TABLET, allowed
from app.platform.tokens import account_of_token, device_of_token, read_cookie

API_PREFIX = "/api"
Result = TypeVar("Result")


async def get_context(request: Request) -> AppContext:
    """The running application's parts; asynchronous, since a thread of its own would cost more."""
    context = request.app.state.context
    assert isinstance(context, AppContext)  # noqa: S101 - narrows what create_app put there
    return context


Context = Annotated[AppContext, Depends(get_context)]


def _reading(context: Context) -> Iterator[Session]:
    with context.database.reading() as db:
        yield db


async def _writing(context: Context) -> AsyncIterator[Session]:
    refusal: KeptConflict | None = None
    async with context.database.writing_async() as db:
        try:
            yield db
        except KeptConflict as error:
            refusal = error
    if refusal is not None:
        raise refusal


async def _make_room(context: Context) -> None:
    """Before the transaction is opened, hence first among the dependencies of its route."""
    await run_sync(context.storage.make_room)


FREES_SPACE = Depends(_make_room)
"""For routes that free space or stop what takes it: they go on where the disk is full."""


async def write(context: AppContext, work: Callable[[Session], Result]) -> Result:
    """What `work` gives in a transaction like that of `Writing`, all of it on one thread."""
    refusals: list[KeptConflict] = []

    def kept(db: Session) -> Result | None:
        try:
            return work(db)
        except KeptConflict as error:
            refusals.append(error)
            return None

    result = await context.database.write(kept)
    for refusal in refusals:
        raise refusal
    return cast("Result", result)


Reading = Annotated[Session, Depends(_reading, scope="function")]
Writing = Annotated[Session, Depends(_writing, scope="function")]


def get_caller(request: Request, context: Context) -> Caller:
    """The signed-in person, by cookie or bearer token, who may call this route on this object.

    Raises NotSignedIn, NotAllowed where the route is not for their role, and NotFound where the
    object is of a study that is not theirs.
    """
    return admitted(request, context, request.method)


def admitted(request: HTTPConnection, context: AppContext, method: str) -> Caller:
    """The same for a request or a socket; `method` as the policy names it. Raises likewise."""
    caller = known_caller(request, context)
    template = _template(request)
    roles = allowed(method, template)
    if caller.role not in roles:
        raise NotAllowed(
            f"this is not for the role {caller.role}",
            value=caller.role,
            valid=sorted(roles),
            remedy="Ask the administrator of the lab if you need it.",
        )
    with context.database.reading() as db:
        require_object(db, caller, template, request.path_params)
    return caller


def known_caller(request: HTTPConnection, context: Context) -> Caller:
    """The signed-in person, whatever the route; raises NotSignedIn."""
    token = bearer_token(request) or read_cookie(request, LOGIN_COOKIE)
    if not token:
        raise NotSignedIn("nobody is signed in", remedy="Log in first.")
    with context.database.reading() as db:
        return caller_of(account_of_token(db, token, context.clock.utc_now()))


def get_tablet(request: Request, context: Context) -> Device:
    """The paired tablet; raises NotSignedIn when it is unknown or was replaced."""
    with context.database.reading() as db:
        return tablet_in(db, request, context)


def tablet_in(db: Session, request: Request, context: AppContext) -> Device:
    """The same within a transaction that goes on."""
    _require_device_route(request, TABLET)
    token = read_cookie(request, TABLET_COOKIE) or bearer_token(request)
    tablet = _device(db, token, "tablet")
    context.hub.note_seen(tablet.id, context.clock.utc_now())
    return tablet


def get_headset(request: Request, context: Context) -> Device:
    """The paired headset; raises NotSignedIn when it is unknown or was replaced."""
    _require_device_route(request, HEADSET)
    with context.database.reading() as db:
        return _device(db, bearer_token(request), "headset")


def _require_device_route(request: Request, who: frozenset[str]) -> None:
    if allowed(request.method, _template(request)) != who:
        raise NotAllowed("this route is not open to devices", remedy="Use the device's own page.")


def _template(request: HTTPConnection) -> str:
    """The route's path with the names of its parameters; all routes are included under one prefix,
    which the route itself does not know, unless it is a socket's.
    """
    path = str(request.scope["route"].path)
    return path if path.startswith(f"{API_PREFIX}/") else f"{API_PREFIX}{path}"


def _device(db: Session, token: str | None, kind: str) -> Device:
    if not token:
        raise NotSignedIn(f"this {kind} is not paired", remedy="Enter the code from the console.")
    return device_of_token(db, token, kind)


SignedIn = Annotated[Caller, Depends(get_caller)]
PairedTablet = Annotated[Device, Depends(get_tablet)]
PairedHeadset = Annotated[Device, Depends(get_headset)]
