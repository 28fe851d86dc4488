"""Duplicate, archive and restore studies; nothing is ever deleted."""

from collections.abc import Mapping
from datetime import datetime

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotNow
from app.features.design.studies.service import create_study, newest_version, protocol_of
from app.models import Study, StudySession, StudyVersion
from app.platform.config_problems import invalid_config
from app.protocol import ConfigError
from app.protocol.editing import Change, edit_text

UNDER_WAY = ("planned", "active")
"""The statuses of sessions that are not over yet."""


def duplicate(
    db: Session, study: Study, *, key: str, title: Mapping[str, str] | None, now: datetime
) -> StudyVersion:
    """Create a study from the newest file of `study`, comments included, under another key.

    It has a ledger and sessions of its own. Raises Conflict for a key that is taken, and
    InvalidConfig if key or title is invalid.
    """
    version = newest_version(db, study)
    languages = protocol_of(version).languages
    changes = [Change(("key",), "set", key)]
    for language, words in (title or {}).items():
        if language not in languages:
            raise InvalidInput(
                f"the study has no texts in {language!r}", value=language, valid=list(languages)
            )
        changes.append(Change(("title", language), "set", words))
    try:
        text = edit_text(version.source_yaml, changes)
    except ConfigError as error:
        raise invalid_config("study", error) from error
    return create_study(db, text, now)


def archive(db: Session, study: Study, now: datetime) -> None:
    """Archive the study, so that it takes no new sessions; repeating it changes nothing.

    A session that was created before and not started yet keeps its slot and may still be run.
    Raises NotNow while a session is running.
    """
    if study.archived_at is not None:
        return
    # The row is locked so that concurrent requests are decided one after the other.
    db.execute(select(Study.id).where(Study.id == study.id).with_for_update(key_share=True))
    running = db.scalar(
        select(func.count())
        .select_from(StudySession)
        .where(StudySession.study_id == study.id, StudySession.status == "active")
    )
    if running:
        raise NotNow(
            f"the study has {running} session{'s' if running > 1 else ''} running",
            value=running,
            valid=0,
            remedy="Finish, abort or withdraw them first. Their data are kept in any case.",
        )
    study.archived_at = now
    db.flush()


def restore(db: Session, study: Study) -> None:
    """Restore an archived study; its ledger continues."""
    study.archived_at = None
    db.flush()
