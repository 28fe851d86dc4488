"""Logging in and out."""

from fastapi import APIRouter, Request, Response
from sqlalchemy.orm import Session

from app.errors import NotAllowed, NotSignedIn
from app.features.people.accounts.passwords import hash_password, require_good
from app.features.people.accounts.people import account_by_id, end_logins
from app.features.people.accounts.schemas import (
    AccountView,
    Credentials,
    NewPassword,
    SignedInView,
    WhoView,
)
from app.features.people.accounts.service import check_password, issue_token, revoke_token
from app.features.people.audit import record
from app.models import Account
from app.platform.access import Caller, caller_of
from app.platform.context import AppContext
from app.platform.dependencies import (
    FREES_SPACE,
    LOGIN_COOKIE,
    Context,
    SignedIn,
    Writing,
    bearer_token,
    known_caller,
)
from app.platform.hub import after_commit
from app.platform.tokens import delete_cookie, hash_token, read_cookie, set_cookie

router = APIRouter(tags=["accounts"])


@router.post("/login", dependencies=[FREES_SPACE])
def post_login(
    credentials: Credentials, request: Request, response: Response, context: Context
) -> SignedInView:
    """Open a login. The token travels in a cookie that no script can read."""
    caller = f"{request.client.host if request.client else ''}:{credentials.username}"
    context.login_limiter.attempt(caller)
    now = context.clock.utc_now()
    # Checking takes a while on purpose, so nobody else's writing waits for it.
    try:
        with context.database.reading() as db:
            account = check_password(
                db, username=credentials.username, password=credentials.password
            )
    except NotSignedIn:
        with context.database.writing() as db:
            record(db, actor="nobody", action="login.refused", details=_from(request), now=now)
        raise
    with context.database.writing() as db:
        opened = open_login(db, context, request, response, account)
        record(db, actor=opened.actor, action="login.opened", details=_from(request), now=now)
    context.login_limiter.succeed(caller)
    return SignedInView(account=_view(opened))


def open_login(
    db: Session, context: AppContext, request: Request, response: Response, account: Account
) -> Caller:
    """A new token for a browser, in the place of the one it had."""
    now, hours = context.clock.utc_now(), context.settings.login_hours
    old = read_cookie(request, LOGIN_COOKIE)
    if old:
        revoke_token(db, old, now)
    login = issue_token(db, account, purpose="browser", now=now, hours=hours)
    set_cookie(request, response, LOGIN_COOKIE, login.token, int(hours * 3600))
    return caller_of(account)


@router.post("/logout", status_code=204)
def post_logout(request: Request, response: Response, db: Writing, context: Context) -> None:
    """End this login; pages that are open with it are shut out at once."""
    for token in (bearer_token(request), read_cookie(request, LOGIN_COOKIE)):
        if token:
            revoke_token(db, token, context.clock.utc_now())
    delete_cookie(request, response, LOGIN_COOKIE)
    after_commit(db, context.hub.publish_access)


@router.get("/me")
def get_me(request: Request, context: Context) -> WhoView:
    """Who is signed in; null where nobody is."""
    try:
        return WhoView(account=_view(known_caller(request, context)))
    except NotSignedIn:
        return WhoView(account=None)


@router.put("/me/password", status_code=204)
def put_password(change: NewPassword, request: Request, context: Context, caller: SignedIn) -> None:
    """Change one's own password; logins elsewhere end."""
    context.login_limiter.attempt(f"password:{caller.account_id}")
    require_good(change.new, caller.username)
    with context.database.reading() as db:
        try:
            check_password(db, username=caller.username, password=change.current)
        except NotSignedIn as error:
            raise NotAllowed(
                "the current password is not right", remedy="Type the password you log in with."
            ) from error
    hashed, now = hash_password(change.new), context.clock.utc_now()
    token = bearer_token(request) or read_cookie(request, LOGIN_COOKIE) or ""
    with context.database.writing() as db:
        account = account_by_id(db, caller.account_id)
        account.password_hash = hashed
        end_logins(db, account, now, but=hash_token(token))
        record(db, actor=caller.actor, action="account.password", now=now)
        after_commit(db, context.hub.publish_access)
    context.login_limiter.succeed(f"password:{caller.account_id}")


def _view(caller: Caller) -> AccountView:
    return AccountView.model_validate(
        {"id": caller.account_id, "username": caller.username, "role": caller.role}
    )


def _from(request: Request) -> dict[str, str]:
    """Where a login came from; the name that was typed is not kept, it may be a password."""
    return {"address": request.client.host if request.client else ""}
