"""Export a study from one consistent snapshot of the database, as a folder or as an archive."""

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
from app.platform.incomplete_files import Notes, partial_folder


@dataclass(frozen=True)
class Exported:
    """The result of an export to a folder, with the head of the audit trail at that time.

    `revealed`: open sessions of a blinded study whose condition the export shows.
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

    `notes` record the temporary folder while the export is made, so that an erasure also removes an
    unfinished one. Raises NotFound for an unknown study, Conflict if something else is at `to`,
    OSError if it cannot be written; in each case nothing has changed.
    """
    contents = Contents(db, study_key, kind, now)
    temporary_folder = partial(partial_folder, "export", now=now, notes=notes, study_key=study_key)
    write_folder(contents.members(), to, temporary_folder=temporary_folder, progress=progress)
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
    """Yield the study's sessions of one kind as a ZIP file in pieces.

    Close the iterator to stop early.
    """
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
    """Return the pieces of a ZIP file with the files of these sessions and the members `more`."""
    contents = Contents(db, study_key, kind, now, only=sessions)
    return zip_pieces(chain(more, contents.members()), now)


def usual_kind(db: Session, study_key: str) -> Kind:
    """Return the default kind to export: people if there are any, else simulated or test sessions.

    So a rehearsed study can be exported without naming a kind, and simulated sessions are never
    mixed with those of people unless the kind is `all`.
    """
    study = study_by_key(db, study_key)
    there = set(db.scalars(select(StudySession.kind).where(StudySession.study_id == study.id)))
    if "people" in there or not there:
        return "people"
    return "simulated" if "simulated" in there else "test"
