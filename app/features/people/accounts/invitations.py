"""Invitations: a link that makes one account, once, with the role that the admin chose.

The token stands behind the # of the link, which browsers never send, so it is in no log; the
person chooses name and password themselves, so no admin ever knows a password.
"""

import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import Gone, NotFound
from app.features.people.accounts.people import give_studies, study_ids
from app.features.people.accounts.service import add_account
from app.models import Account, Invitation, Study
from app.platform.tokens import hash_token


@dataclass(frozen=True)
class Invited:
    """A fresh invitation: the token leaves here once, in clear."""

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
    """Make an invitation for `role`, to these studies (keys) or to all (None)."""
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
    """All of them, the newest first."""
    return db.scalars(select(Invitation).order_by(Invitation.created_at.desc())).all()


def status_of(row: Invitation, now: datetime) -> str:
    """open, used, revoked or expired."""
    if row.used_at is not None:
        return "used"
    if row.revoked_at is not None:
        return "revoked"
    return "expired" if row.expires_at <= now else "open"


def open_invitation(db: Session, token: str, now: datetime) -> Invitation:
    """The invitation with that token, locked; raises NotFound, or Gone where it is not open."""
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
            remedy="Log in if you have an account; else ask the administrator for another link.",
        )
    return row


def accept(db: Session, *, token: str, username: str, hashed: str, now: datetime) -> Account:
    """Make the account that the invitation promises; its role is not the guest's to choose.

    `hashed`: the password, which was found good and hashed before this transaction.
    """
    row = open_invitation(db, token, now)
    account = add_account(db, username=username, hashed=hashed, role=row.role, now=now)
    if not row.all_studies:
        # A study may be gone by now; nobody is invited to what is not there.
        keys = db.scalars(select(Study.key).where(Study.id.in_(row.studies))).all()
        give_studies(db, account, keys)
    row.used_at, row.account_id = now, account.id
    db.flush()
    return account


def revoke_invitation(db: Session, invitation_id: str, now: datetime) -> Invitation:
    """Take an invitation back; one that was used stays used."""
    row = db.get(Invitation, invitation_id)
    if row is None:
        raise NotFound("there is no such invitation", value=invitation_id)
    if row.used_at is None:
        row.revoked_at = row.revoked_at or now
    return row
