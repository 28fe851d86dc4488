"""Exporting a study: one consistent look at the database, as a folder or as an archive."""

from collections.abc import Generator, Iterable, Iterator
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from itertools import chain
from pathlib import Path

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.database import Database
from app.features.design.studies import study_by_key
from app.features.people.audit import TrailHead
from app.features.results.analysis.tables import Kind
from app.features.results.exports.writing.archive import zip_pieces
from app.features.results.exports.writing.contents import Contents, Member
from app.features.results.exports.writing.folder import Progress, silent, write_folder
from app.models import StudySession
from app.platform.half_made import Notes, made_beside


@dataclass(frozen=True)
class Exported:
    """What was written where, and the head of the audit trail then.

    `revealed`: sessions of a blinded study that are not completed and tell their condition.
    """

    to: Path
    kind: Kind
    sessions: int
    files: int
    audit_head: TrailHead
    revealed: frozenset[str] = frozenset()


def export_study(
    db: Session,
    study_key: str,
    kind: Kind,
    to: Path,
    *,
    now: datetime,
    notes: Notes | None = None,
    progress: Progress = silent,
) -> Exported:
    """Write the study's sessions of one kind to the folder `to`.

    `notes` keep a note of it while it is made, so that nothing half-made outlives an erasure.

    Raises NotFound for an unknown study, Conflict where something else is at `to`, OSError where it
    cannot be written; in each case nothing has changed.
    """
    contents = Contents(db, study_key, kind, now)
    beside = partial(made_beside, "export", now=now, notes=notes, study_key=study_key)
    write_folder(contents.members(), to, beside=beside, progress=progress)
    return Exported(
        to,
        kind,
        contents.sessions,
        len(contents.files) + 1,
        contents.audit_head,
        contents.revealed,
    )


def study_archive(
    database: Database, study_key: str, kind: Kind, *, now: datetime
) -> Generator[bytes]:
    """The same as one ZIP file, in pieces; close the iterator to stop early."""
    with database.reading() as db:
        yield from zip_pieces(Contents(db, study_key, kind, now).members(), now)


def person_archive(
    db: Session,
    study_key: str,
    kind: Kind,
    sessions: frozenset[str],
    more: Iterable[Member],
    *,
    now: datetime,
) -> Iterator[bytes]:
    """`more` and the files of these sessions only, as one ZIP file in pieces."""
    contents = Contents(db, study_key, kind, now, only=sessions)
    return zip_pieces(chain(more, contents.members()), now)


def usual_kind(db: Session, study_key: str) -> Kind:
    """The kind to export when none was named: people, or what there is if there are no people.

    So a rehearsed study can be exported without a word, and simulated sessions never stand beside
    people's unless somebody asks for all.
    """
    study = study_by_key(db, study_key)
    there = set(db.scalars(select(StudySession.kind).where(StudySession.study_id == study.id)))
    if "people" in there or not there:
        return "people"
    return "simulated" if "simulated" in there else "test"
