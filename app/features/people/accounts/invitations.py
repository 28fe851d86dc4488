"""Invitations: single-use links, each of which creates one account with a role set by the admin.

The token follows the # of the link, which browsers never send to a server, so it appears in no
log. The invited person chooses the user name and password, so no admin ever knows the password.
"""

import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import Gone, NotFound
from app.features.people.accounts.people import set_studies, study_ids
from app.features.people.accounts.service import add_account
from app.models import Account, Invitation, Study
from app.platform.tokens import hash_token


@dataclass(frozen=True)
class Invited:
    """A new invitation with its token, which is available in plain text only here."""

    invitation: Invitation
    token: str


def invite(
    db: Session,
    *,
    role: str,
    note: str,
    studies: Sequence[str] | None,
    by: str,
    now: datetime,
    hours: float,
) -> Invited:
    """Create an invitation for `role`, with access to these studies (keys) or to all (None)."""
    token = secrets.token_urlsafe(32)
    row = Invitation(
        token_hash=hash_token(token),
        role=role,
        note=note.strip(),
        all_studies=studies is None,
        studies=study_ids(db, studies or ()),
        created_by=by,
        created_at=now,
        expires_at=now + timedelta(hours=hours),
    )
    db.add(row)
    db.flush()
    return Invited(row, token)


def invitations(db: Session) -> Sequence[Invitation]:
    """Return all invitations, newest first."""
    return db.scalars(select(Invitation).order_by(Invitation.created_at.desc())).all()


def status_of(row: Invitation, now: datetime) -> str:
    """Return an invitation's status: open, used, revoked or expired."""
    if row.used_at is not None:
        return "used"
    if row.revoked_at is not None:
        return "revoked"
    return "expired" if row.expires_at <= now else "open"


def open_invitation(db: Session, token: str, now: datetime) -> Invitation:
    """Lock and return the open invitation that has this token.

    Raises NotFound for an unknown token, and Gone if the invitation is no longer open.
    """
    row = db.scalar(
        select(Invitation).where(Invitation.token_hash == hash_token(token)).with_for_update()
    )
    if row is None:
        raise NotFound(
            "there is no such invitation",
            remedy="Copy the whole link, or ask the administrator for another.",
        )
    status = status_of(row, now)
    if status != "open":
        raise Gone(
            f"this invitation is {status}",
            value=status,
            remedy="Sign in if you have an account; otherwise ask the administrator for another "
            "link.",
        )
    return row


def accept(db: Session, *, token: str, username: str, hashed: str, now: datetime) -> Account:
    """Create the account that an invitation grants, with the invitation's role and studies.

    `hashed`: the hash of the password, which was validated and hashed before this transaction.
    """
    row = open_invitation(db, token, now)
    account = add_account(db, username=username, hashed=hashed, role=row.role, now=now)
    if not row.all_studies:
        # A study may have been deleted since the invitation was made; skip it.
        keys = db.scalars(select(Study.key).where(Study.id.in_(row.studies))).all()
        set_studies(db, account, keys)
    row.used_at, row.account_id = now, account.id
    db.flush()
    return account


def revoke_invitation(db: Session, invitation_id: str, now: datetime) -> Invitation:
    """Revoke an invitation; one that was already used is left unchanged."""
    row = db.get(Invitation, invitation_id)
    if row is None:
        raise NotFound("there is no such invitation", value=invitation_id)
    if row.used_at is None:
        row.revoked_at = row.revoked_at or now
    return row
