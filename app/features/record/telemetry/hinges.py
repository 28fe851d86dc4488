"""What the avatar of a session is asked for, if hinges move it."""

from sqlalchemy.orm import Session

from app.features.movement.avatar.service import configuration_by_hash
from app.features.movement.humanoids.service import figure_by_hash
from app.platform.access import session_by_id
from app.science.avatar.targets.hinge_reference import HingeReference


def hinges_of(db: Session, session_id: str) -> HingeReference | None:
    """The hinges as the session's configuration has them; None for a delayed copy.

    The first one in a process loads the compiler, which takes a second: not for the event loop.
    Raises NotFound where there is no such session.
    """
    content_hash = session_by_id(db, session_id).avatar_configuration_hash
    if content_hash is None:
        return None
    configuration = configuration_by_hash(db, content_hash)
    figure = figure_by_hash(db, configuration.humanoid)
    # What a model lacks is left out of the body, whatever the configuration says about it.
    parts = [part for part in configuration.parts if figure is None or part in figure.places_m]
    return HingeReference(configuration.in_force, parts)
