"""Back up and restore a database, for use by other features."""

import sqlite3
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol

from sqlalchemy import Select, column, select, table
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session

from app.clock import Clock
from app.database import Database
from app.errors import Conflict
from app.features.care.backups.manifest import Manifest
from app.features.care.backups.reading import (
    Backup,
    as_newest,
    digests,
    opened_backup,
    opened_copy,
    require_ours,
)
from app.features.care.backups.restoring import hold_still, is_empty, replace_rows
from app.features.care.backups.rows import Progress, silent
from app.features.care.backups.shapes import shapes_of
from app.features.care.backups.writing import write_backup
from app.features.people.audit import head_of
from app.features.record.devices import devices_of_session, revoke
from app.models import AuditHead, Participant, StudySession
from app.platform.incomplete_files import Notes

ENDING = ".reembody"
_S_PER_NS = 1e-9


@dataclass(frozen=True)
class BackedUp:
    """A finished backup; `sha256` is over its content: equal for equal content.

    `audit_head`: the newest entry of the audit trail in it, as SEQ:HASH; None in a schema that had
    no trail yet.
    """

    path: Path
    made_at: datetime
    revision: str
    rows: int
    size_bytes: int
    duration_s: float
    sha256: str
    audit_head: str | None


@dataclass(frozen=True)
class Restored:
    """A committed restore.

    `made_at`: when the backup was made. `before`: the backup of the replaced rows, if there were
    any. `unpaired`: number of headsets that must be paired again. `erasures_reapplied`: number of
    participants in the backup whose data had been erased since, and were erased again.
    """

    path: Path
    made_at: datetime
    rows: int
    duration_s: float
    sha256: str
    before: Path | None
    unpaired: int
    erasures_reapplied: int


class LastingChanges(Protocol):
    """Changes that a restore must not undo; called inside its transaction."""

    def snapshot(self, db: Session) -> None:
        """Read the changes while the rows to be replaced are still there."""

    def reapply(self, db: Session) -> int:
        """Apply the changes to the backup's rows, and return how many there were."""


def back_up(
    database: Database,
    to: Path,
    *,
    clock: Clock,
    notes: Notes | None = None,
    progress: Progress = silent,
) -> BackedUp:
    """Copy the current content of the database to the new file `to`, without blocking anybody.

    `notes` record the temporary file while it is written, if it is outside of the data folder.

    On SQLite the write-ahead log cannot be emptied before the copy is finished, and grows
    meanwhile. Raises Conflict, NotFound or NotDurable; then nothing is left of the file.
    """
    began_ns = clock.monotonic_ns()
    with database.reading() as db:
        manifest = write_backup(
            db.connection(), to, now=clock.utc_now(), notes=notes, progress=progress
        )
        head = str(head_of(db)) if AuditHead.__tablename__ in manifest.tables else None
    return BackedUp(
        path=to,
        made_at=manifest.made_at,
        revision=manifest.revision,
        rows=manifest.rows,
        size_bytes=to.stat().st_size,
        duration_s=(clock.monotonic_ns() - began_ns) * _S_PER_NS,
        sha256=manifest.sha256,
        audit_head=head,
    )


@contextmanager
def checked_backup(path: Path, workplace: Path, progress: Progress = silent) -> Iterator[Backup]:
    """Open a backup in the newest schema, with all checks passed; the database is not touched.

    One of an earlier version is copied into the folder `workplace` and migrated there. Raises
    NotFound or InvalidInput for a file that is missing, damaged, not a Reembody backup, or of a
    newer program, and for one whose tables and values this program cannot have written.
    """
    with opened_backup(path, progress) as given, as_newest(given, workplace) as backup:
        require_ours(backup)
        yield backup


def holds_people(backup: Backup) -> bool:
    """Return whether the backup contains participants of the kind `people`."""
    people: Select[tuple[Any]] = (
        select(column("id")).select_from(table("participants")).where(column("kind") == "people")
    )
    return backup.connection.execute(people.limit(1)).first() is not None


def restore(
    database: Database,
    backup: Backup,
    *,
    keep_in: Path,
    clock: Clock,
    replace: bool,
    even_though_active: bool = False,
    erasures: LastingChanges | None = None,
    content: Callable[[Session], None] | None = None,
    progress: Progress = silent,
) -> Restored:
    """Replace everything in `database`, whose schema must be the newest, by the backup.

    All in one transaction: other readers see either the previous content or the whole backup. Rows
    to be replaced are backed up into the folder `keep_in` first, inside the same transaction, so
    that nothing can be written in between.

    The headset of an open session has discarded what was acknowledged to it after the backup, so
    the data that it sends next would have a gap: it has to be paired again, which begins a new run.

    Raises Conflict if sessions are active or rows would be replaced and the caller did not
    allow it, NotDurable if there is no space; then nothing has changed.

    Every command that restores must pass `erasures` and `content`. The first repeats erasures that
    are newer than the backup, so that nobody ever sees erased data again. The second checks the
    rows before they are committed, and rejects them by raising ReembodyError.
    """
    began_ns = clock.monotonic_ns()
    with _ReplacedContent(database) as previous, database.writing() as db:
        target = db.connection()
        hold_still(target, backup.shapes)
        if not even_though_active:
            _refuse_if_active(db)
        if erasures is not None:
            erasures.snapshot(db)
        if not is_empty(target, backup.shapes):
            to = _place_before(backup.path, keep_in, clock.utc_now(), replace=replace)
            previous.manifest = write_backup(target, to, now=clock.utc_now(), progress=progress)
            previous.path = to
        replace_rows(target, backup, progress)
        if content is not None:
            content(db)
        reapplied = 0 if erasures is None else erasures.reapply(db)
        unpaired = _unpair_headsets(db, clock.utc_now())
    return Restored(
        path=backup.path,
        made_at=backup.manifest.made_at,
        rows=sum(table.rows for table in backup.tables.values()),
        duration_s=(clock.monotonic_ns() - began_ns) * _S_PER_NS,
        sha256=backup.manifest.sha256,
        before=previous.path,
        unpaired=unpaired,
        erasures_reapplied=reapplied,
    )


@dataclass
class _ReplacedContent:
    """The backup of what a restore replaces; deleted if the restore fails.

    After a failure the rows are still in the database, and the backup would be an unnecessary copy
    of people's data. But a commit that reported an error may have succeeded, so the content is
    compared first.
    """

    database: Database
    path: Path | None = None
    manifest: Manifest | None = None

    def __enter__(self) -> "_ReplacedContent":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        if kind is None or self.path is None:
            return
        with suppress(DBAPIError, sqlite3.Error, OSError):
            if self._is_still_there():
                self.path.unlink(missing_ok=True)

    def _is_still_there(self) -> bool:
        """Return whether the database still has its previous content, using a new connection."""
        if self.path is None or self.manifest is None:
            return False
        self.database.engine.dispose()
        with opened_copy(self.path) as copy, self.database.reading() as db:
            return digests(db.connection(), shapes_of(copy)) == self.manifest.tables


def stamped(folder: Path, name: str, now: datetime) -> Path:
    """Return the path of an automatic backup, whose name has its reason and time."""
    return folder / f"{name}-{now:%Y%m%dT%H%M%S.%fZ}{ENDING}"


def _place_before(path: Path, keep_in: Path, now: datetime, *, replace: bool) -> Path:
    if not replace:
        raise Conflict(
            "the database is not empty; nothing was changed",
            valid="an empty database",
            remedy=f"With --replace, {path} takes the place of everything in it; "
            f"what is there is backed up to {keep_in} first.",
        )
    keep_in.mkdir(parents=True, exist_ok=True)
    return stamped(keep_in, "before-restore", now)


def _refuse_if_active(db: Session) -> None:
    active = db.execute(
        select(StudySession.id, Participant.code, StudySession.started_at)
        .join(Participant, Participant.id == StudySession.participant_id)
        .where(StudySession.status == "active")
        .order_by(StudySession.started_at)
    ).all()
    if not active:
        return
    names = ", ".join(f"{code} ({session_id})" for session_id, code, _ in active)
    raise Conflict(
        f"{len(active)} session(s) are active: {names}; nothing was changed",
        value=len(active),
        valid=0,
        remedy="Finish or abort them first: a connected headset has already discarded what was "
        "stored. If they cannot be finished any more, use --even-though-active.",
        details=[
            {"session_id": session_id, "participant_code": code, "started_at": str(started_at)}
            for session_id, code, started_at in active
        ],
    )


def _unpair_headsets(db: Session, now: datetime) -> int:
    open_sessions = db.scalars(
        select(StudySession.id).where(StudySession.status.in_(("planned", "active")))
    )
    headsets = [
        device
        for session_id in open_sessions.all()
        for device in devices_of_session(db, session_id)
        if device.kind == "headset"
    ]
    for device in headsets:
        revoke(db, session_id=device.session_id, device_id=device.id, now=now)
    return len(headsets)
