"""Whether what the session will be shown is what the study says, word for word."""

from collections.abc import Iterator

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import ReembodyError
from app.features.design.instruments import instrument_of
from app.features.design.studies import instrument_for, protocol_of
from app.features.movement.avatar import configuration_by_hash
from app.features.record.preflight.schemas import Check
from app.features.record.sessions import plan_of
from app.models import AvatarVersion, StudySession, StudyVersion
from app.protocol import sha256_of

SHORT = 12
"""Hexadecimal digits of a hash that people compare."""


def study_checks(db: Session, session: StudySession) -> Iterator[Check]:
    """The checks of the study's content, in the order of the list."""
    version = db.get_one(StudyVersion, session.study_version_id)
    yield _instruments(db, version)
    yield _configuration(db, session, version)
    yield _language(db, session, version)


def _instruments(db: Session, version: StudyVersion) -> Check:
    """Each stored as it was when the study took it up, and readable."""
    kept: list[str] = []
    damaged: list[str] = []
    for key in sorted(version.instruments):
        try:
            row = instrument_for(db, version, key)
            number = instrument_of(row).version
        except (ReembodyError, ValueError):
            damaged.append(key)
            continue
        if sha256_of(row.canonical_json) == row.content_hash:
            kept.append(f"{key} v{number} {row.content_hash[:SHORT]}")
        else:
            damaged.append(key)
    if damaged:
        return Check(
            key="instruments",
            status="fail",
            code="instruments.damaged",
            value=len(damaged),
            unit="instruments",
            details=tuple(damaged),
        )
    return Check(
        key="instruments",
        status="ok",
        code="instruments.ok" if kept else "instruments.none",
        value=len(kept),
        unit="instruments",
        details=tuple(kept),
    )


def _configuration(db: Session, session: StudySession, version: StudyVersion) -> Check:
    """The study's content, and the avatar's if it has one, still have the hashes on record."""
    details = [f"study v{version.number} {version.content_hash[:SHORT]}"]
    sound = sha256_of(version.canonical_json) == version.content_hash
    if session.avatar_configuration_hash is not None:
        details.append(f"avatar {session.avatar_configuration_hash[:SHORT]}")
        sound = sound and _is_kept(db, session.avatar_configuration_hash)
    return Check(
        key="configuration",
        status="ok" if sound else "fail",
        code="configuration.ok" if sound else "configuration.differs",
        details=tuple(details),
    )


def _is_kept(db: Session, content_hash: str) -> bool:
    """Whether an avatar's configuration is stored as it was, and readable."""
    query = select(AvatarVersion.canonical_json).where(AvatarVersion.content_hash == content_hash)
    content = db.scalar(query.limit(1))
    if content is None or sha256_of(content) != content_hash:
        return False
    try:
        configuration_by_hash(db, content_hash)
    except ValueError:
        return False
    return True


def _language(db: Session, session: StudySession, version: StudyVersion) -> Check:
    """Every text of the study and every instrument exists in the session's language."""
    language = session.language
    texts = {f"text {key}": text for key, text in protocol_of(version).texts.items()}
    texts |= {f"step {step.key}": step.title for step in plan_of(db, session)}
    missing = [name for name, text in texts.items() if not text.get(language, "").strip()]
    for key in version.instruments:
        try:
            languages = instrument_of(instrument_for(db, version, key)).languages
        except (ReembodyError, ValueError):
            continue  # Told by the check of the instruments.
        if language not in languages:
            missing.append(f"instrument {key}")
    if missing:
        return Check(
            key="language",
            status="fail",
            code="language.missing",
            value=len(missing),
            unit="texts",
            details=(language, *missing),
        )
    count = len(texts) + len(version.instruments)
    return Check(
        key="language",
        status="ok",
        code="language.ok",
        value=count,
        unit="texts",
        details=(language,),
    )
