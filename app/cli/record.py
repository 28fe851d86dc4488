"""Export a study to a folder, and verify sessions and the audit trail, from the command line."""

import json
import sqlite3
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session

from app.cli.errors import warn
from app.cli.installation import opened_database
from app.cli.progress import Activity
from app.cli.stored_versions import verified_versions
from app.clock import Clock
from app.database import Database
from app.errors import NotFound
from app.features.design.studies import study_by_key
from app.features.people.audit import (
    COMMAND_LINE,
    AuditCheck,
    TrailHead,
    contains_head,
    record,
    record_copy,
    verify_trail,
)
from app.features.record.receipts import SessionReceipt, receipt_of, receipt_text
from app.features.results.analysis.tables import KINDS, Kind
from app.features.results.exports.writing import Exported, export_study, usual_kind
from app.models import Study
from app.platform.access import hidden_sessions, session_by_id
from app.platform.incomplete_files import Notes
from app.platform.trouble import not_durable_error
from app.settings import read_settings


def export_to_folder(study: str, to: Path, activity: Activity, kind: str | None = None) -> str:
    """Export a study of this installation to a folder; return a summary.

    Without a `kind`: people's sessions, or those of another kind if there are none. `activity`
    shows the file that is being written. Raises ValueError for an unknown kind; ReembodyError for
    an unknown study, a folder that is not an earlier export, or a write error.
    """
    notes = Notes.of(read_settings())
    with opened_database("export") as database, database.reading() as db:
        chosen = usual_kind(db, study) if kind is None else _checked_kind(kind)
        try:
            done = export_study(
                db,
                study,
                chosen,
                to,
                now=Clock().utc_now(),
                notes=notes,
                progress=lambda path: activity.now(f"exporting {study}: writing {path}"),
            )
        except OSError as error:
            raise not_durable_error(f"the export to {to} could not be written", error) from error
        _put_on_record(database, study, done)
    return (
        f"{done.sessions} session(s) of kind {done.kind} in {done.files} files: {to}\n"
        f"audit head {done.audit_head}"
    )


def _put_on_record(database: Database, study: str, done: Exported) -> None:
    """Record that a copy left the database; if that fails, warn, since the export is complete."""
    try:
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
            if done.revealed:
                record(
                    db,
                    actor=COMMAND_LINE,
                    action="study.exported",
                    subject=f"study:{study}",
                    details={"kind": done.kind, "revealed": sorted(done.revealed)},
                    now=Clock().utc_now(),
                )
    except (DBAPIError, sqlite3.Error) as error:
        warn(
            f"the export is complete but could not be recorded ({getattr(error, 'orig', error)}):"
            " remember where it is when a participant's data are erased"
        )


def _checked_kind(kind: str) -> Kind:
    for valid in KINDS:
        if kind == valid:
            return valid
    raise ValueError(f"unknown kind {kind!r}; valid are {', '.join(KINDS)}")


def heads_of(texts: Sequence[str]) -> tuple[TrailHead, ...]:
    """Parse heads of the audit trail, SEQ:HASH, as backups and exports print them.

    Raises InvalidInput for an invalid head.
    """
    return tuple(TrailHead.parse(text) for text in texts)


def verify_record(
    session_id: str | None, heads: Sequence[TrailHead], activity: Activity, *, as_json: bool
) -> tuple[str, bool]:
    """Verify a session, the audit trail or both; return the findings and whether all is well.

    The findings are text or JSON. The trail is verified if no session is named, or if there are
    `heads`: each must still be in it. If no session is named, every version of an avatar, a study
    and an instrument must also be readable and have the content that its hash was computed from;
    what is unaltered but cannot be used is reported. A server may run meanwhile. Raises
    ReembodyError for an unknown session.
    """
    parts: list[str] = []
    found: dict[str, Any] = {}
    holds = True
    with opened_database("verify") as database, database.reading() as db:
        if session_id is not None:
            activity.now(f"verifying: reading session {session_id}")
            receipt = _receipt(db, session_id)
            found, holds = receipt.as_json(), receipt.complete
            parts.append(receipt_text(receipt))
        if session_id is None or heads:
            activity.now("verifying: reading the audit trail")
            trail = _check_trail(db, heads)
            holds = holds and trail.holds
            parts.append(trail.text())
            found = {**found, "audit": trail.as_json()}
        if session_id is None:
            activity.now("verifying: reading the versions of avatars, studies and instruments")
            for versions in verified_versions(db):
                holds = holds and versions.holds
                parts.append(versions.text())
                found[versions.kind] = versions.as_json()
    return json.dumps(found, indent=2) if as_json else "\n\n".join(parts), holds


def _receipt(db: Session, session_id: str) -> SessionReceipt:
    """Return a session's receipt, as blinded readers see it while its condition is hidden."""
    try:
        study = db.get_one(Study, session_by_id(db, session_id).study_id)
        return receipt_of(db, session_id, blinded=session_id in hidden_sessions(db, study))
    except NotFound as error:
        raise NotFound(
            f"there is no session {session_id!r}",
            value=session_id,
            remedy="Its id is at the end of the address of its page, and in sessions.csv.",
        ) from error


@dataclass(frozen=True)
class _Trail:
    """The result of verifying the audit trail: its chain, and which heads are still in it."""

    check: AuditCheck
    heads: tuple[tuple[TrailHead, bool], ...]

    @property
    def holds(self) -> bool:
        return self.check.ok and all(there for _, there in self.heads)

    def text(self) -> str:
        check = self.check
        lines = [
            f"The audit trail verifies: {check.entries} entries, none of which was changed."
            if check.ok
            else f"The audit trail does not verify: entry {check.broken_at} was changed or removed."
        ]
        for head, there in self.heads:
            lines.append(
                f"Head {head} is in it: nothing up to that entry was changed or removed."
                if there
                else f"Head {head} is not in it: entries were removed or rewritten, or an older "
                "backup was restored."
            )
        return "\n".join([*lines, f"audit head {check.head}"])

    def as_json(self) -> dict[str, Any]:
        return {
            "ok": self.holds,
            "entries": self.check.entries,
            "broken_at": self.check.broken_at,
            "head": str(self.check.head),
            "heads": [{"head": str(head), "found": there} for head, there in self.heads],
        }


def _check_trail(db: Session, heads: Sequence[TrailHead]) -> _Trail:
    return _Trail(verify_trail(db), tuple((head, contains_head(db, head)) for head in heads))
