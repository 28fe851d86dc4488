"""Logging in and out."""

from fastapi import APIRouter, Request, Response

from app.errors import NotSignedIn
from app.features.accounts.schemas import AccountView, Credentials, SignedInView, WhoView
from app.features.accounts.service import log_in, revoke_token
from app.features.dependencies import LOGIN_COOKIE, Context, Writing, bearer_token, get_caller

router = APIRouter(tags=["accounts"])


@router.post("/login")
def post_login(
    credentials: Credentials, request: Request, response: Response, db: Writing, context: Context
) -> SignedInView:
    """Open a login. The token travels in a cookie that no script can read."""
    caller = f"{request.client.host if request.client else ''}:{credentials.username}"
    context.login_limiter.attempt(caller)
    old = request.cookies.get(LOGIN_COOKIE)
    now = context.clock.utc_now()
    login = log_in(
        db,
        username=credentials.username,
        password=credentials.password,
        now=now,
        hours=context.settings.login_hours,
    )
    if old:
        revoke_token(db, old, now)
    context.login_limiter.succeed(caller)
    response.set_cookie(
        LOGIN_COOKIE,
        login.token,
        max_age=int(context.settings.login_hours * 3600),
        httponly=True,
        samesite="strict",
        secure=request.url.scheme == "https",
    )
    account = login.account
    return SignedInView(
        account=AccountView(id=account.id, username=account.username, role=account.role)
    )


@router.post("/logout", status_code=204)
def post_logout(request: Request, response: Response, db: Writing, context: Context) -> None:
    """End this login."""
    for token in (bearer_token(request), request.cookies.get(LOGIN_COOKIE)):
        if token:
            revoke_token(db, token, context.clock.utc_now())
    response.delete_cookie(LOGIN_COOKIE)


@router.get("/me")
def get_me(request: Request, context: Context) -> WhoView:
    """Who is signed in; null where nobody is."""
    try:
        caller = get_caller(request, context)
    except NotSignedIn:
        return WhoView(account=None)
    return WhoView(
        account=AccountView(id=caller.account_id, username=caller.username, role=caller.role)
    )
