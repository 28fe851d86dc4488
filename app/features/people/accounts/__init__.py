"""The lab's accounts, their passwords, and the login tokens that identify them."""

from app.features.people.accounts.passwords import is_hash
from app.features.people.accounts.people import set_studies
from app.features.people.accounts.refusals import RefusedSignIns
from app.features.people.accounts.service import (
    create_account,
    ensure_admin,
    is_username,
    issue_token,
    revoke_purpose,
    revoke_token,
)

__all__ = [
    "RefusedSignIns",
    "create_account",
    "ensure_admin",
    "is_hash",
    "is_username",
    "issue_token",
    "revoke_purpose",
    "revoke_token",
    "set_studies",
]
