"""What the licence of a body allows, and what somebody must confirm before it is worn.

VRM files say who may wear a model: everybody, only people to whom its author has given permission,
or only the author. A server cannot know who its participants are, so a person has to confirm that
the term is met; the confirmation is stored with the body and in the audit trail. A body whose file
says nothing is not restricted, and is shown as such.
"""

from typing import Any

from app.features.movement.humanoids.schemas import (
    ConfirmationView,
    LicenceView,
    Permission,
    Term,
)
from app.models import HumanoidRow

BY_EVERYBODY, BY_LICENSED = "wear_by_everybody", "wear_by_licensed_people"
"""The permissions to wear a body, in `LicenceView.permissions`."""


def licence_of(row: HumanoidRow) -> LicenceView | None:
    """Return what the body's file says of its terms; None if it was not read yet."""
    return None if row.licence is None else LicenceView.model_validate(row.licence)


def confirmations_of(row: HumanoidRow) -> list[ConfirmationView]:
    """Return the terms that were confirmed, in the order of time."""
    return [ConfirmationView.model_validate(one) for one in row.confirmed or []]


def permission_to_wear(row: HumanoidRow) -> Permission:
    """Return whether everybody may wear the body."""
    licence = licence_of(row)
    return "unknown" if licence is None else licence.permissions.get(BY_EVERYBODY, "unknown")


def terms_of(row: HumanoidRow) -> tuple[Term, ...]:
    """Return the terms on which the body may be worn; none if everybody may wear it."""
    licence = licence_of(row)
    if licence is None or licence.permissions.get(BY_EVERYBODY) != "forbidden":
        return ()
    by_licensed = licence.permissions.get(BY_LICENSED) == "allowed"
    return ("only_licensed_people",) if by_licensed else ("only_author",)


def asked_terms(row: HumanoidRow) -> tuple[Term, ...]:
    """Return the terms that nobody has confirmed yet."""
    confirmed = {one.term for one in confirmations_of(row)}
    return tuple(term for term in terms_of(row) if term not in confirmed)


def confirmed_with(
    row: HumanoidRow, terms: tuple[Term, ...], by: str, at: str
) -> list[dict[str, Any]]:
    """Return the confirmations of the body with these added."""
    return [*(row.confirmed or []), *({"term": term, "by": by, "at": at} for term in terms)]
