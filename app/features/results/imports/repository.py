"""Query stored imports and convert them to views and CSV."""

import csv
import io
import re
from collections.abc import Iterator, Sequence

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.database import referenced_row
from app.errors import NotFound
from app.features.design.instruments import instrument_of
from app.features.results.imports.schemas import ImportView, Mapping
from app.models import AnswerImport, ImportedForm, InstrumentVersion, Study
from app.science.instruments import Instrument

# As in exports: some spreadsheets treat the full-width forms like the ASCII ones.
_RUNS = re.compile("^(?:[\\t\\r\\n]|[\\s\"'\ufeff\u200b]*[=+\\-@\uff1d\uff0b\uff0d\uff20])")


def imports_of(db: Session, study: Study) -> list[AnswerImport]:
    """Return every import of a study, newest first, including those that were undone."""
    query = select(AnswerImport).where(AnswerImport.study_id == study.id)
    return list(db.scalars(query.order_by(AnswerImport.imported_at.desc(), AnswerImport.id)))


def import_by_id(db: Session, study: Study, import_id: str, *, lock: bool = False) -> AnswerImport:
    """Return an import of this study; raise NotFound if there is none."""
    query = select(AnswerImport).where(
        AnswerImport.id == import_id, AnswerImport.study_id == study.id
    )
    row = db.scalar(query.with_for_update() if lock else query)
    if row is None:
        raise NotFound("there is no such import", value=import_id)
    return row


def forms_of(db: Session, row: AnswerImport) -> list[ImportedForm]:
    """Return the forms of an import, in the order of the file."""
    query = select(ImportedForm).where(ImportedForm.import_id == row.id)
    return list(db.scalars(query.order_by(ImportedForm.line, ImportedForm.id)))


def instrument_of_import(db: Session, row: AnswerImport) -> Instrument:
    """Return the instrument version whose formulas computed the scores of an import."""
    return instrument_of(referenced_row(db, InstrumentVersion, row.instrument_version_id))


def active_import(db: Session, study: Study, key: str, content_hash: str) -> AnswerImport | None:
    """Return the import of a file with the same content that was not undone."""
    return db.scalar(
        select(AnswerImport).where(
            AnswerImport.study_id == study.id,
            AnswerImport.instrument == key,
            AnswerImport.content_hash == content_hash,
            AnswerImport.undone_at.is_(None),
        )
    )


def import_view(db: Session, row: AnswerImport) -> ImportView:
    """Return an import as a response model."""
    codes = select(func.count(ImportedForm.participant_code.distinct()), func.count())
    people, forms = db.execute(codes.where(ImportedForm.import_id == row.id)).one()
    return ImportView(
        id=row.id,
        file_name=row.file_name,
        content_hash=row.content_hash,
        instrument=row.instrument,
        instrument_version=instrument_of_import(db, row).version,
        forms=forms,
        participants=people,
        imported_at=row.imported_at,
        imported_by=row.imported_by,
        undone_at=row.undone_at,
        undone_by=row.undone_by,
        undone_reason=row.undone_reason,
        mapping=Mapping.model_validate(row.mapping),
    )


def as_csv(
    study: Study, instrument: Instrument, row: AnswerImport, forms: Sequence[ImportedForm]
) -> str:
    """Return one row per form: participant, condition, answers, scores, origin = imported."""
    out = io.StringIO(newline="")
    writer = csv.writer(out, lineterminator="\n")
    items, scores = list(instrument.by_key), [one.key for one in instrument.scores]
    own = ["study_key", "origin", "import_id", "line", "participant_code", "condition"]
    writer.writerow([*own, "in_study", "answered_on", "instrument", *items, *scores])
    for form in forms:
        cells = [study.key, "imported", row.id, form.line, form.participant_code, form.condition]
        cells += [str(form.in_study).lower(), form.answered_on, row.instrument]
        cells += [form.answers.get(key) for key in items]
        cells += [form.scores.get(key) for key in scores]
        writer.writerow([_cell(value) for value in cells])
    return out.getvalue()


def _cell(value: object) -> str:
    if value is None:
        return ""
    if isinstance(value, float):
        return repr(int(value)) if value.is_integer() else repr(value)
    text = str(value)
    return f"'{text}" if isinstance(value, str) and _RUNS.match(text) else text


def import_files(db: Session, study: Study) -> Iterator[tuple[str, bytes]]:
    """Yield the name and bytes of a CSV file for each import that was not undone."""
    for row in imports_of(db, study):
        if row.undone_at is None:
            text = as_csv(study, instrument_of_import(db, row), row, forms_of(db, row))
            yield f"{row.instrument}_{row.id}.csv", text.encode()


def imported_answers_of(db: Session, study_id: str, code: str) -> list[dict[str, object]]:
    """Return one participant's imported answers, for the participant's own copy."""
    query = (
        select(ImportedForm, AnswerImport)
        .join(AnswerImport, AnswerImport.id == ImportedForm.import_id)
        .where(ImportedForm.study_id == study_id, ImportedForm.participant_code == code)
        .order_by(AnswerImport.imported_at, ImportedForm.line)
    )
    return [
        {
            "file": of.file_name,
            "imported_at_utc": of.imported_at.isoformat(),
            "instrument": of.instrument,
            "condition": form.condition,
            "answered_on": form.answered_on,
            "answers": form.answers,
            "scores": form.scores,
        }
        for form, of in db.execute(query)
    ]
