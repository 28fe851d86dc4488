"""Accounts and logins: who works here, and the tokens by which they are known."""

from app.features.people.accounts.passwords import is_hash
from app.features.people.accounts.people import give_studies
from app.features.people.accounts.refusals import RefusedSignIns
from app.features.people.accounts.service import (
    create_account,
    ensure_admin,
    is_username,
    issue_token,
    revoke_token,
)

__all__ = [
    "RefusedSignIns",
    "create_account",
    "ensure_admin",
    "give_studies",
    "is_hash",
    "is_username",
    "issue_token",
    "revoke_token",
]
