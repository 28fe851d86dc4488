"""HTTP endpoints for managing accounts and invitations."""

from datetime import datetime

from fastapi import APIRouter, Request, Response
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.database import after_commit
from app.features.people.accounts.endpoints import open_login
from app.features.people.accounts.invitations import (
    accept,
    invitations,
    invite,
    open_invitation,
    revoke_invitation,
    status_of,
)
from app.features.people.accounts.passwords import hash_password, require_good
from app.features.people.accounts.people import (
    Person,
    account_by_id,
    close_account,
    end_logins,
    people,
    person_of,
    reopen_account,
    set_role,
    set_studies,
)
from app.features.people.accounts.schemas import (
    Acceptance,
    AccountView,
    InvitationLook,
    InvitationToken,
    InvitationView,
    InvitedView,
    NewInvitation,
    PersonChange,
    PersonView,
    SignedInView,
)
from app.features.people.audit import record
from app.models import Account, Invitation, Study
from app.platform.dependencies import Context, Reading, SignedIn, Writing
from app.platform.rate_limit import network_of

router = APIRouter(tags=["accounts"])


@router.get("/accounts")
def get_accounts(db: Reading, context: Context, _: SignedIn) -> list[PersonView]:
    """Return all accounts, including closed ones."""
    return [_person(person) for person in people(db, context.clock.utc_now())]


@router.patch("/accounts/{account_id}")
def patch_account(
    account_id: str, change: PersonChange, db: Writing, context: Context, caller: SignedIn
) -> PersonView:
    """Change the role or studies of an account, close it (which ends its logins), or reopen it."""
    account, now = account_by_id(db, account_id), context.clock.utc_now()
    given = change.model_fields_set
    if change.role is not None:
        set_role(db, account, change.role)
    if "studies" in given:
        set_studies(db, account, change.studies)
    if change.closed is True:
        close_account(db, account, now)
    elif change.closed is False:
        reopen_account(account)
    db.flush()
    person = person_of(db, account, now)
    if given:
        details = change.model_dump(include=given)
        subject = f"account:{account.username}"
        record(
            db,
            actor=caller.actor,
            action="account.changed",
            subject=subject,
            details=details,
            now=now,
        )
        after_commit(db, context.hub.publish_access)
    return _person(person)


@router.delete("/accounts/{account_id}/logins", status_code=204)
def delete_logins(account_id: str, db: Writing, context: Context, caller: SignedIn) -> None:
    """End every login of an account, for example after a laptop was lost."""
    account, now = account_by_id(db, account_id), context.clock.utc_now()
    ended = end_logins(db, account, now)
    subject, details = f"account:{account.username}", {"ended": ended}
    record(
        db, actor=caller.actor, action="login.revoked", subject=subject, details=details, now=now
    )
    after_commit(db, context.hub.publish_access)


@router.get("/invitations")
def get_invitations(db: Reading, context: Context, _: SignedIn) -> list[InvitationView]:
    """Return all invitations, including used ones, newest first."""
    now = context.clock.utc_now()
    return [InvitationView.model_validate(_invitation(db, row, now)) for row in invitations(db)]


@router.post("/invitations", status_code=201)
def post_invitation(
    body: NewInvitation, request: Request, db: Writing, context: Context, caller: SignedIn
) -> InvitedView:
    """Create a link with which one person can create an account with the given role."""
    now = context.clock.utc_now()
    made = invite(
        db,
        role=body.role,
        note=body.note,
        studies=body.studies,
        by=caller.actor,
        now=now,
        hours=body.hours,
    )
    base = context.network.reach.for_devices(str(request.base_url))
    here = str(request.base_url).rstrip("/")
    view = _invitation(db, made.invitation, now) | {
        "url": f"{base or here}/#/join/{made.token}",
        "only_here": base is None,
    }
    details = {"role": body.role, "studies": body.studies}
    subject = f"invitation:{made.invitation.id}"
    record(
        db, actor=caller.actor, action="invitation.made", subject=subject, details=details, now=now
    )
    return InvitedView.model_validate(view)


@router.delete("/invitations/{invitation_id}", status_code=204)
def delete_invitation(invitation_id: str, db: Writing, context: Context, caller: SignedIn) -> None:
    """Revoke an invitation."""
    now = context.clock.utc_now()
    revoke_invitation(db, invitation_id, now)
    subject = f"invitation:{invitation_id}"
    record(db, actor=caller.actor, action="invitation.revoked", subject=subject, now=now)


@router.post("/invitations/look")
def post_look(body: InvitationToken, request: Request, context: Context) -> InvitationLook:
    """Return the role, note and expiry of an invitation, given its token."""
    context.limits.codes.attempt(_guest(request))
    with context.database.reading() as db:
        row = open_invitation(db, body.token, context.clock.utc_now())
    return InvitationLook.model_validate(
        {"role": row.role, "note": row.note, "expires_at": row.expires_at}
    )


@router.post("/invitations/accept", status_code=201)
def post_accept(
    acceptance: Acceptance, request: Request, response: Response, context: Context
) -> SignedInView:
    """Accept an invitation: create the account and log in."""
    context.limits.codes.attempt(_guest(request))
    now = context.clock.utc_now()
    with context.database.reading() as db:
        open_invitation(db, acceptance.token, now)
    require_good(acceptance.password, acceptance.username)
    hashed = hash_password(acceptance.password)
    with context.database.writing() as db:
        account = accept(
            db, token=acceptance.token, username=acceptance.username, hashed=hashed, now=now
        )
        caller = open_login(db, context, request, response, account)
        record(
            db, actor=caller.actor, action="account.made", details={"role": caller.role}, now=now
        )
    view = {"id": account.id, "username": account.username, "role": account.role}
    return SignedInView(account=AccountView.model_validate(view))


def _person(person: Person) -> PersonView:
    account = person.account
    return PersonView.model_validate(
        {
            "id": account.id,
            "username": account.username,
            "role": account.role,
            "studies": None if account.all_studies else list(person.studies),
            "created_at": account.created_at,
            "disabled_at": account.disabled_at,
            "logins": person.logins,
            "last_login_at": person.last_login_at,
        }
    )


def _invitation(db: Session, row: Invitation, now: datetime) -> dict[str, object]:
    keys = db.scalars(select(Study.key).where(Study.id.in_(row.studies)).order_by(Study.key))
    used_by = db.get(Account, row.account_id) if row.account_id else None
    return {
        "id": row.id,
        "role": row.role,
        "note": row.note,
        "studies": None if row.all_studies else list(keys),
        "status": status_of(row, now),
        "created_by": row.created_by,
        "created_at": row.created_at,
        "expires_at": row.expires_at,
        "used_by": used_by.username if used_by else None,
    }


def _guest(request: Request) -> str:
    return f"invitation {network_of(request.client.host if request.client else None)}"
