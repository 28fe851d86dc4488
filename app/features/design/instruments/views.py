"""Convert stored instruments to response models."""

from collections.abc import Sequence

from sqlalchemy import ColumnElement
from sqlalchemy.orm import Session

from app.features.design.instruments.schemas import (
    FormulaView,
    InstrumentDetail,
    InstrumentSummary,
    InstrumentVersionView,
    Preview,
    ProvenanceView,
)
from app.features.design.instruments.service import instrument_of, uses, versions_of_instrument
from app.models import InstrumentVersion
from app.protocol import form_s, instrument_as_json
from app.science.instruments import Instrument, Score, item_order

Uses = dict[tuple[str, str], list[str]]


def summary_of(versions: Sequence[InstrumentVersion], used: Uses) -> InstrumentSummary:
    """Return the newest of an instrument's `versions` (oldest first) as an entry of the library."""
    row = versions[-1]
    instrument = instrument_of(row)
    older = {
        study
        for version in versions[:-1]
        for study in used.get((version.key, version.content_hash), ())
    }
    return InstrumentSummary(
        key=row.key,
        title=dict(instrument.title),
        version=instrument.version,
        languages=list(instrument.languages),
        items=len(instrument.items),
        scored_items=len(instrument.scored_items),
        scores=[formula_view(score) for score in instrument.scores],
        minutes=_minutes(instrument),
        provenance=ProvenanceView(
            source=instrument.provenance.source,
            licence=instrument.provenance.licence,
            verified=instrument.provenance.verified,
            notes=list(instrument.provenance.notes),
        ),
        content_hash=row.content_hash,
        created_at=row.created_at,
        stored_versions=len(versions),
        used_by=used.get((row.key, row.content_hash), []),
        used_by_older=sorted(older),
    )


def detail_of(db: Session, key: str, seen: ColumnElement[bool]) -> InstrumentDetail:
    """Return a complete instrument; `seen` as for `uses`. Raises NotFound."""
    versions = versions_of_instrument(db, key)
    used = uses(db, seen)
    newest = versions[-1]
    return InstrumentDetail(
        **summary_of(versions, used).model_dump(),
        yaml=newest.source_yaml,
        preview=preview_of(instrument_of(newest)),
        versions=[
            InstrumentVersionView(
                version=instrument_of(row).version,
                content_hash=row.content_hash,
                created_at=row.created_at,
                yaml=row.source_yaml,
                used_by=used.get((row.key, row.content_hash), []),
            )
            for row in versions
        ],
    )


def preview_of(instrument: Instrument) -> Preview:
    """Return the instrument as a form, with the item order of seed 0, as a tablet could get it."""
    seed = 0
    return Preview(
        instrument=instrument_as_json(instrument),
        item_order=list(item_order(instrument, seed)),
        seed=seed,
        languages=list(instrument.languages),
        recode=instrument.recode,
        scores=[formula_view(score) for score in instrument.scores],
        minutes=_minutes(instrument),
    )


def formula_view(score: Score) -> FormulaView:
    """Return a score with its formula."""
    return FormulaView(
        key=score.key,
        label=dict(score.label),
        formula=score.formula,
        minimum=score.minimum,
        maximum=score.maximum,
        note=score.note,
    )


def _minutes(instrument: Instrument) -> float:
    return round(form_s(instrument) / 60, 1)
