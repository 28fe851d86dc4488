"""From the record of a phase to the bytes of its movement."""

from app.database import Database
from app.features.record.telemetry import hinges_of
from app.features.results.replay.movement import Recording, encode, movement_of
from app.features.results.replay.service import USUAL_STATURE_M, stature_of
from app.features.results.replay.times import phase_clock
from app.models import Phase
from app.platform.access import session_by_id
from app.science.skeleton import build_skeleton


def placed_movement(database: Database, session_id: str, phase_id: int, *, full: bool) -> bytes:
    """The movement of a phase as `movement.encode` makes it; `full`: with the avatar."""
    with database.reading() as db:
        session = session_by_id(db, session_id)
        phase = db.get_one(Phase, (session_id, phase_id))
        clock = phase_clock(db, session, phase)
        recording = Recording(
            session_id,
            phase_id,
            clock.offsets_s,
            clock.duration_s,
            build_skeleton(stature_of(db, session) or USUAL_STATURE_M),
            full=full,
            hinges=hinges_of(db, session_id) if full else None,
        )
        return encode(movement_of(db, recording))
