"""Determine how the running avatar of a session differs from its configuration now."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy.orm import Session

from app.features.movement.avatar import configuration_by_hash
from app.features.record.sessions.contents import content_body
from app.features.record.sessions.service import state_of
from app.models import SessionContent, SessionEvent, StudySession
from app.protocol import AvatarChanges, settings_in_force
from app.science.avatar.configuration import RunningSettings, as_configured

AVATAR_CHANGE = "avatar_change"
"""The kind of stored content for a headset's report on a change of the avatar."""


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


def changed_phases(log: Iterable[SessionEvent]) -> dict[int, list[str]]:
    """Return who had changed the avatar in each phase of a session: `study`, `operator` or both.

    The operator's changes count in every phase in which they were in force, or were made or taken
    back. `log` is the event log of one session from its start; only these events matter:
    avatar_changed, phase_prepared, phase_ended and phase_voided.
    """
    found: dict[int, set[str]] = {}
    current: int | None = None
    is_changed = False
    for row in log:
        event = json.loads(row.payload)
        match row.type:
            case "phase_prepared":
                current = event["phase_id"]
                if is_changed:
                    found.setdefault(event["phase_id"], set()).add("operator")
            case "phase_ended" | "phase_voided" if event["phase_id"] == current:
                current = None
            case "avatar_changed":
                if event["phase_id"] is not None:
                    found.setdefault(event["phase_id"], set()).add(event["by"])
                if event["by"] == "operator":
                    is_changed = bool(event["changes"])
    return {phase_id: sorted(by, reverse=True) for phase_id, by in found.items()}


def changes_from(content: Mapping[str, Any] | None) -> AvatarChanges | None:
    """Return changes that were recorded in an event; None if there are none."""
    return AvatarChanges.model_validate(content) if content else None


def _content(db: Session, content_id: str | None) -> dict[str, Any]:
    """Return what a headset reported; empty if it reported nothing, or if the report was erased."""
    row = None if content_id is None else db.get(SessionContent, content_id)
    body = None if row is None else content_body(row)
    return body if isinstance(body, dict) else {}
