"""Preview a file and check its mapping, without storing anything."""

from collections import Counter
from collections.abc import Mapping as Map
from collections.abc import Sequence

from sqlalchemy.orm import Session

from app.features.design.instruments import parsed_instruments
from app.features.design.studies import newest_version, protocol_of
from app.features.results.imports.applying import MISSING, Applied, Form, apply_mapping
from app.features.results.imports.offering import answer_columns, offer, used_columns
from app.features.results.imports.proposing import likely_instrument, propose
from app.features.results.imports.repository import active_import, import_view, imports_of
from app.features.results.imports.scales import shift_of
from app.features.results.imports.schemas import (
    CheckView,
    ConditionCount,
    FileColumn,
    FormPreview,
    LeftOutColumn,
    LookRequest,
    LookView,
    Mapping,
    Shift,
)
from app.features.results.imports.service import applied_to, known_instrument
from app.features.results.imports.sheet import Sheet, read_sheet
from app.models import Study
from app.protocol import sha256_of
from app.science.instruments import Instrument, reversal_doubts, reversed_items

_EXAMPLES, _SHOWN_ROWS, _SHOWN_PROBLEMS, _SHOWN_WORDS = 6, 6, 200, 60
_WIDTH = 80


def look(db: Session, study: Study, request: LookRequest) -> LookView:
    """Return a preview of a file and a proposed mapping; raise InvalidInput or NotFound."""
    sheet = read_sheet(request.text, request.header_rows)
    known = parsed_instruments(db)
    likely, is_likely = likely_instrument(sheet, known)
    key = request.instrument or likely
    instrument = known_instrument(known, key)
    remembered = _remembered(db, study, key, sheet)
    protocol = protocol_of(newest_version(db, study))
    proposal = remembered
    if proposal is None and (is_likely or request.instrument is not None):
        proposal = propose(sheet, instrument, protocol)
    existing = active_import(db, study, key, sha256_of(request.text))
    offered, left_out = offer(sheet, used_columns(proposal), known)
    return LookView(
        separator=sheet.separator,
        header_rows=sheet.header_rows,
        rows=len(sheet.rows),
        columns=[_column(sheet, at) for at in range(len(sheet.header))],
        first_rows=[[cell[:_WIDTH] for cell in row.cells] for row in sheet.rows[:_SHOWN_ROWS]],
        instrument=key,
        proposal=proposal,
        remembered=remembered is not None,
        words=_answers_in_words(sheet, proposal, instrument),
        condition_words=_condition_words(sheet, proposal),
        same_file=None if existing is None else import_view(db, existing),
        offer=offered,
        left_out=left_out,
    )


def check(db: Session, study: Study, text: str, mapping: Mapping) -> CheckView:
    """Return the result that an import would have; raise InvalidInput or NotFound."""
    instrument, applied = applied_to(db, study, text, mapping)
    left_out = _left_out(read_sheet(text, mapping.header_rows), mapping)
    turning = reversed_items(instrument)
    conditions = Counter((form.condition, form.in_study) for form in applied.forms)
    items = {item for one in mapping.sets for item in one.items}
    return CheckView(
        forms=len(applied.forms),
        participants=len({form.participant_code for form in applied.forms}),
        skipped_rows=applied.skipped_rows,
        missing_answers=applied.missing,
        conditions=[
            ConditionCount(condition=name, in_study=own, forms=count)
            for (name, own), count in conditions.items()
        ],
        problems=applied.problems[:_SHOWN_PROBLEMS],
        n_problems=len(applied.problems),
        unknown_words=list(applied.unknown_words)[:_SHOWN_WORDS],
        shift=_shift(instrument, mapping, applied),
        reversed_items=[key for key in turning if key in items],
        notes=[
            *_not_mapped(instrument, items),
            *_not_imported(left_out),
            *_reversal_notes(turning, applied.forms),
        ],
        left_out=left_out,
        first_forms=[_preview(form) for form in applied.forms[:_SHOWN_ROWS]],
    )


def _remembered(db: Session, study: Study, key: str, sheet: Sheet) -> Mapping | None:
    """Return the mapping of the newest imported file with the same columns, if there is one."""
    for row in imports_of(db, study):
        mapping = Mapping.model_validate(row.mapping)
        names = {mapping.participant, mapping.condition, mapping.date} - {None}
        names |= {column for one in mapping.sets for column in one.items.values()}
        same_header_rows = mapping.header_rows == sheet.header_rows
        if row.instrument == key and names <= set(sheet.header) and same_header_rows:
            return mapping
    return None


def _column(sheet: Sheet, at: int) -> FileColumn:
    values = [row.cells[at].strip() for row in sheet.rows]
    distinct = list(dict.fromkeys(value for value in values if value))
    return FileColumn(
        name=sheet.header[at],
        label=sheet.labels[at][:_WIDTH] if at < len(sheet.labels) else "",
        filled=sum(bool(value) for value in values),
        distinct=len(distinct),
        examples=[value[:_WIDTH] for value in distinct[:_EXAMPLES]],
    )


def _answers_in_words(sheet: Sheet, mapping: Mapping | None, instrument: Instrument) -> list[str]:
    if mapping is None:
        return []
    applied = apply_mapping(sheet, mapping, instrument, frozenset())
    return [*mapping.words, *applied.unknown_words][:_SHOWN_WORDS]


def _condition_words(sheet: Sheet, mapping: Mapping | None) -> list[str]:
    if mapping is None:
        return []
    if mapping.condition is None:
        return [one.condition for one in mapping.sets if one.condition is not None]
    return list(dict.fromkeys(filter(None, sheet.values(mapping.condition))))[:_SHOWN_WORDS]


def _shift(instrument: Instrument, mapping: Mapping, applied: Applied) -> Shift | None:
    plain = mapping.multiply == 1.0 and mapping.add == 0.0
    return shift_of(instrument, applied.numbers) if plain and applied.problems else None


def _not_mapped(instrument: Instrument, items: set[str]) -> list[str]:
    lacking = [key for key in instrument.by_key if key not in items]
    if not lacking:
        return []
    return [f"No column for {', '.join(lacking)}: scores that need these items stay empty."]


def _left_out(sheet: Sheet, mapping: Mapping) -> list[LeftOutColumn]:
    return [
        LeftOutColumn(name=name, filled=sum(value.casefold() not in MISSING for value in values))
        for name in answer_columns(sheet, mapping)
        for values in [sheet.values(name)]
    ]


def _not_imported(left_out: list[LeftOutColumn]) -> list[str]:
    if not left_out:
        return []
    names = ", ".join(one.name for one in left_out[:_SHOWN_ROWS])
    more = f" and {len(left_out) - _SHOWN_ROWS} more" if len(left_out) > _SHOWN_ROWS else ""
    answers = sum(one.filled for one in left_out)
    count = f"{len(left_out)} columns that look like answers are not imported ({answers} answers)"
    return [f"{count}: {names}{more}."]


def _preview(form: Form) -> FormPreview:
    return FormPreview(
        line=form.line,
        participant_code=form.participant_code,
        condition=form.condition,
        in_study=form.in_study,
        answered_on=form.answered_on,
        answers=form.answers,
        scores=form.scores,
    )


def _reversal_notes(turning: Map[str, tuple[str, list[str]]], forms: Sequence[Form]) -> list[str]:
    """Return notes on items that correlate positively with items that they should oppose."""
    return [
        f"{doubt}. If the file has already reversed it, mark it as reversed."
        for doubt in reversal_doubts(turning, [form.answers for form in forms])
    ]
