"""Determine how the running avatar of a session differs from its configuration now."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy.orm import Session

from app.features.movement.avatar import configuration_by_hash
from app.features.record.sessions.contents import content_body
from app.features.record.sessions.engine import SessionState
from app.features.record.sessions.service import state_of
from app.models import SessionContent, StudySession
from app.protocol import AvatarChanges, settings_in_force
from app.science.avatar.configuration import RunningSettings, as_configured

AVATAR_CHANGE = "avatar_change"
"""The kind of stored content that has what a headset reported on a change of the avatar."""


@dataclass(frozen=True)
class AvatarReport:
    """What the headset reported on the changes in force.

    `held_rad`: the angle of each axis in a cast. `problem`: why they could not be applied.
    """

    applied: bool
    held_rad: Mapping[str, float]
    problem: str | None


@dataclass(frozen=True)
class AvatarInForce:
    """The changes in force of a session, and the settings that follow from them.

    `revision`: the number of the event since which they are in force. `report`: None until the
    headset has reported on this revision.
    """

    revision: int
    study: AvatarChanges | None
    operator: AvatarChanges | None
    configured: RunningSettings
    settings: RunningSettings
    report: AvatarReport | None


def avatar_in_force(db: Session, session: StudySession) -> AvatarInForce | None:
    """Return the changes in force; None if nothing was ever changed, or the session has ended."""
    state = state_of(session)
    changes = state.avatar_changes
    if changes is None or session.avatar_configuration_hash is None:
        return None
    configuration = configuration_by_hash(db, session.avatar_configuration_hash)
    study, operator = changes_from(changes.study), changes_from(changes.operator)
    return AvatarInForce(
        revision=changes.revision,
        study=study,
        operator=operator,
        configured=as_configured(configuration),
        settings=settings_in_force(configuration, study, operator),
        report=_report(db, state),
    )


def changes_from(content: Mapping[str, Any] | None) -> AvatarChanges | None:
    """Return changes that were recorded in an event; None if there are none."""
    return AvatarChanges.model_validate(content) if content else None


def _report(db: Session, state: SessionState) -> AvatarReport | None:
    changes = state.avatar_changes
    if changes is None or changes.reported != changes.revision:
        return None
    row = None if changes.content_id is None else db.get(SessionContent, changes.content_id)
    body = None if row is None else content_body(row)
    content = body if isinstance(body, dict) else {}
    return AvatarReport(
        applied=changes.applied is True,
        held_rad={str(name): float(angle) for name, angle in content.get("held_rad", {}).items()},
        problem=content.get("problem"),
    )
