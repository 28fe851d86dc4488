"""Remove bodies that nothing refers to, such as one that was uploaded by mistake.

Studies and records refer to a body by its name; configurations, tunings and records of companions
by the hash of its file. All of them stay readable for good, so a body that one of them may refer to
is never removed.
"""

from datetime import datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import Conflict
from app.features.movement.files import drop_unused
from app.features.movement.humanoids.service import humanoid_by_hash
from app.features.movement.humanoids.use import configurations_with
from app.features.people.audit import record
from app.models import AvatarTuningRow, HumanoidRow, SessionEvent

COMPANION_CHOSEN = "companion_chosen"
"""The session's event with the body of a companion (`app.features.record.sessions`)."""


def remove_body(db: Session, actor: str, content_hash: str, now: datetime) -> None:
    """Remove a body and its file.

    Raises NotFound, and Conflict if it comes with Reembody, has a name, or is used.
    """
    # Whoever saves a configuration locks its body as well, so none is saved meanwhile.
    row = humanoid_by_hash(db, content_hash, lock=True)
    _require_unused(db, row)
    db.delete(row)
    db.flush()
    drop_unused(db, content_hash)
    record(
        db,
        actor=actor,
        action="humanoid.removed",
        subject=f"humanoid:{content_hash[:12]}",
        details={"content": content_hash[:12]},
        now=now,
    )


def _require_unused(db: Session, row: HumanoidRow) -> None:
    if row.origin == "shipped":
        raise Conflict(
            "this body comes with Reembody, and stays",
            value=row.hash,
            valid="a body that was uploaded",
            remedy="Leave it; studies wear only the bodies that they name.",
        )
    if row.name is not None:
        raise Conflict(
            f"this body is called {row.name!r}, by which studies and records may refer to it",
            value=row.hash,
            valid="a body without a name",
            remedy="Leave it; studies wear only the bodies that they name.",
        )
    used = [f"{one.key}, version {one.version}" for one in configurations_with(db, row.hash)]
    if used:
        raise Conflict(
            f"avatar configurations use this body: {'; '.join(used)}",
            value=row.hash,
            valid="a body that no version of a configuration uses",
            remedy="Leave it; versions of configurations are kept for good.",
        )
    tunings = select(AvatarTuningRow.id).where(AvatarTuningRow.canonical_json.contains(row.hash))
    if db.scalar(tunings.limit(1)) is not None:
        raise Conflict(
            "a tuning of an avatar uses this body",
            value=row.hash,
            valid="a body that no tuning uses",
            remedy="Delete the tuning first, in the avatar's editor.",
        )
    shown = select(SessionEvent.session_id).where(
        SessionEvent.type == COMPANION_CHOSEN, SessionEvent.payload.contains(row.hash)
    )
    if db.scalar(shown.limit(1)) is not None:
        raise Conflict(
            "a participant was shown a companion with this body",
            value=row.hash,
            valid="a body that no session has shown",
            remedy="Leave it; the record says what a participant saw.",
        )
