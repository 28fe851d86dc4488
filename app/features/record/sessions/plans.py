"""The procedure that a session follows, step by step."""

from functools import lru_cache

from sqlalchemy.orm import Session

from app.features.record.ledger.service import slot_of
from app.models import StudySession, StudyVersion
from app.platform.immutable_cache import Unchanging
from app.protocol import parse_study_json
from app.protocol.plan import Step, compile_plan

_plans: Unchanging[str, tuple[Step, ...]] = Unchanging(1024)


def plan_of(db: Session, session: StudySession) -> tuple[Step, ...]:
    """The procedure of this session: its protocol in its own order of conditions.

    A session's version and slot never change, so neither does its plan.
    """
    return _plans.get(db, session.id, lambda: _read(db, session))


def _read(db: Session, session: StudySession) -> tuple[Step, ...]:
    version = db.get_one(StudyVersion, session.study_version_id)
    slot = slot_of(db, session)
    return _compiled(version.canonical_json, tuple(slot.sequence), slot.position % 2 == 1)


@lru_cache(maxsize=256)
def _compiled(canonical_json: str, sequence: tuple[str, ...], flip: bool) -> tuple[Step, ...]:  # noqa: FBT001 - a cache key
    return compile_plan(parse_study_json(canonical_json), sequence, block_limb_flip=flip)
