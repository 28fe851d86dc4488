"""Compare two versions of a study, as content and as text."""

import difflib
import json
from dataclasses import dataclass

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.features.design.instruments import newest_instruments
from app.features.design.studies.lifecycle import UNDER_WAY
from app.features.design.studies.schemas import DifferenceView, InstrumentChange, StudyDiff
from app.features.design.studies.service import check_study, newest_version, version_by_number
from app.models import Study, StudySession, StudyVersion
from app.protocol import differences, path_text


@dataclass(frozen=True)
class _Side:
    """One of the two sides of a comparison: a version or a draft."""

    number: int | None
    content_hash: str
    design_hash: str
    canonical_json: str
    yaml: str
    instruments: dict[str, str]


def compare_versions(db: Session, study: Study, source: int, target: int) -> StudyDiff:
    """Return the differences from version `source` to version `target`; raise NotFound."""
    sides = (version_by_number(db, study, number) for number in (source, target))
    return _diff(db, study, *map(_stored, sides))


def compare_draft(db: Session, study: Study, text: str) -> StudyDiff:
    """Return the differences of a draft from the newest version; raise InvalidConfig."""
    loaded = check_study(db, text)
    newest = newest_instruments(db)
    draft = _Side(
        number=None,
        content_hash=loaded.content_hash,
        design_hash=loaded.protocol.design_hash,
        canonical_json=loaded.canonical_json,
        yaml=text,
        instruments={key: newest[key].content_hash for key in loaded.protocol.instrument_keys},
    )
    return _diff(db, study, _stored(newest_version(db, study)), draft)


def _stored(version: StudyVersion) -> _Side:
    return _Side(
        version.number,
        version.content_hash,
        version.design_hash,
        version.canonical_json,
        version.source_yaml,
        dict(version.instruments),
    )


def _diff(db: Session, study: Study, before: _Side, after: _Side) -> StudyDiff:
    found = differences(json.loads(before.canonical_json), json.loads(after.canonical_json))
    return StudyDiff(
        source=before.number or 0,
        target=after.number,
        same=before.content_hash == after.content_hash,
        new_ledger=before.design_hash != after.design_hash,
        under_way=_under_way(db, study),
        changes=[
            DifferenceView(
                path=path_text(one.path), kind=one.kind, before=one.before, after=one.after
            )
            for one in found
        ],
        instruments=[
            InstrumentChange(
                key=key, before=before.instruments.get(key), after=after.instruments.get(key)
            )
            for key in sorted({*before.instruments, *after.instruments})
            if before.instruments.get(key) != after.instruments.get(key)
        ],
        text=_unified(before, after),
    )


def _unified(before: _Side, after: _Side) -> str:
    old, new = (side.yaml.rstrip("\n").split("\n") for side in (before, after))
    name, other = (f"version {one.number}" if one.number else "draft" for one in (before, after))
    return "\n".join(difflib.unified_diff(old, new, name, other, lineterm=""))


def _under_way(db: Session, study: Study) -> int:
    return (
        db.scalar(
            select(func.count())
            .select_from(StudySession)
            .where(StudySession.study_id == study.id, StudySession.status.in_(UNDER_WAY))
        )
        or 0
    )
