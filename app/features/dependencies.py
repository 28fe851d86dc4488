"""What an endpoint asks for: the application's parts, a transaction, and who is calling.

`Writing` commits before the response leaves, so whoever hears "stored" can rely on it.
"""

from collections.abc import AsyncIterator, Iterator
from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Request
from sqlalchemy.orm import Session

from app.errors import KeptConflict, NotSignedIn
from app.features.accounts.service import account_of_token
from app.features.context import AppContext
from app.features.devices.service import device_of_token
from app.models import Account, Device

LOGIN_COOKIE = "reembody_login"
TABLET_COOKIE = "reembody_tablet"


@dataclass(frozen=True)
class Caller:
    """A person of the lab; `actor` is how the record names them."""

    account_id: str
    username: str
    role: str

    @property
    def actor(self) -> str:
        """The name in the event log."""
        return f"account:{self.username}"


def get_context(request: Request) -> AppContext:
    """The running application's parts."""
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


Reading = Annotated[Session, Depends(_reading, scope="function")]
Writing = Annotated[Session, Depends(_writing, scope="function")]


def bearer_token(request: Request) -> str | None:
    """The token of an `Authorization: Bearer` header, if there is one."""
    scheme, _, token = request.headers.get("authorization", "").partition(" ")
    return token.strip() if scheme.lower() == "bearer" and token else None


def get_caller(request: Request, context: Context) -> Caller:
    """The signed-in person, by cookie or bearer token; raises NotSignedIn."""
    token = bearer_token(request) or request.cookies.get(LOGIN_COOKIE)
    if not token:
        raise NotSignedIn("nobody is signed in", remedy="Log in first.")
    with context.database.reading() as db:
        account = account_of_token(db, token, context.clock.utc_now())
    return _caller(account)


def get_tablet(request: Request, context: Context) -> Device:
    """The paired tablet; raises NotSignedIn when it is unknown or was replaced."""
    token = request.cookies.get(TABLET_COOKIE) or bearer_token(request)
    tablet = _device(token, "tablet", context)
    context.hub.note_seen(tablet.id, context.clock.utc_now())
    return tablet


def get_headset(request: Request, context: Context) -> Device:
    """The paired headset; raises NotSignedIn when it is unknown or was replaced."""
    return _device(bearer_token(request), "headset", context)


def _device(token: str | None, kind: str, context: AppContext) -> Device:
    if not token:
        raise NotSignedIn(f"this {kind} is not paired", remedy="Enter the code from the console.")
    with context.database.reading() as db:
        return device_of_token(db, token, kind)


def _caller(account: Account) -> Caller:
    return Caller(account.id, account.username, account.role)


SignedIn = Annotated[Caller, Depends(get_caller)]
PairedTablet = Annotated[Device, Depends(get_tablet)]
PairedHeadset = Annotated[Device, Depends(get_headset)]
