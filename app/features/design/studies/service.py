"""Store study files as content-hashed versions; a version in use never changes."""

from dataclasses import dataclass
from datetime import datetime
from functools import lru_cache
from pathlib import Path

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.errors import Conflict, NotFound, NotNow
from app.features.design.instruments import newest_instruments, parsed_instruments, save_instrument
from app.features.movement.avatar import configurations, newest_numbers
from app.features.movement.humanoids import named_bodies
from app.models import InstrumentVersion, Study, StudySession, StudyVersion
from app.platform.config_problems import StoredFault, invalid_config, stored_fault, unpacking
from app.protocol import ConfigError, LoadedStudy, StudyProtocol, load_study, parse_study_json
from app.resources import study_configs_dir


@dataclass(frozen=True)
class ShippedFiles:
    """The study and instrument files that come with the product."""

    studies: tuple[Path, ...]
    instruments: tuple[Path, ...]


def shipped_files() -> ShippedFiles:
    """Return the files under study_configs."""
    root = study_configs_dir()
    return ShippedFiles(
        tuple(sorted(root.glob("*.yaml"))), tuple(sorted((root / "instruments").glob("*.yaml")))
    )


def protocol_of(version: StudyVersion) -> StudyProtocol:
    """Return the parsed protocol of a version."""
    return _parse_study(version.content_hash, version.canonical_json)


@lru_cache(maxsize=64)
def _parse_study(content_hash: str, canonical_json: str) -> StudyProtocol:
    with unpacking(canonical_json, content_hash):
        return parse_study_json(canonical_json)


def faulty_studies(db: Session) -> tuple[int, list[StoredFault]]:
    """Return how many versions of studies are stored, and what is wrong with some of them."""
    query = select(Study.key, StudyVersion).join(Study, Study.id == StudyVersion.study_id)
    rows = list(db.execute(query.order_by(Study.key, StudyVersion.number)))
    found = (
        stored_fault(key, row.number, (row.canonical_json, row.content_hash), parse_study_json)
        for key, row in rows
    )
    return len(rows), [one for one in found if one is not None]


def instrument_for(db: Session, version: StudyVersion, key: str) -> InstrumentVersion:
    """Return the wording of instrument `key` that this study version uses.

    It is cached for the duration of the transaction, because versions are never edited.
    """
    content_hash = version.instruments.get(key)
    cached = db.info.get(("instrument", key, content_hash))
    if isinstance(cached, InstrumentVersion):
        return cached
    row = db.scalar(
        select(InstrumentVersion).where(
            InstrumentVersion.key == key, InstrumentVersion.content_hash == content_hash
        )
    )
    if row is None:
        raise NotFound(
            f"the study uses no instrument {key!r}", value=key, valid=sorted(version.instruments)
        )
    db.info["instrument", key, content_hash] = row
    return row


def check_study(db: Session, text: str) -> LoadedStudy:
    """Load a study file, using the lab's instruments and avatars.

    Raises InvalidConfig with every problem.
    """
    try:
        return load_study(
            text,
            instruments=parsed_instruments(db),
            avatars=newest_numbers(db),
            bodies=named_bodies(db),
            configured=configurations(db),
        )
    except ConfigError as error:
        raise invalid_config("study", error) from error


def create_study(db: Session, text: str, now: datetime) -> StudyVersion:
    """Create a study from its file; raise Conflict if the key exists."""
    loaded = check_study(db, text)
    key = loaded.protocol.key
    if db.scalar(select(Study).where(Study.key == key)):
        raise Conflict(
            f"the study {key!r} already exists",
            value=key,
            remedy="Add a version to it, or give the new study another key.",
        )
    study = Study(key=key, created_at=now)
    db.add(study)
    db.flush()
    return _add_version(db, study, loaded, text, now)


def add_version(db: Session, study: Study, text: str, now: datetime) -> StudyVersion:
    """Return the version with this content, creating it if it is new; frozen ones never change."""
    loaded = check_study(db, text)
    if loaded.protocol.key != study.key:
        raise Conflict(
            f"the file belongs to the study {loaded.protocol.key!r}",
            value=loaded.protocol.key,
            valid=study.key,
            remedy="Keep the key to add a version; to create another study, change the key.",
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
    """Return the study with this key; raise NotFound if there is none."""
    study = db.scalar(select(Study).where(Study.key == key))
    if study is None:
        keys = list(db.scalars(select(Study.key).order_by(Study.key)))
        raise NotFound(f"there is no study {key!r}", value=key, valid=keys)
    return study


def versions_of(db: Session, study: Study) -> list[StudyVersion]:
    """Return all versions of a study, oldest first."""
    return list(
        db.scalars(
            select(StudyVersion)
            .where(StudyVersion.study_id == study.id)
            .order_by(StudyVersion.number)
        )
    )


def version_by_number(db: Session, study: Study, number: int) -> StudyVersion:
    """Return the version with this number; raise NotFound if there is none."""
    versions = versions_of(db, study)
    for version in versions:
        if version.number == number:
            return version
    raise NotFound(
        f"the study has no version {number}",
        value=number,
        valid=[version.number for version in versions],
    )


def require_open(study: Study) -> None:
    """Raise NotNow if the study is archived, because it takes no new sessions and pilots."""
    if study.archived_at is not None:
        raise NotNow(
            f"the study {study.key!r} is archived, so nothing new can be started in it",
            value=study.key,
            remedy="Restore it on its page, or choose another study.",
        )


def newest_version(db: Session, study: Study) -> StudyVersion:
    """Return the newest version, which new sessions use."""
    return versions_of(db, study)[-1]


def freeze(version: StudyVersion, now: datetime) -> None:
    """Freeze a version, because a session has started with it; it cannot change any more."""
    version.frozen_at = version.frozen_at or now


def session_counts(db: Session, study: Study) -> dict[str, int]:
    """Return the number of sessions of each kind."""
    rows = db.execute(
        select(StudySession.kind, func.count())
        .where(StudySession.study_id == study.id)
        .group_by(StudySession.kind)
    )
    return {"people": 0, "simulated": 0, "test": 0} | dict(rows.all())


def add_shipped(db: Session, now: datetime) -> None:
    """Store the instruments of this release, and its studies if there are none yet."""
    files = shipped_files()
    for path in files.instruments:
        save_instrument(db, path.read_text(encoding="utf-8"), now, is_released=True)
    if db.scalar(select(Study).limit(1)) is None:
        for path in files.studies:
            create_study(db, path.read_text(encoding="utf-8"), now)
