"""Find out which studies and sessions use a version of an avatar configuration."""

import json
from collections.abc import Iterator
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.features.movement.avatar.schemas import AvatarUse
from app.models import AvatarVersion, Study, StudySession, StudyVersion
from app.platform.access import Caller, visible_to

_RUNNING = "active"


def used_by(db: Session, caller: Caller, version: AvatarVersion) -> list[AvatarUse]:
    """Return the study versions of the caller that name a version, or whose sessions used it.

    A version of a study that is neither its newest nor has any such session is left out.
    """
    return list(_uses(db, caller, version))


def _uses(db: Session, caller: Caller, version: AvatarVersion) -> Iterator[AvatarUse]:
    newest = (
        select(StudyVersion.study_id, func.max(StudyVersion.number).label("number"))
        .group_by(StudyVersion.study_id)
        .subquery()
    )
    sessions = _sessions_by_study_version(db, version.content_hash)
    query = (
        select(
            Study.key,
            StudyVersion.id,
            StudyVersion.number,
            StudyVersion.canonical_json,
            newest.c.number,
        )
        .join(StudyVersion, StudyVersion.study_id == Study.id)
        .join(newest, newest.c.study_id == Study.id)
        .where(visible_to(caller), StudyVersion.canonical_json.contains('"avatar_configuration":'))
        .order_by(Study.key, StudyVersion.number.desc())
    )
    for key, version_id, number, canonical, newest_number in db.execute(query):
        study: dict[str, Any] = json.loads(canonical)
        chosen = study.get("avatar_configuration") or {}
        names_it = (chosen.get("key"), chosen.get("version")) == (version.key, version.number)
        count, running = sessions.get(version_id, (0, 0))
        if count or (names_it and number == newest_number):
            title = study["title"]
            yield AvatarUse(
                study=key,
                title=title.get("en") or next(iter(title.values()), key),
                study_version=number,
                is_newest=number == newest_number,
                sessions=count,
                running_sessions=running,
            )


def _sessions_by_study_version(db: Session, content_hash: str) -> dict[str, tuple[int, int]]:
    """Return, by version of a study, how many sessions used a content and how many run now."""
    rows = db.execute(
        select(StudySession.study_version_id, StudySession.status, func.count())
        .where(StudySession.avatar_configuration_hash == content_hash)
        .group_by(StudySession.study_version_id, StudySession.status)
    )
    found: dict[str, tuple[int, int]] = {}
    for version_id, status, count in rows:
        total, running = found.get(version_id, (0, 0))
        found[version_id] = (total + count, running + (count if status == _RUNNING else 0))
    return found
