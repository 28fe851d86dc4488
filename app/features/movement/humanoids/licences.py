"""Determine what the licence of a body allows, and what must be confirmed before it is worn.

VRM files say who may wear a model: everybody, only people to whom its author has given permission,
or only the author. A server cannot know who its participants are, so a person has to confirm that
the term is met; the confirmation is stored with the body and in the audit trail. A body whose file
says nothing is not restricted, and is shown as such. A body whose file has not been read for its
terms, because an earlier release stored it, must be measured again before it gets a name or a
configuration.
"""

from dataclasses import asdict
from typing import Any, get_args

from app.adapters.humanoids import ModelRights
from app.features.movement.humanoids.schemas import ConfirmationView, LicenceView, Term, Use
from app.models import HumanoidRow


def stored_licence(rights: ModelRights) -> dict[str, Any]:
    """Return what a file says about its terms, as stored with the body (a `LicenceView`)."""
    said = asdict(rights)
    return {
        "title": rights.title,
        "authors": list(rights.authors),
        "contact": rights.contact,
        "copyright": rights.copyright,
        "name": rights.licence,
        "url": rights.licence_url,
        "other_url": rights.other_url,
        "wearers": rights.wearers,
        "permissions": {use: said[use] for use in get_args(Use)},
        "credit_needed": rights.credit_needed,
    }


def licence_of(row: HumanoidRow) -> LicenceView | None:
    """Return what the body's file says about its terms; None if that has not been read yet."""
    return None if row.licence is None else LicenceView.model_validate(row.licence)


def licence_is_read(row: HumanoidRow) -> bool:
    """Return whether the body's file has been read for its terms."""
    return row.licence is not None


def confirmations_of(row: HumanoidRow) -> list[ConfirmationView]:
    """Return the terms that were confirmed, in chronological order."""
    return [ConfirmationView.model_validate(one) for one in row.confirmed or []]


def term_of(row: HumanoidRow) -> Term | None:
    """Return the term on which the body may be worn; None if its file restricts nobody."""
    licence = licence_of(row)
    if licence is None:
        return None
    terms: dict[str, Term] = {"author": "only_author", "licensed": "only_licensed_people"}
    return terms.get(licence.wearers)


def asked_terms(row: HumanoidRow) -> tuple[Term, ...]:
    """Return the terms that must be confirmed and that nobody has confirmed yet."""
    term = term_of(row)
    confirmed = {one.term for one in confirmations_of(row)}
    return () if term is None or term in confirmed else (term,)


def confirmed_with(
    row: HumanoidRow, terms: tuple[Term, ...], by: str, at: str
) -> list[dict[str, Any]]:
    """Return the confirmations of the body with these added."""
    return [*(row.confirmed or []), *({"term": term, "by": by, "at": at} for term in terms)]
