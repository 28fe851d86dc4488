"""Follow the changes that were made to the avatar in a phase, on the phase's clock."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.movement.avatar import configuration_by_hash
from app.features.record.sessions import changes_from, events_of
from app.features.results.replay.clock import PhaseClock
from app.features.results.replay.schemas import ReplayAvatarSettings
from app.models import ClientReport, Phase, SessionEvent, StudySession
from app.protocol import settings_in_force


def avatar_settings(
    db: Session, session: StudySession, phase: Phase, clock: PhaseClock
) -> list[ReplayAvatarSettings]:
    """Return which parts were in a cast or had no collider, from each change in the phase on.

    A change counts from when the headset reported it; until then, or if it never did, from when it
    was recorded. Empty if nothing was changed in this phase.
    """
    if session.avatar_configuration_hash is None:
        return []
    log = events_of(db, session.id)
    if all(row.type != "avatar_changed" for row in log):
        return []
    configuration = configuration_by_hash(db, session.avatar_configuration_hash)
    applied_s = _applied_s(db, session, clock)
    found: list[ReplayAvatarSettings] = []
    for row, by in _changes(log, phase.phase_id):
        at_s = _time_of(row, phase, clock, applied_s)
        # The settings follow each other as they were recorded, however the clocks are placed.
        at_s = max(at_s, found[-1].t_s if found else 0.0)
        settings = settings_in_force(
            configuration, changes_from(by["study"]), changes_from(by["operator"])
        )
        settled = ReplayAvatarSettings(
            t_s=min(at_s, clock.duration_s),
            held_parts=list(settings.held_parts),
            passing_parts=list(settings.passing_parts),
        )
        if found and found[-1].t_s == settled.t_s:
            found.pop()
        found.append(settled)
    nothing = all(not (one.held_parts or one.passing_parts) for one in found)
    return [] if nothing else found


def _time_of(
    row: SessionEvent, phase: Phase, clock: PhaseClock, applied_s: Mapping[int, float]
) -> float:
    """Return when a change was made on the phase's clock; 0 if that did not run yet."""
    if phase.started_at is None or row.recorded_at <= phase.started_at:
        return 0.0
    at_s = applied_s.get(row.seq)
    return clock.of_utc(row.recorded_at) or 0.0 if at_s is None else at_s


def _changes(
    log: list[SessionEvent], phase_id: int
) -> Iterator[tuple[SessionEvent, dict[str, Mapping[str, Any] | None]]]:
    """Yield the phase's preparation and each change in it, with what is in force from then on."""
    by: dict[str, Mapping[str, Any] | None] = {"study": None, "operator": None}
    is_here = False
    for row in log:
        payload = json.loads(row.payload)
        own = payload.get("phase_id") == phase_id
        if row.type == "avatar_changed":
            by[payload["by"]] = payload["changes"] or None
        elif row.type == "phase_prepared":
            by["study"], is_here = None, own
        elif row.type in ("phase_ended", "phase_voided") and own:
            return
        else:
            continue
        if is_here:
            yield row, dict(by)


def _applied_s(db: Session, session: StudySession, clock: PhaseClock) -> dict[int, float]:
    """Return, by the number of the change, when the headset first applied it in this phase."""
    reports = db.scalars(
        select(ClientReport)
        .where(
            ClientReport.session_id == session.id,
            ClientReport.type == "avatar_changes",
            ClientReport.accepted,
        )
        .order_by(ClientReport.epoch, ClientReport.seq)
    )
    found: dict[int, float] = {}
    for row in reports:
        offset_s = clock.offsets_s.get(row.epoch)
        if offset_s is not None and row.payload["applied"]:
            found.setdefault(row.payload["revision"], row.payload["t_s"] + offset_s)
    return found
