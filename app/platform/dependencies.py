"""Dependencies of endpoints: the application's context, a transaction, and the caller.

`Writing` commits before the response is sent, so a client that gets the response "stored" can rely
on it.
"""

from collections.abc import AsyncIterator, Callable, Iterator
from typing import Annotated, TypeVar, cast

from anyio.to_thread import run_sync
from fastapi import Depends, Request
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from app.errors import NotAllowed, NotSignedIn, OtherAccount, RecordedConflict
from app.models import Device
from app.platform.access import Caller, caller_of, require_object
from app.platform.admission import LOGIN_COOKIE, TABLET_COOKIE, bearer_token
from app.platform.context import AppContext
from app.platform.policy import HEADSET, TABLET, allowed
from app.platform.tokens import device_of_token, login_of_token, read_cookie

API_PREFIX = "/api"
ACCOUNT_HEADER = "x-reembody-account"
"""The request header in which a page names the account it shows.

All tabs of a browser share one cookie, so that a page may be open under another account than the
one that the cookie belongs to by now.
"""
Result = TypeVar("Result")


async def get_context(request: Request) -> AppContext:
    """Return the running application's context; it is async because a thread would cost more."""
    context = request.app.state.context
    assert isinstance(context, AppContext)  # noqa: S101 - narrows what create_app put there
    return context


Context = Annotated[AppContext, Depends(get_context)]


def _reading(context: Context) -> Iterator[Session]:
    with context.database.reading() as db:
        yield db


async def _writing(context: Context) -> AsyncIterator[Session]:
    refusal: RecordedConflict | None = None
    async with context.database.writing_async() as db:
        try:
            yield db
        except RecordedConflict as error:
            refusal = error
    if refusal is not None:
        raise refusal


async def _make_room(context: Context) -> None:
    """Free reserved disk space if the disk is full.

    This must be the route's first dependency, before the transaction opens.
    """
    await run_sync(context.storage.make_room)


FREES_SPACE = Depends(_make_room)
"""For routes that free space or stop using it: they also work on a full disk."""


async def write(context: AppContext, work: Callable[[Session], Result]) -> Result:
    """Run `work` in a transaction like that of `Writing`, all of it on one thread."""
    refusals: list[RecordedConflict] = []

    def run(db: Session) -> Result | None:
        try:
            return work(db)
        except RecordedConflict as error:
            refusals.append(error)
            return None

    result = await context.database.write(run)
    for refusal in refusals:
        raise refusal
    return cast("Result", result)


Reading = Annotated[Session, Depends(_reading, scope="function")]
Writing = Annotated[Session, Depends(_writing, scope="function")]


def get_caller(request: Request, context: Context) -> Caller:
    """Return the signed-in person, if they may call this route on this object.

    They are identified by cookie or bearer token. Raises NotSignedIn; NotAllowed if the route is
    not allowed for their role; NotFound if the object belongs to a study that they may not see.
    """
    return authorised_caller(request, context, request.method)


def authorised_caller(request: HTTPConnection, context: AppContext, method: str) -> Caller:
    """Return the caller of a request or a socket; `method` is the method's name in the policy.

    Raises the same errors as `get_caller`.
    """
    caller = signed_in_caller(request, context)
    template = _template(request)
    roles = allowed(method, template)
    if caller.role not in roles:
        raise NotAllowed(
            f"the role {caller.role} has no permission for this",
            value=caller.role,
            valid=sorted(roles),
            remedy="Ask the administrator of the lab if you need it.",
        )
    with context.database.reading() as db:
        require_object(db, caller, template, request.path_params)
    return caller


def signed_in_caller(request: HTTPConnection, context: Context) -> Caller:
    """Return the signed-in person, whatever the route.

    Raises NotSignedIn if there is none, and OtherAccount if the page that sent the request shows
    somebody else: it must neither show what this person may see nor act in their name.
    """
    token = bearer_token(request) or read_cookie(request, LOGIN_COOKIE)
    if not token:
        raise NotSignedIn("you are not signed in", remedy="Sign in first.")
    with context.database.reading() as db:
        login, account = login_of_token(db, token, context.clock.utc_now())
        caller = caller_of(account, login.purpose)
    if request.headers.get(ACCOUNT_HEADER, caller.account_id) != caller.account_id:
        raise OtherAccount(
            "another account has signed in in this browser since this page was opened",
            value=caller.username,
            remedy="Reload the page.",
        )
    return caller


def get_tablet(request: Request, context: Context) -> Device:
    """Return the paired tablet; raise NotSignedIn if it is unknown or was replaced."""
    with context.database.reading() as db:
        return tablet_in(db, request, context)


def tablet_in(db: Session, request: Request, context: AppContext) -> Device:
    """Return the paired tablet, using a transaction that is already open."""
    _require_device_route(request, TABLET)
    token = read_cookie(request, TABLET_COOKIE) or bearer_token(request)
    tablet = _device(db, token, "tablet")
    context.hub.note_seen(tablet.id, context.clock.utc_now())
    return tablet


def get_headset(request: Request, context: Context) -> Device:
    """Return the paired headset; raise NotSignedIn if it is unknown or was replaced."""
    with context.database.reading() as db:
        return headset_in(db, request)


def headset_in(db: Session, request: Request) -> Device:
    """Return the paired headset, using a transaction that is already open."""
    _require_device_route(request, HEADSET)
    return _device(db, bearer_token(request), "headset")


def _require_device_route(request: Request, who: frozenset[str]) -> None:
    if allowed(request.method, _template(request)) != who:
        raise NotAllowed("devices may not call this address", remedy="Use the device's own page.")


def _template(request: HTTPConnection) -> str:
    """Return the route's full path template, with the names of its parameters.

    All HTTP routes are included under one prefix, which the route's own path lacks; the path of a
    socket's route has it.
    """
    path = str(request.scope["route"].path)
    return path if path.startswith(f"{API_PREFIX}/") else f"{API_PREFIX}{path}"


def _device(db: Session, token: str | None, kind: str) -> Device:
    if not token:
        raise NotSignedIn(
            f"this {kind} is not paired", remedy="Enter the code on the experimenter's screen."
        )
    return device_of_token(db, token, kind)


SignedIn = Annotated[Caller, Depends(get_caller)]
PairedTablet = Annotated[Device, Depends(get_tablet)]
PairedHeadset = Annotated[Device, Depends(get_headset)]
