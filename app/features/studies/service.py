"""Studies: checked files become content-hashed versions; a version in use never changes."""

from dataclasses import dataclass
from datetime import datetime
from functools import lru_cache
from pathlib import Path

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidConfig, NotFound
from app.models import InstrumentVersion, Study, StudySession, StudyVersion
from app.protocol import (
    ConfigError,
    LoadedInstrument,
    LoadedStudy,
    StudyProtocol,
    load_instrument,
    load_study,
    parse_instrument_json,
    parse_study_json,
)
from app.resources import study_configs_dir
from app.science.instruments import Instrument


@dataclass(frozen=True)
class ShippedFiles:
    """The study and instrument files that come with the product."""

    studies: tuple[Path, ...]
    instruments: tuple[Path, ...]


def shipped_files() -> ShippedFiles:
    """The files under study_configs."""
    root = study_configs_dir()
    return ShippedFiles(
        tuple(sorted(root.glob("*.yaml"))), tuple(sorted((root / "instruments").glob("*.yaml")))
    )


def protocol_of(version: StudyVersion) -> StudyProtocol:
    """The typed protocol of a version."""
    return _parse_study(version.content_hash, version.canonical_json)


@lru_cache(maxsize=64)
def _parse_study(_content_hash: str, canonical_json: str) -> StudyProtocol:
    return parse_study_json(canonical_json)


def instrument_of(version: InstrumentVersion) -> Instrument:
    """The typed instrument of a version."""
    return _parse_instrument(version.content_hash, version.canonical_json)


@lru_cache(maxsize=64)
def _parse_instrument(_content_hash: str, canonical_json: str) -> Instrument:
    return parse_instrument_json(canonical_json)


def newest_instruments(db: Session) -> dict[str, InstrumentVersion]:
    """The newest version of every instrument, by key."""
    rows = db.scalars(
        select(InstrumentVersion).order_by(InstrumentVersion.created_at, InstrumentVersion.id)
    )
    return {row.key: row for row in rows}


def instrument_for(db: Session, version: StudyVersion, key: str) -> InstrumentVersion:
    """The wording of instrument `key` that this study version uses."""
    content_hash = version.instruments.get(key)
    row = db.scalar(
        select(InstrumentVersion).where(
            InstrumentVersion.key == key, InstrumentVersion.content_hash == content_hash
        )
    )
    if row is None:
        raise NotFound(
            f"the study uses no instrument {key!r}", value=key, valid=sorted(version.instruments)
        )
    return row


def check_study(db: Session, text: str) -> LoadedStudy:
    """Load a study file against the instruments at hand; InvalidConfig has every problem."""
    instruments = {key: instrument_of(row) for key, row in newest_instruments(db).items()}
    try:
        return load_study(text, instruments=instruments)
    except ConfigError as error:
        raise _invalid_config("study", error) from error


def save_instrument(db: Session, text: str, now: datetime) -> InstrumentVersion:
    """Store an instrument file as a version, or find the version with that content."""
    try:
        loaded: LoadedInstrument = load_instrument(text)
    except ConfigError as error:
        raise _invalid_config("instrument", error) from error
    known = db.scalar(
        select(InstrumentVersion).where(
            InstrumentVersion.key == loaded.instrument.key,
            InstrumentVersion.content_hash == loaded.content_hash,
        )
    )
    if known is not None:
        return known
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


def create_study(db: Session, text: str, now: datetime) -> StudyVersion:
    """A new study from its file; raises Conflict where the key exists."""
    loaded = check_study(db, text)
    key = loaded.protocol.key
    if db.scalar(select(Study).where(Study.key == key)):
        raise Conflict(
            f"there is a study {key!r} already",
            value=key,
            remedy="Add a version to it, or give the new study another key.",
        )
    study = Study(key=key, created_at=now)
    db.add(study)
    db.flush()
    return _add_version(db, study, loaded, text, now)


def add_version(db: Session, study: Study, text: str, now: datetime) -> StudyVersion:
    """The version with this content, made if it is new. Frozen versions stay as they are."""
    loaded = check_study(db, text)
    if loaded.protocol.key != study.key:
        raise Conflict(
            f"the file is of study {loaded.protocol.key!r}",
            value=loaded.protocol.key,
            valid=study.key,
            remedy="Keep the key to make a version; change it and create a study to make another.",
        )
    return _add_version(db, study, loaded, text, now)


def _add_version(
    db: Session, study: Study, loaded: LoadedStudy, text: str, now: datetime
) -> StudyVersion:
    versions = versions_of(db, study)
    for version in versions:
        if version.content_hash == loaded.content_hash:
            return version
    instruments = newest_instruments(db)
    row = StudyVersion(
        study_id=study.id,
        number=len(versions) + 1,
        content_hash=loaded.content_hash,
        design_hash=loaded.protocol.design_hash,
        source_yaml=text,
        canonical_json=loaded.canonical_json,
        instruments={key: instruments[key].content_hash for key in loaded.protocol.instrument_keys},
        created_at=now,
    )
    db.add(row)
    db.flush()
    return row


def study_by_key(db: Session, key: str) -> Study:
    """The study of that key; raises NotFound."""
    study = db.scalar(select(Study).where(Study.key == key))
    if study is None:
        known = list(db.scalars(select(Study.key).order_by(Study.key)))
        raise NotFound(f"there is no study {key!r}", value=key, valid=known)
    return study


def versions_of(db: Session, study: Study) -> list[StudyVersion]:
    """All versions, oldest first."""
    return list(
        db.scalars(
            select(StudyVersion)
            .where(StudyVersion.study_id == study.id)
            .order_by(StudyVersion.number)
        )
    )


def newest_version(db: Session, study: Study) -> StudyVersion:
    """The version that new sessions take."""
    return versions_of(db, study)[-1]


def freeze(version: StudyVersion, now: datetime) -> None:
    """From the first started session on, a version cannot change."""
    version.frozen_at = version.frozen_at or now


def session_counts(db: Session, study: Study) -> dict[str, int]:
    """How many sessions of each kind the study has."""
    rows = db.execute(
        select(StudySession.kind, func.count())
        .where(StudySession.study_id == study.id)
        .group_by(StudySession.kind)
    )
    return {"people": 0, "simulated": 0, "test": 0} | dict(rows.all())


def add_shipped(db: Session, now: datetime) -> None:
    """Store the instruments that ship with this release, and its studies where there are none."""
    files = shipped_files()
    for path in files.instruments:
        save_instrument(db, path.read_text(encoding="utf-8"), now)
    if db.scalar(select(Study).limit(1)) is None:
        for path in files.studies:
            create_study(db, path.read_text(encoding="utf-8"), now)


def _invalid_config(what: str, error: ConfigError) -> InvalidConfig:
    problems = [
        {
            "path": problem.path,
            "line": problem.line,
            "column": problem.column,
            "message": problem.message,
            "value": problem.value,
            "valid": problem.valid,
            "remedy": problem.remedy,
        }
        for problem in error.problems
    ]
    count = len(problems)
    return InvalidConfig(
        f"the {what} file has {count} problem{'s' if count != 1 else ''}",
        remedy="Mend the lines named below; nothing was stored.",
        details=problems,
    )
