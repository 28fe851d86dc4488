"""The rows of long jobs: ordered, stopped, resumed, removed, and recorded in the audit trail.

A tuning of an avatar, a fit of a model of walking and a pilot of a study are such jobs: each has a
row, whose state says whether it is to run, and a queue that follows it (`platform.resumable_jobs`).
A `JobKind` has what differs between them. Its functions change rows within the caller's
transaction; the caller lets the queue follow after the commit.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Generic, TypeVar

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.errors import Busy, NotFound, NotNow
from app.features.people.audit import record
from app.models import AvatarTuningRow, PilotRow, WalkingModelRow
from app.platform.access import Caller
from app.platform.context import AppContext

Row = TypeVar("Row", AvatarTuningRow, PilotRow, WalkingModelRow)
MOST_AT_ONCE: Final = 20
"""Maximum number of unfinished jobs of a kind that run or wait; the next one is refused."""


@dataclass(frozen=True)
class JobKind(Generic[Row]):
    """A kind of job.

    Attributes:
        table: the table of its rows.
        noun: what a job of this kind is called.
        running: the state of a job that runs or waits.
        action: what its actions are called in the audit trail, without `_stopped` and the like.
        subject: what a job is called there, before its id.
        details: what the audit trail says about a job; no names or titles, which cannot be erased.
    """

    table: type[Row]
    noun: str
    running: str
    action: str
    subject: str
    details: Callable[[Row], dict[str, object]]

    def by_id(self, db: Session, job_id: str, *, lock: bool = False) -> Row:
        """Return the job with this id; raise NotFound if there is none."""
        row = db.get(self.table, job_id, with_for_update=lock)
        if row is None:
            raise NotFound(
                f"there is no such {self.noun}",
                value=job_id,
                remedy="Choose one of the list; somebody may have deleted it meanwhile.",
            )
        return row

    def newest_first(self, db: Session) -> Sequence[Row]:
        """Return all jobs, newest first."""
        return db.scalars(select(self.table).order_by(self.table.at.desc(), self.table.id)).all()

    def ready(self, db: Session, job_id: str) -> Row:
        """Return a job that has its result; raise NotFound or NotNow."""
        row = self.by_id(db, job_id)
        if row.state != "ready":
            raise NotNow(
                f"this {self.noun} is not ready yet",
                value=row.state,
                valid="ready",
                remedy="Wait until it is, or resume it.",
            )
        return row

    def order(self, db: Session, context: AppContext, caller: Caller, row: Row) -> None:
        """Store a new job; raise Busy if too many are unfinished."""
        self._require_room(db)
        db.add(row)
        db.flush()
        self._record(db, context, caller, row, "ordered")

    def stop(self, db: Session, context: AppContext, caller: Caller, job_id: str) -> None:
        """Mark a job as stopped; raise NotFound, or NotNow if it does not run."""
        row = self._in_state(db, job_id, self.running)
        row.state = "stopped"
        db.flush()
        self._record(db, context, caller, row, "stopped")

    def resume(self, db: Session, context: AppContext, caller: Caller, job_id: str) -> None:
        """Mark a stopped or failed job as running; raise NotFound, NotNow or Busy."""
        row = self._in_state(db, job_id, "stopped", "failed")
        self._require_room(db)
        row.state, row.trouble, row.ended_at = self.running, None, None
        db.flush()
        self._record(db, context, caller, row, "resumed")

    def remove(
        self,
        db: Session,
        context: AppContext,
        caller: Caller,
        job_id: str,
        then: Callable[[Row], None] = lambda _: None,
    ) -> None:
        """Delete a job, finished or not; raise NotFound. `then` deletes what belonged to it."""
        row = self.by_id(db, job_id, lock=True)
        db.delete(row)
        db.flush()
        then(row)
        # Last, as `record` asks for.
        self._record(db, context, caller, row, "removed")

    def _in_state(self, db: Session, job_id: str, *states: str) -> Row:
        row = self.by_id(db, job_id, lock=True)
        if row.state not in states:
            raise NotNow(
                f"the {self.noun} is {row.state}",
                value=row.state,
                valid=list(states),
                remedy="Reload the page: it has ended, or somebody else has changed its state.",
            )
        return row

    def _require_room(self, db: Session) -> None:
        unfinished = select(func.count()).where(self.table.state == self.running)
        count = db.scalars(unfinished).one()
        if count >= MOST_AT_ONCE:
            raise Busy(
                f"{count} {self.noun}s run or wait already, so none was added",
                value=count,
                valid=f"up to {MOST_AT_ONCE} at once",
                remedy="Wait until one has ended, or stop one.",
            )

    def _record(
        self, db: Session, context: AppContext, caller: Caller, row: Row, done: str
    ) -> None:
        record(
            db,
            actor=caller.actor,
            action=f"{self.action}_{done}",
            subject=f"{self.subject}:{row.id}",
            details=self.details(row),
            now=context.clock.utc_now(),
        )
