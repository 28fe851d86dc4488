"""HTTP endpoints for logging in and out, and for changing one's own password."""

from fastapi import APIRouter, Request, Response
from sqlalchemy.orm import Session

from app.database import after_commit
from app.errors import Busy, NotAllowed, NotSignedIn, TooManyAttempts
from app.features.people.accounts.passwords import hash_password, require_good
from app.features.people.accounts.people import account_by_id, end_logins
from app.features.people.accounts.refusals import RefusedSignIns
from app.features.people.accounts.schemas import (
    AccountView,
    Credentials,
    NewPassword,
    SignedInView,
    WhoView,
)
from app.features.people.accounts.service import (
    account_named,
    is_active,
    issue_token,
    require_password,
    revoke_token,
)
from app.features.people.audit import record
from app.models import Account
from app.platform.access import Caller, caller_of
from app.platform.admission import LOGIN_COOKIE, bearer_token
from app.platform.context import AppContext
from app.platform.dependencies import (
    FREES_SPACE,
    Context,
    SignedIn,
    signed_in_caller,
)
from app.platform.rate_limit import network_of
from app.platform.tokens import delete_cookie, hash_token, read_cookie, set_cookie

router = APIRouter(tags=["accounts"])
REFUSED_SIGN_IN_COST = 5.0
"""What a refused sign-in takes from an address's budget for requests without a login.

Sixty typing errors in a row use the budget up.
"""


@router.post("/login", dependencies=[FREES_SPACE])
def post_login(
    credentials: Credentials, request: Request, response: Response, context: Context
) -> SignedInView:
    """Log in. The login token is set as a cookie that scripts cannot read."""
    address = request.client.host if request.client else ""
    network, name = network_of(address), credentials.username
    try:
        context.limits.sign_ins.attempt(network)
        context.limits.names.attempt(f"{network} {name}")
        with context.database.reading() as db:
            account = account_named(db, name)
        # Verifying is slow on purpose, so it runs outside any transaction.
        account = require_password(account, credentials.password)
    except (NotSignedIn, TooManyAttempts, Busy) as error:
        if isinstance(error, Busy):
            context.limits.sign_ins.take_back(network)
            context.limits.names.take_back(f"{network} {name}")
        context.limits.strangers.charge(network, REFUSED_SIGN_IN_COST)
        checked = isinstance(error, NotSignedIn)
        context.part(RefusedSignIns).note(network, name, checked=checked)
        raise
    with context.database.writing() as db:
        caller = open_login(db, context, request, response, account)
        now = context.clock.utc_now()
        record(db, actor=caller.actor, action="login.opened", details={"address": address}, now=now)
    context.limits.names.succeed(f"{network} {name}")
    context.limits.sign_ins.take_back(network)
    return SignedInView(account=_view(caller))


def open_login(
    db: Session, context: AppContext, request: Request, response: Response, account: Account
) -> Caller:
    """Issue a login token for a browser, and revoke the one it had before."""
    now, hours = context.clock.utc_now(), context.settings.login_hours
    old = read_cookie(request, LOGIN_COOKIE)
    if old:
        revoke_token(db, old, now)
    login = issue_token(db, account, purpose="browser", now=now, hours=hours)
    set_cookie(request, response, LOGIN_COOKIE, login.token, int(hours * 3600))
    return caller_of(account)


@router.post("/logout", status_code=204)
def post_logout(request: Request, response: Response, context: Context) -> None:
    """Log out; open pages that use this login lose access immediately."""
    delete_cookie(request, response, LOGIN_COOKIE)
    tokens = [bearer_token(request), read_cookie(request, LOGIN_COOKIE)]
    with context.database.reading() as db:
        active = [token for token in tokens if token and is_active(db, token)]
    # A request without a valid login never opens a write transaction.
    if not active:
        return
    with context.database.writing() as db:
        for token in active:
            revoke_token(db, token, context.clock.utc_now())
        after_commit(db, context.hub.publish_access)


@router.get("/me")
def get_me(request: Request, context: Context) -> WhoView:
    """Return the account that is signed in, or null if none is."""
    try:
        return WhoView(account=_view(signed_in_caller(request, context)))
    except NotSignedIn:
        return WhoView(account=None)


@router.put("/me/password", status_code=204)
def put_password(change: NewPassword, request: Request, context: Context, caller: SignedIn) -> None:
    """Change the caller's own password, and end all of their other logins."""
    attempts = f"password:{caller.account_id}"
    context.limits.names.attempt(attempts)
    require_good(change.new, caller.username)
    with context.database.reading() as db:
        account = account_by_id(db, caller.account_id)
    try:
        require_password(account, change.current)
    except NotSignedIn as error:
        raise NotAllowed(
            "the current password is incorrect", remedy="Enter the password you sign in with."
        ) from error
    hashed, now = hash_password(change.new), context.clock.utc_now()
    token = bearer_token(request) or read_cookie(request, LOGIN_COOKIE) or ""
    with context.database.writing() as db:
        account = account_by_id(db, caller.account_id)
        account.password_hash = hashed
        end_logins(db, account, now, keep=hash_token(token))
        record(db, actor=caller.actor, action="account.password", now=now)
        after_commit(db, context.hub.publish_access)
    context.limits.names.succeed(attempts)


def _view(caller: Caller) -> AccountView:
    return AccountView.model_validate(
        {"id": caller.account_id, "username": caller.username, "role": caller.role}
    )
