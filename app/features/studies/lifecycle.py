"""Copying a study, putting it away and taking it out again. Nothing is ever deleted."""

from collections.abc import Mapping
from datetime import datetime

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotNow
from app.features.config_problems import invalid_config
from app.features.studies.service import create_study, newest_version, protocol_of
from app.models import Study, StudySession, StudyVersion
from app.protocol import ConfigError
from app.protocol.editing import Change, edit_text

UNDER_WAY = ("planned", "active")
"""Sessions that are not over yet."""


def duplicate(
    db: Session, study: Study, *, key: str, title: Mapping[str, str] | None, now: datetime
) -> StudyVersion:
    """A new study from the newest file of `study`, comments included, under another key.

    It has a ledger and sessions of its own. Raises Conflict for a key that is taken, and
    InvalidConfig where key or title cannot be used.
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
    """Put the study away: it takes no new sessions. Repeating it changes nothing.

    Raises NotNow while sessions of people or simulations are planned or running.
    """
    if study.archived_at is not None:
        return
    # Joins lock the study's ledgers, not the study; the row is locked so that two do not cross.
    db.execute(select(Study.id).where(Study.id == study.id).with_for_update(key_share=True))
    rows = db.execute(
        select(StudySession.status, func.count())
        .where(StudySession.study_id == study.id, StudySession.status.in_(UNDER_WAY))
        .group_by(StudySession.status)
    ).all()
    if rows:
        counts: dict[str, int] = {status: count for status, count in rows}  # noqa: C416 - typed
        told = " and ".join(f"{count} {status}" for status, count in sorted(counts.items()))
        raise NotNow(
            f"the study has sessions that are not over: {told}",
            value=counts,
            remedy="Finish, abort or withdraw them first. Their data stay in any case.",
        )
    study.archived_at = now
    db.flush()


def restore(db: Session, study: Study) -> None:
    """Take the study out again; its ledger goes on where it was."""
    study.archived_at = None
    db.flush()
