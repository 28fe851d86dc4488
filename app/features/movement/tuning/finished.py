"""Use a finished tuning: its curves, the accepted gains, comparisons, and versions of an avatar."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput
from app.features.movement.avatar import (
    NewAvatar,
    NewAvatarVersion,
    add_avatar_version,
    create_avatar,
    version_of,
)
from app.features.movement.captures import Mapped, mapped_capture
from app.features.movement.tuning.order import TunedBody, tuning_options
from app.features.movement.tuning.report import tuning_note
from app.features.movement.tuning.results import gain_changes, tuned_axes, with_accepted
from app.features.movement.tuning.schemas import AcceptedConfiguration, TuningSaved
from app.features.movement.tuning.service import TUNINGS, body_of, configuration_of
from app.features.movement.tuning.worker_tasks import RelayRun
from app.models import AvatarTuningRow
from app.platform.access import Caller
from app.platform.context import AppContext
from app.protocol.avatar import file_of, loaded, parse_avatar_json
from app.science.avatar.configuration import Configuration
from app.science.avatar.tuning import RelaySettings


def accepted_configuration(
    db: Session, tuning_id: str, accepted: Sequence[str]
) -> AcceptedConfiguration:
    """Return the configuration with the accepted gains; raise NotFound, NotNow, InvalidInput."""
    before, chosen = _accepted(TUNINGS.ready(db, tuning_id), accepted)
    return AcceptedConfiguration(
        configuration=file_of(chosen),
        content_hash=loaded(chosen).content_hash,
        changed=list(gain_changes(before, chosen)),
    )


def save_accepted(
    db: Session, context: AppContext, caller: Caller, tuning_id: str, request: TuningSaved
) -> None:
    """Save the accepted gains as a version, together with the report of the tuning.

    Raises NotFound, NotNow, InvalidInput, StaleVersion, and Conflict if the new key is taken, if
    `based_on` is not what was tuned, or if a version with these gains has another note.
    """
    row = TUNINGS.ready(db, tuning_id)
    before, chosen = _accepted(row, request.accepted)
    accepted = list(dict.fromkeys(request.accepted))
    tuned = tuned_axes(before, tuning_options(row.options))
    if not accepted:
        raise InvalidInput(
            "no axis is accepted, so nothing would be saved",
            value=accepted,
            valid=list(tuned),
            remedy="Accept at least one axis of this tuning.",
        )
    if request.based_on != 0:
        _require_tuned(db, row, request)
    summary = cast("dict[str, Any]", row.summary)
    report = {**summary["report"], "accepted": accepted}
    note = request.note or tuning_note(
        tuning_options(row.options), row.stature_m, (len(accepted), len(tuned))
    )
    content, now = file_of(chosen), context.clock.utc_now()
    if request.based_on == 0:
        new = NewAvatar(
            key=request.key,
            title=request.title or request.key,
            origin="tuned",
            note=note,
            configuration=content,
        )
        create_avatar(db, caller.actor, new, now, report=report)
        return
    more = NewAvatarVersion(
        based_on=request.based_on, origin="tuned", note=note, configuration=content
    )
    add_avatar_version(db, caller.actor, request.key, more, now, report=report)


@dataclass(frozen=True)
class AxisAsked:
    """What the curves of an axis are computed from; see `worker_tasks.axis_curves`."""

    before: TunedBody
    after: TunedBody
    relay_axis: str
    relay: RelayRun | None


def asked_axis(context: AppContext, tuning_id: str, axis: str) -> AxisAsked:
    """Return what the curves of an axis are computed from.

    Raises NotFound, NotNow, or InvalidInput for an axis that has none.
    """
    with context.database.reading() as db:
        row = TUNINGS.ready(db, tuning_id)
        summary = cast("dict[str, Any]", row.summary)
        stepped = {one["name"]: one for one in summary["report"]["axes"] if one["step_deg"]}
        if axis not in stepped:
            raise InvalidInput(
                f"{axis} was not tuned, so it has no curves",
                value=axis,
                valid=list(stepped),
                remedy="Choose an axis that was tuned.",
            )
        one, longest_s = stepped[axis], row.options["longest_s"]
        return AxisAsked(
            body_of(db, row, row.canonical_json),
            body_of(db, row, summary["canonical_json"]),
            one["mirrored_from"] or axis,
            None if one["relay"] is None else _relay_run(one["relay"], longest_s),
        )


@dataclass(frozen=True)
class ComparedAsked:
    """What a comparison is computed from; see `worker_tasks.compared`."""

    before: TunedBody
    after: TunedBody
    capture: Mapped | None


def asked_comparison(
    context: AppContext, tuning_id: str, accepted: Sequence[str], capture_id: str | None
) -> ComparedAsked:
    """Return what a comparison is computed from.

    Raises NotFound, NotNow, InvalidInput, and Conflict if the capture's joint map is incomplete.
    """
    with context.database.reading() as db:
        row = TUNINGS.ready(db, tuning_id)
        _, chosen = _accepted(row, accepted)
        before = body_of(db, row, row.canonical_json)
        after = body_of(db, row, loaded(chosen).canonical_json)
    capture = None if capture_id is None else mapped_capture(context, capture_id)
    return ComparedAsked(before, after, capture)


def _relay_run(stored: dict[str, Any], longest_s: float) -> RelayRun:
    settings = RelaySettings(
        torque_nm=stored["torque_nm"],
        damping_nm_s=stored["damping_nm_s"],
        hysteresis_rad=math.radians(stored["hysteresis_deg"]),
        warm_up_cycles=stored["warm_up_cycles"],
        cycles=stored["cycles"],
        step_s=stored["step_s"],
        longest_s=longest_s,
    )
    return RelayRun(settings, stored["pose"])


def _accepted(row: AvatarTuningRow, accepted: Sequence[str]) -> tuple[Configuration, Configuration]:
    """Return the configuration before, and the one with the accepted gains."""
    before = configuration_of(row)
    after = parse_avatar_json(cast("dict[str, Any]", row.summary)["canonical_json"])
    tuned = tuned_axes(before, tuning_options(row.options))
    for name in accepted:
        if name not in tuned:
            raise InvalidInput(
                f"{name} was not tuned, so it has no new gains",
                value=name,
                valid=list(tuned),
                remedy="Accept axes of this tuning only.",
            )
    return before, with_accepted(before, after, accepted)


def _require_tuned(db: Session, row: AvatarTuningRow, request: TuningSaved) -> None:
    """Raise Conflict if the version to be continued is not the one that was tuned."""
    if (row.key, row.number) == (request.key, request.based_on):
        return
    version = version_of(db, request.key, request.based_on)
    if version.content_hash == row.content_hash:
        return
    named = "an unsaved configuration" if row.key is None else f"{row.key}@{row.number}"
    raise Conflict(
        f"this tuning tuned {named} ({row.content_hash[:12]}), not {version.key}@{version.number}"
        f" ({version.content_hash[:12]}), whose other settings would be lost",
        value=f"{version.key}@{version.number}",
        valid=named,
        remedy="Save it under a new key, or tune this version. Nothing was saved.",
    )
