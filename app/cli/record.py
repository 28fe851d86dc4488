"""What leaves the record from the command line: a study as a folder, a session's receipt."""

import json
import sys
from pathlib import Path

from app.cli.installation import opened_database
from app.clock import Clock
from app.database import Database
from app.errors import NotFound
from app.features.design.studies import study_by_key
from app.features.people.audit import COMMAND_LINE, record_copy
from app.features.record.receipts import receipt_of, receipt_text
from app.features.results.analysis.tables import KINDS, Kind
from app.features.results.exports.writing import Exported, export_study, usual_kind


def export_to_folder(study: str, to: Path, kind: str | None = None) -> str:
    """Export a study of this installation to a folder; one sentence on what was written.

    Without a `kind`: people's sessions, or what there is if there are none of people. Says on
    standard error which file it is at. Raises ValueError for an unknown kind, ReembodyError for an
    unknown study or a folder that is not ours to replace, OSError where it cannot be written.
    """
    with opened_database() as database, database.reading() as db:
        chosen = usual_kind(db, study) if kind is None else _known(kind)
        done = export_study(db, study, chosen, to, now=Clock().utc_now(), progress=_tell_progress)
        _put_on_record(database, study, done)
    return f"{done.sessions} session(s) of kind {done.kind} in {done.files} files: {to}"


def _put_on_record(database: Database, study: str, done: Exported) -> None:
    """A copy left the database."""
    with database.writing() as db:
        record_copy(
            db,
            kind="export",
            study_id=study_by_key(db, study).id,
            session_kind=done.kind,
            place=str(done.to.absolute()),
            by=COMMAND_LINE,
            now=Clock().utc_now(),
            sessions=done.sessions,
        )


def _known(kind: str) -> Kind:
    for known in KINDS:
        if kind == known:
            return known
    raise ValueError(f"unknown kind {kind!r}; valid are {', '.join(KINDS)}")


def _tell_progress(path: str) -> None:
    if sys.stderr.isatty():
        sys.stderr.write(f"\r\033[Kwriting {path}" if path != "README.txt" else "\r\033[K")
        sys.stderr.flush()


def verify_session(session_id: str, *, as_json: bool) -> tuple[str, bool]:
    """The receipt of a session of this installation as text or JSON, and whether it is complete.

    Reads beside a running server. Raises ReembodyError for an unknown session.
    """
    with opened_database() as database, database.reading() as db:
        try:
            receipt = receipt_of(db, session_id)
        except NotFound as error:
            raise NotFound(
                f"there is no session {session_id!r}",
                value=session_id,
                remedy="Its id stands at the end of the address of its page, and in sessions.csv.",
            ) from error
    text = json.dumps(receipt.as_json(), indent=2) if as_json else receipt_text(receipt)
    return text, receipt.complete
