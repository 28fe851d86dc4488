"""Repeat erasures in a database from an older backup, which still has the erased data."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass, field

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import NotDurable
from app.features.care.rights.erasing import erase_now, erasure_of, locked_sessions
from app.features.care.rights.tombstones import Tombstone, moment, tombstone_file, tombstones_of
from app.features.people.audit import record
from app.features.record.erasure import finish_overwriting, mark_erasure
from app.models import Participant, StudySession
from app.platform.context import AppContext

REPEATED = "restored"
"""The reason code of a repeated erasure."""
log = logging.getLogger(__name__)


@dataclass
class ErasureReplay:
    """Repeats, in a restore's transaction, the erasures that the restore undoes.

    `snapshot` is called before the rows are replaced, `reapply` after it. `given`: erasures of an
    earlier installation, which apply here, too.
    """

    context: AppContext
    given: Sequence[Tombstone] = ()
    _tombstones: dict[str, Tombstone] = field(default_factory=dict)

    def snapshot(self, db: Session) -> None:
        """Remember every erasure in the table or in the list next to the database."""
        listed = tombstone_file(self.context.settings).read()
        remembered = (*self.given, *listed, *tombstones_of(db))
        self._tombstones = {one.erasure_id: one for one in remembered}

    def reapply(self, db: Session) -> int:
        """Repeat the erasures that the restored rows undid; return how many there were."""
        return repeat_erasures(db, self.context, list(self._tombstones.values()))


def repeat_erasures(db: Session, context: AppContext, remembered: Sequence[Tombstone]) -> int:
    """Erase every participant with sessions in the database whose data were erased before."""
    done = 0
    for one in remembered:
        owners = db.scalars(
            select(StudySession.participant_id)
            .where(StudySession.id.in_(one.sessions))
            .distinct()
            .order_by(StudySession.participant_id)
        ).all()
        for participant_id in owners:
            if erasure_of(db, participant_id) is None:
                _repeat_erasure(db, context, one, participant_id)
                done += 1
    return done


def _repeat_erasure(db: Session, context: AppContext, one: Tombstone, participant_id: str) -> None:
    participant = db.get_one(Participant, participant_id)
    sessions = locked_sessions(db, participant)
    erasure = erase_now(
        db,
        context,
        participant,
        sessions,
        erasure_id=one.erasure_id,
        by=one.by,
        at=moment(one),
        why=REPEATED,
    )
    record(
        db,
        actor="system",
        action="participant.erased_again",
        subject=f"participant:{participant.code}",
        details={"erasure": erasure.id, "removed": erasure.removed},
        now=context.clock.utc_now(),
    )


def finish_erasures(context: AppContext) -> int:
    """Complete the list, repeat undone erasures and overwrite remaining bytes at a start.

    Returns how many erasures were repeated: they were undone if somebody put an older file in the
    database's place.
    """
    database, settings = context.database, context.settings
    listed = tombstone_file(settings).read()
    repeated = 0
    if listed:
        with database.writing() as db:
            repeated = repeat_erasures(db, context, listed)
    try:
        keep_tombstones(context)
    except NotDurable as error:
        log.warning("%s. %s", error.message, error.remedy)
    if repeated:
        mark_erasure(settings)
        log.warning("%d erasure(s) that the database did not know were made again", repeated)
    finish_overwriting(database, settings)
    return repeated


def knows_erasures(context: AppContext) -> bool:
    """Return whether the table or the list of erasures exists, even if the list is empty."""
    if tombstone_file(context.settings).path.exists():
        return True
    with context.database.reading() as db:
        return bool(tombstones_of(db))


def keep_tombstones(context: AppContext) -> None:
    """Complete the list next to the database from its table; raise NotDurable if that fails."""
    with context.database.reading() as db:
        remembered = tombstones_of(db)
    tombstone_file(context.settings).add(remembered)
