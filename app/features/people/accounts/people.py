"""Query and change the lab's accounts: roles, access to studies, and logins."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import delete, func, select, update
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput, NotFound
from app.models import SERVERS_OWN, Account, LoginToken, Study, StudyMember

_BY_PEOPLE = LoginToken.purpose.not_in(SERVERS_OWN)


@dataclass(frozen=True)
class Person:
    """An account with its studies (keys; empty if it may see all of them) and its active logins.

    Logins that the server gave to its own rehearsals are not counted: nobody signed in for them.
    """

    account: Account
    studies: tuple[str, ...]
    logins: int
    last_login_at: datetime | None


def people(db: Session, now: datetime) -> list[Person]:
    """Return all accounts by user name, including closed ones."""
    accounts = db.scalars(select(Account).order_by(Account.username)).all()
    return [person_of(db, account, now) for account in accounts]


def person_of(db: Session, account: Account, now: datetime) -> Person:
    """Return an account together with its studies and logins."""
    studies = db.scalars(
        select(Study.key)
        .join(StudyMember, StudyMember.study_id == Study.id)
        .where(StudyMember.account_id == account.id)
        .order_by(Study.key)
    )
    active = (LoginToken.revoked_at.is_(None)) & (LoginToken.expires_at > now)
    logins, last = db.execute(
        select(func.count().filter(active), func.max(LoginToken.created_at)).where(
            LoginToken.account_id == account.id, _BY_PEOPLE
        )
    ).one()
    return Person(account, tuple(studies), logins, last)


def account_by_id(db: Session, account_id: str) -> Account:
    """Return the account with this id; raises NotFound."""
    account = db.get(Account, account_id)
    if account is None:
        raise NotFound("there is no such account", value=account_id)
    return account


def set_role(db: Session, account: Account, role: str) -> None:
    """Change the role of an account; raises Conflict if no admin would be left."""
    if account.role == "admin" and role != "admin":
        _require_another_admin(db, account)
    account.role = role


def set_studies(db: Session, account: Account, keys: Sequence[str] | None) -> None:
    """Set which studies an account may see, or let it see all (None); raises InvalidInput."""
    account.all_studies = keys is None
    db.execute(delete(StudyMember).where(StudyMember.account_id == account.id))
    for study_id in study_ids(db, keys or ()):
        db.add(StudyMember(account_id=account.id, study_id=study_id))
    db.flush()


def study_ids(db: Session, keys: Sequence[str]) -> list[str]:
    """Return the ids of studies given by key; raises InvalidInput for unknown keys."""
    rows = db.execute(select(Study.key, Study.id).where(Study.key.in_(keys)))
    found = {row.key: row.id for row in rows}
    unknown = sorted(set(keys) - set(found))
    if unknown:
        raise InvalidInput(
            f"there is no study {unknown[0]!r}",
            value=unknown,
            valid=list(db.scalars(select(Study.key).order_by(Study.key))),
        )
    return [found[key] for key in dict.fromkeys(keys)]


def close_account(db: Session, account: Account, now: datetime) -> None:
    """Disable an account and end its logins; the account itself is retained for the record."""
    if account.disabled_at is not None:
        return
    if account.role == "admin":
        _require_another_admin(db, account)
    account.disabled_at = now
    end_logins(db, account, now)


def reopen_account(account: Account) -> None:
    """Re-enable a closed account, whose owner must log in again."""
    account.disabled_at = None


def end_logins(db: Session, account: Account, now: datetime, *, keep: str | None = None) -> int:
    """End the logins of an account, and return how many of people's were active.

    The login whose token has the hash `keep` is left open.
    """
    matching = (
        LoginToken.account_id == account.id,
        LoginToken.revoked_at.is_(None),
        LoginToken.token_hash != (keep or ""),
    )
    counted = (*matching, _BY_PEOPLE, LoginToken.expires_at > now)
    active = db.scalar(select(func.count()).where(*counted)) or 0
    db.execute(update(LoginToken).where(*matching).values(revoked_at=now))
    return active


def _require_another_admin(db: Session, account: Account) -> None:
    # If two admins revoke each other's role simultaneously, only one of them may succeed.
    others = db.scalars(
        select(Account.id)
        .where(Account.role == "admin", Account.disabled_at.is_(None))
        .order_by(Account.id)
        .with_for_update(key_share=True)
    ).all()
    if not set(others) - {account.id}:
        raise Conflict(
            "this is the only administrator",
            value=account.username,
            remedy="Give somebody else the role admin first.",
        )
