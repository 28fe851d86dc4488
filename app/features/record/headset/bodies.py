"""The bodies that a headset may fetch: those that its session's avatar can wear.

They are the body of the avatar's configuration and those that the study's conditions name, all of
them at any time. So neither an answer nor a request tells which body comes next.
"""

from sqlalchemy.orm import Session

from app.errors import NotFound
from app.features.movement.avatar import configuration_by_hash
from app.features.movement.humanoids import named_bodies
from app.features.record.sessions import protocol_of_session
from app.models import StudySession
from app.platform.access import session_by_id


def require_own_body(db: Session, session_id: str, content_hash: str) -> None:
    """Raise NotFound unless the session's avatar can wear the model with this hash."""
    if content_hash not in bodies_of(db, session_by_id(db, session_id)):
        raise NotFound(
            "the avatar of this session wears no such body",
            value=content_hash,
            remedy="Fetch the bodies that POST /api/vr/avatar names as 'humanoid'.",
        )


def bodies_of(db: Session, session: StudySession) -> frozenset[str]:
    """Return the hashes of all models that the session's avatar can wear."""
    if session.avatar_configuration_hash is None:
        return frozenset()
    configured = configuration_by_hash(db, session.avatar_configuration_hash).humanoid
    named = named_bodies(db)
    prescribed = (named.get(name) for name in protocol_of_session(db, session).bodies)
    return frozenset(one for one in (configured, *prescribed) if one is not None)
