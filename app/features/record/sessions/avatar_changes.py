"""Determine how the running avatar of a session differs from its configuration now."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy.orm import Session

from app.features.movement.avatar import configuration_by_hash
from app.features.record.sessions.contents import content_body
from app.features.record.sessions.service import state_of
from app.models import SessionContent, StudySession
from app.protocol import AvatarChanges, settings_in_force
from app.science.avatar.configuration import RunningSettings, as_configured

AVATAR_CHANGE = "avatar_change"
"""The kind of stored content that has what a headset reported on a change of the avatar."""


@dataclass(frozen=True)
class AvatarReport:
    """What the headset reported on the changes in force; `problem`: why it could not apply them."""

    applied: bool
    problem: str | None


@dataclass(frozen=True)
class AvatarInForce:
    """The changes in force of a session, and the settings that follow from them.

    `revision`: the number of the event since which they are in force. `report`: None until the
    headset has reported on this revision. `held_rad`: the angles of axes in a cast, as last
    reported.
    """

    revision: int
    study: AvatarChanges | None
    operator: AvatarChanges | None
    configured: RunningSettings
    settings: RunningSettings
    report: AvatarReport | None
    held_rad: Mapping[str, float]


def avatar_in_force(db: Session, session: StudySession) -> AvatarInForce | None:
    """Return the changes in force; None if nothing was ever changed, or the session has ended."""
    changes = state_of(session).avatar_changes
    if changes is None or session.avatar_configuration_hash is None:
        return None
    configuration = configuration_by_hash(db, session.avatar_configuration_hash)
    study, operator = changes_from(changes.study), changes_from(changes.operator)
    said = _content(db, changes.content_id)
    is_current = changes.reported == changes.revision
    return AvatarInForce(
        revision=changes.revision,
        study=study,
        operator=operator,
        configured=as_configured(configuration),
        settings=settings_in_force(configuration, study, operator),
        report=AvatarReport(changes.applied is True, said.get("problem")) if is_current else None,
        held_rad=said.get("held_rad", {}),
    )


def changes_from(content: Mapping[str, Any] | None) -> AvatarChanges | None:
    """Return changes that were recorded in an event; None if there are none."""
    return AvatarChanges.model_validate(content) if content else None


def _content(db: Session, content_id: str | None) -> dict[str, Any]:
    """Return what a headset reported; empty if that was nothing, or was erased."""
    row = None if content_id is None else db.get(SessionContent, content_id)
    body = None if row is None else content_body(row)
    return body if isinstance(body, dict) else {}
