"""Name bodies, and confirm the terms that their licences ask for.

A name is given once: studies and records refer to bodies by it, so it never comes to mean another
body. Every record has the hash of the model's file as well.
"""

from datetime import datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput
from app.features.movement.humanoids.licences import (
    asked_terms,
    confirmed_with,
    licence_is_read,
    term_of,
)
from app.features.movement.humanoids.schemas import BodyChange, BodyTitle, Term
from app.features.movement.humanoids.service import humanoid_by_hash
from app.features.people.audit import record
from app.models import HumanoidRow
from app.plain_titles import NO_NAMES

_RESERVED = "configuration"
"""What results call the body of a study's avatar configuration, which has no name of its own."""
_TERMS: dict[Term, str] = {
    "only_author": "only its author may wear it",
    "only_licensed_people": "only people to whom its author has given permission may wear it",
}


def change_body(
    db: Session, actor: str, content_hash: str, change: BodyChange, now: datetime
) -> None:
    """Name a body, retitle it, or confirm terms of its licence; all of it or nothing.

    Raises NotFound, InvalidInput if the name is reserved or the licence does not ask for a term
    (one that was confirmed before may be repeated), and Conflict if the body has another name
    already, if another body has the name, or if its licence must be read or confirmed first.
    """
    row = humanoid_by_hash(db, content_hash, lock=True)
    _confirm(db, actor, row, change.confirmed, now)
    if change.name is not None and change.name != row.name:
        _give_name(db, actor, row, change.name, now)
    if change.title is not None and change.title != row.title:
        _give_title(db, actor, row, change.title, now)


def require_confirmed(row: HumanoidRow) -> None:
    """Raise Conflict if the body's licence must be read or confirmed before it is worn."""
    if not licence_is_read(row):
        raise Conflict(
            f"the licence of {row.name or row.file_name!r} was never read, because an earlier "
            "release stored the body",
            value=row.hash,
            valid="a body whose licence has been read",
            remedy="Measure it again on the page Bodies, which reads the licence from its file.",
        )
    asked = asked_terms(row)
    if asked:
        raise Conflict(
            f"the licence of {row.name or row.file_name!r} says that {_TERMS[asked[0]]}",
            value=row.hash,
            valid=list(asked),
            remedy="Open the body on the page Bodies and confirm that this is the case.",
        )


def _confirm(db: Session, actor: str, row: HumanoidRow, terms: list[Term], now: datetime) -> None:
    for term in terms:
        if term != term_of(row):
            raise InvalidInput(
                f"the licence of this body does not ask for {term!r}",
                value=term,
                valid=[one for one in (term_of(row),) if one is not None],
                remedy="Confirm only what `asked` names; nothing was stored.",
            )
    asked = asked_terms(row)
    new = tuple(term for term in asked if term in terms)
    if not new:
        return
    row.confirmed = confirmed_with(row, new, actor, now.isoformat())
    _record(db, actor, row, now, {"terms": list(new)}, action="humanoid.confirmed")


def _give_name(db: Session, actor: str, row: HumanoidRow, name: str, now: datetime) -> None:
    if row.name is not None:
        raise Conflict(
            f"this body is called {row.name!r}, and names of bodies never change",
            value=name,
            valid=row.name,
            remedy="Records refer to the body by its name. Change its title instead.",
        )
    if name in NO_NAMES:
        raise InvalidInput(
            f"no body can be called {name!r}: study files and tables read that as a value of "
            "their own",
            value=name,
            valid=f"any other name than {', '.join(sorted(NO_NAMES))}",
            remedy="Choose another name.",
        )
    if name == _RESERVED:
        raise InvalidInput(
            f"no body can be called {name!r}: results call the body of a study's avatar "
            "configuration so",
            value=name,
            valid=f"any other name than {_RESERVED!r}",
            remedy="Choose another name.",
        )
    other = db.scalar(select(HumanoidRow.hash).where(HumanoidRow.name == name))
    if other is not None:
        raise Conflict(
            f"another body is called {name!r}",
            value=name,
            valid="a name that no other body has",
            remedy="Choose another name; names of bodies are never given twice.",
        )
    require_confirmed(row)
    row.name = name
    _record(db, actor, row, now, {"name": name}, action="humanoid.named")


def _give_title(db: Session, actor: str, row: HumanoidRow, title: BodyTitle, now: datetime) -> None:
    row.title = title
    _record(db, actor, row, now, {}, action="humanoid.titled")


def _record(
    db: Session,
    actor: str,
    row: HumanoidRow,
    now: datetime,
    details: dict[str, object],
    *,
    action: str,
) -> None:
    record(
        db,
        actor=actor,
        action=action,
        subject=f"humanoid:{row.hash[:12]}",
        details={"content": row.hash[:12], **details},
        now=now,
    )
