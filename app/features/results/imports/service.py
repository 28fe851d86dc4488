"""Imports: apply the mapping, store a file's forms, undo an import, erase a participant."""

from datetime import datetime
from typing import Any, cast

from sqlalchemy import CursorResult, delete, insert, select
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput, NotFound
from app.features.design.instruments import newest_instruments, parsed_instruments
from app.features.design.studies import newest_version, protocol_of
from app.features.people.audit import record
from app.features.results.imports.applying import Applied, Form, apply_mapping
from app.features.results.imports.repository import active_import
from app.features.results.imports.schemas import ImportRequest, Mapping
from app.features.results.imports.sheet import read_sheet
from app.models import AnswerImport, ImportedForm, Study, new_id
from app.protocol import sha256_of
from app.science.instruments import Instrument

_SHOWN_PROBLEMS = 200


def applied_to(
    db: Session, study: Study, text: str, mapping: Mapping
) -> tuple[Instrument, Applied]:
    """Return the instrument and the forms of a file.

    Raises InvalidInput for unknown items, conditions and columns.
    """
    instrument = known_instrument(parsed_instruments(db), mapping.instrument)
    for item in [*(key for one in mapping.sets for key in one.items), *mapping.turned]:
        if item not in instrument.by_key:
            raise InvalidInput(
                f"the instrument {instrument.key!r} has no item {item!r}",
                value=item,
                valid=list(instrument.by_key),
            )
    keys = frozenset(one.key for one in protocol_of(newest_version(db, study)).conditions)
    unknown = sorted(set(mapping.conditions.values()) - keys)
    if unknown:
        raise InvalidInput(
            f"the study has no condition {unknown[0]!r}", value=unknown[0], valid=sorted(keys)
        )
    sheet = read_sheet(text, mapping.header_rows)
    return instrument, apply_mapping(sheet, mapping, instrument, keys)


def known_instrument(instruments: dict[str, Instrument], key: str) -> Instrument:
    """Return the instrument with this key; raise NotFound if there is none."""
    if key not in instruments:
        raise NotFound(f"there is no instrument {key!r}", value=key, valid=sorted(instruments))
    return instruments[key]


def import_answers(
    db: Session, study: Study, request: ImportRequest, *, actor: str, now: datetime
) -> AnswerImport:
    """Store every form of a file, or none.

    Raises InvalidInput with each invalid cell, Conflict if this file was imported before.
    """
    mapping = request.mapping
    instrument, applied = applied_to(db, study, request.text, mapping)
    content_hash = sha256_of(request.text)
    # If the same file is imported twice concurrently, the second waits here and is then rejected.
    db.execute(select(Study.id).where(Study.id == study.id).with_for_update(key_share=True))
    _reject_duplicate(db, study, mapping.instrument, content_hash)
    if applied.problems or not applied.forms:
        raise InvalidInput(
            f"{len(applied.problems)} cells cannot be imported; nothing was stored"
            if applied.problems
            else "the file contains no answers; nothing was stored",
            remedy="Correct the file or the meaning of its columns, then try again.",
            details=[one.model_dump() for one in applied.problems[:_SHOWN_PROBLEMS]],
        )
    row = AnswerImport(
        id=new_id(),
        study_id=study.id,
        instrument_version_id=newest_instruments(db)[instrument.key].id,
        instrument=instrument.key,
        file_name=request.file_name,
        content_hash=content_hash,
        mapping=mapping.model_dump(mode="json"),
        forms=len(applied.forms),
        imported_at=now,
        imported_by=actor,
    )
    db.add(row)
    db.flush()
    db.execute(insert(ImportedForm), [_row(form, row) for form in applied.forms])
    details = {"study": study.key, "instrument": row.instrument, "forms": row.forms}
    record(
        db,
        actor=actor,
        action="answer.imported",
        subject=f"import:{row.id}",
        details=details | {"content_hash": content_hash},
        now=now,
    )
    return row


def undo(db: Session, row: AnswerImport, *, reason: str, actor: str, now: datetime) -> None:
    """Delete the forms of an import; raise Conflict if it was undone before."""
    if row.undone_at is not None:
        raise Conflict(
            "this import was already undone", value=row.id, remedy="There is nothing left to undo."
        )
    deleted = _count(db, delete(ImportedForm).where(ImportedForm.import_id == row.id))
    row.undone_at, row.undone_by, row.undone_reason = now, actor, reason
    db.flush()
    record(
        db,
        actor=actor,
        action="answer.import_undone",
        subject=f"import:{row.id}",
        details={"forms": deleted},
        now=now,
    )


def forget_participant(db: Session, study_id: str, code: str) -> int:
    """Delete a participant's imported forms; return how many there were."""
    own = (ImportedForm.study_id == study_id) & (ImportedForm.participant_code == code)
    return _count(db, delete(ImportedForm).where(own))


def _reject_duplicate(db: Session, study: Study, instrument: str, content_hash: str) -> None:
    existing = active_import(db, study, instrument, content_hash)
    if existing is not None:
        raise Conflict(
            "this file has already been imported as answers to the same instrument",
            value=existing.file_name,
            remedy="Open that import. If it was wrong, undo it first.",
            details=[{"import_id": existing.id, "imported_at": existing.imported_at.isoformat()}],
        )


def _row(form: Form, of: AnswerImport) -> dict[str, Any]:
    return {
        "id": new_id(),
        "import_id": of.id,
        "study_id": of.study_id,
        "line": form.line,
        "participant_code": form.participant_code,
        "condition": form.condition,
        "in_study": form.in_study,
        "answered_on": None if form.answered_on is None else form.answered_on.isoformat(),
        "answers": form.answers,
        "scores": form.scores,
    }


def _count(db: Session, statement: Any) -> int:
    done = db.execute(statement.execution_options(synchronize_session=False))
    return cast("CursorResult[Any]", done).rowcount


def erase_imported(
    db: Session, study: Study, code: str, *, confirm: str, actor: str, now: datetime
) -> int:
    """Erase a participant's imported answers; return how many forms there were.

    Raises InvalidInput if `confirm` differs from the code, NotFound if no file has the code.
    """
    if confirm != code:
        raise InvalidInput(
            "the typed code is not this participant's",
            value=confirm,
            valid=code,
            remedy="Type the code as shown in the list, to confirm the participant.",
        )
    deleted = forget_participant(db, study.id, code)
    if not deleted:
        raise NotFound("no imported answers have this code", value=code)
    details = {"forms": deleted}
    subject = f"study:{study.key}"
    action = "answer.imported_erased"
    record(db, actor=actor, action=action, subject=subject, details=details, now=now)
    return deleted
