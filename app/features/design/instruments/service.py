"""Store instrument files as content-hashed versions, which never change."""

import re
from datetime import datetime
from functools import lru_cache

from sqlalchemy import ColumnElement, select
from sqlalchemy.orm import Session

from app.errors import NotFound
from app.models import InstrumentVersion, Study, StudyVersion
from app.platform.config_problems import StoredFault, invalid_config, stored_fault, unpacking
from app.protocol import (
    ConfigError,
    ConfigProblem,
    LoadedInstrument,
    load_instrument,
    parse_instrument_json,
)
from app.science.instruments import Instrument


def instrument_of(version: InstrumentVersion) -> Instrument:
    """Return the parsed instrument of a version."""
    return _parse_instrument(version.content_hash, version.canonical_json)


@lru_cache(maxsize=64)
def _parse_instrument(content_hash: str, canonical_json: str) -> Instrument:
    with unpacking(canonical_json, content_hash):
        return parse_instrument_json(canonical_json)


def faulty_instruments(db: Session) -> tuple[int, list[StoredFault]]:
    """Return how many versions of instruments are stored, and what is wrong with some of them."""
    query = select(InstrumentVersion).order_by(InstrumentVersion.key, InstrumentVersion.created_at)
    rows = list(db.scalars(query))
    found = (
        stored_fault(
            row.key,
            _number_in(row.canonical_json),
            (row.canonical_json, row.content_hash),
            parse_instrument_json,
        )
        for row in rows
    )
    return len(rows), [one for one in found if one is not None]


def _number_in(canonical_json: str) -> int | None:
    """Return the version that a content says it is, even if it was damaged; None if it cannot."""
    found = re.findall(r'"version":(\d{1,9})', canonical_json)
    return int(found[-1]) if found else None


def newest_instruments(db: Session) -> dict[str, InstrumentVersion]:
    """Return the newest version of every instrument, by key."""
    rows = db.scalars(
        select(InstrumentVersion).order_by(InstrumentVersion.created_at, InstrumentVersion.id)
    )
    return {row.key: row for row in rows}


def parsed_instruments(db: Session) -> dict[str, Instrument]:
    """Return the newest version of every instrument, parsed, by key."""
    return {key: instrument_of(row) for key, row in newest_instruments(db).items()}


def versions_of_instrument(db: Session, key: str) -> list[InstrumentVersion]:
    """Return all stored versions, oldest first; raise NotFound if there are none."""
    rows = db.scalars(
        select(InstrumentVersion)
        .where(InstrumentVersion.key == key)
        .order_by(InstrumentVersion.created_at, InstrumentVersion.id)
    ).all()
    if not rows:
        keys = sorted(newest_instruments(db))
        raise NotFound(f"there is no instrument {key!r}", value=key, valid=keys)
    return list(rows)


def checked_instrument(text: str) -> LoadedInstrument:
    """Load an instrument file; raise InvalidConfig with every problem."""
    try:
        return load_instrument(text)
    except ConfigError as error:
        raise invalid_config("instrument", error) from error


def save_instrument(
    db: Session, text: str, now: datetime, *, is_released: bool = False
) -> InstrumentVersion:
    """Store an instrument file as a version, or return the version with the same content.

    Answers are told apart by the number of the version, so a number stands for one content only.
    `is_released`: the file comes with Reembody, which may have mended it under the same number.

    Raises:
        InvalidConfig: the file has problems, or its version is stored with another content.
    """
    loaded = checked_instrument(text)
    existing = db.scalar(
        select(InstrumentVersion).where(
            InstrumentVersion.key == loaded.instrument.key,
            InstrumentVersion.content_hash == loaded.content_hash,
        )
    )
    if existing is not None:
        return existing
    taken = None if is_released else taken_version(db, loaded, text)
    if taken is not None:
        raise invalid_config("instrument", ConfigError((taken,)))
    row = InstrumentVersion(
        key=loaded.instrument.key,
        content_hash=loaded.content_hash,
        source_yaml=text,
        canonical_json=loaded.canonical_json,
        created_at=now,
    )
    db.add(row)
    db.flush()
    return row


def taken_version(db: Session, loaded: LoadedInstrument, text: str) -> ConfigProblem | None:
    """Return the problem if the file's version is stored with another content, else None."""
    key, number = loaded.instrument.key, loaded.instrument.version
    rows = db.scalars(select(InstrumentVersion).where(InstrumentVersion.key == key)).all()
    if any(row.content_hash == loaded.content_hash for row in rows):
        return None
    numbers = {instrument_of(row).version for row in rows}
    if number not in numbers:
        return None
    free = max(numbers) + 1
    lines = text.splitlines()
    line = next((at for at, one in enumerate(lines, 1) if one.startswith("version:")), 0)
    return ConfigProblem(
        path="version",
        line=line,
        column=1 if line else 0,
        message=f"Version {number} of {key} is stored with other content, which never changes.",
        value=number,
        valid=f"a number that is not used yet, such as {free}",
        remedy=f"Write version: {free}.",
    )


def uses(db: Session, seen: ColumnElement[bool]) -> dict[tuple[str, str], list[str]]:
    """Return the studies that use each wording: (instrument key, content hash) -> study keys.

    Only the newest versions of studies that are not archived count: those of new sessions. `seen`:
    the condition under which the reader may see a study.
    """
    found: dict[tuple[str, str], list[str]] = {}
    rows = db.execute(
        select(Study.key, StudyVersion.instruments)
        .join(StudyVersion, StudyVersion.study_id == Study.id)
        .where(Study.archived_at.is_(None), seen)
        .order_by(Study.key, StudyVersion.number)
    ).all()
    newest = {key: instruments for key, instruments in rows}  # noqa: C416 - the last one counts
    for study, instruments in newest.items():
        for key, content_hash in instruments.items():
            found.setdefault((key, content_hash), []).append(study)
    return found
