"""Find out who wears a body: configurations of avatars, and conditions of studies."""

import json
from collections.abc import Iterator
from typing import Any

from sqlalchemy import func, or_, select
from sqlalchemy.orm import Session

from app.features.movement.humanoids.schemas import BodyUse, ConfigurationUse, WornBy
from app.features.movement.humanoids.service import humanoid_by_hash
from app.models import Avatar, AvatarVersion, Study, StudyVersion
from app.platform.access import Caller, visible_to


def use_of(db: Session, caller: Caller, content_hash: str) -> BodyUse:
    """Return the configurations that have a body, and the studies of the caller that wear it.

    A study whose conditions are hidden from the caller is left out, because its conditions may
    differ in their bodies.
    Raises NotFound if there is no such body.
    """
    row = humanoid_by_hash(db, content_hash)
    configurations = list(configurations_with(db, content_hash))
    worn = {(one.key, one.version) for one in configurations}
    return BodyUse(
        configurations=configurations, studies=list(_studies(db, caller, row.name, worn))
    )


def configurations_with(db: Session, content_hash: str) -> Iterator[ConfigurationUse]:
    """Yield every version of a configuration that has a body."""
    # The hash is in the text of a configuration only as the value of `humanoid`.
    query = (
        select(AvatarVersion.key, Avatar.title, AvatarVersion.number)
        .join(Avatar, Avatar.key == AvatarVersion.key)
        .where(AvatarVersion.canonical_json.contains(content_hash))
        .order_by(AvatarVersion.key, AvatarVersion.number)
    )
    for key, title, number in db.execute(query):
        yield ConfigurationUse(key=key, title=title, version=number)


def _studies(
    db: Session, caller: Caller, name: str | None, worn: set[tuple[str, int]]
) -> Iterator[WornBy]:
    newest = (
        select(StudyVersion.study_id, func.max(StudyVersion.number).label("number"))
        .group_by(StudyVersion.study_id)
        .subquery()
    )
    text = StudyVersion.canonical_json
    query = (
        select(Study.key, StudyVersion.number, text)
        .join(StudyVersion, StudyVersion.study_id == Study.id)
        .join(
            newest,
            (newest.c.study_id == StudyVersion.study_id) & (newest.c.number == StudyVersion.number),
        )
        .where(
            visible_to(caller),
            or_(text.contains('"body":"'), text.contains('"avatar_configuration":')),
        )
        .order_by(Study.key)
    )
    for key, number, canonical in db.execute(query):
        study: dict[str, Any] = json.loads(canonical)
        if caller.role == "operator" and study["blinding"]["operator"]:
            continue
        chosen = study.get("avatar_configuration") or {}
        bodies = {one.get("body") for one in study["conditions"]} - {None}
        if (chosen.get("key"), chosen.get("version")) in worn or name in bodies:
            title = study["title"]
            yield WornBy(
                key=key,
                title=title.get("en") or next(iter(title.values()), key),
                version=number,
            )
