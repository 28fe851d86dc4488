"""Order tunings of avatars, let their queue follow, and show them."""

from typing import Final, cast

from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotDurable
from app.features.movement.avatar import checked, typed, version_of
from app.features.movement.humanoids import humanoid_by_hash, parsed_figure
from app.features.movement.jobs import JobKind
from app.features.movement.tuning.folder import DamagedProgress
from app.features.movement.tuning.order import TunedBody, TuningOrder, tuning_options
from app.features.movement.tuning.results import measured_axes, reported_axes, tuned_axes
from app.features.movement.tuning.schemas import (
    AvatarNamed,
    NewTuning,
    State,
    TunedAxis,
    TuningChoice,
    TuningListed,
    TuningProgressView,
    TuningView,
)
from app.features.movement.tuning.tuning_queue import TuningQueue
from app.models import AvatarTuningRow, new_id
from app.platform.access import Caller
from app.platform.config_problems import require_sound
from app.platform.context import AppContext
from app.protocol.avatar import loaded, parse_avatar_json
from app.science.avatar.configuration import Configuration, without_parts

TUNINGS: Final = JobKind(
    table=AvatarTuningRow,
    noun="tuning",
    running="tuning",
    action="avatar.tuning",
    subject="avatar_tuning",
    details=lambda row: {"avatar": row.key, "content": row.content_hash[:12]},
)


def tuning_list(db: Session, context: AppContext) -> list[TuningListed]:
    """Return all tunings, newest first."""
    return [_listed(row, context) for row in TUNINGS.newest_first(db)]


def tuning_view(db: Session, context: AppContext, tuning_id: str) -> TuningView:
    """Return one tuning with every axis; raise NotFound if there is none with this id."""
    row = TUNINGS.by_id(db, tuning_id)
    before, summary = configuration_of(row), row.summary
    tuned: list[TunedAxis]
    if summary is None:
        measured = context.part(TuningQueue).files(row.id).measured()
        tuned = measured_axes(before, tuning_options(row.options), measured)
    else:
        tuned = reported_axes(before, summary["report"])
    return TuningView(
        **_listed(row, context).model_dump(exclude={"axes"}),
        options=TuningChoice.model_validate(row.options),
        tuned=tuned,
        report=None if summary is None else summary["report"],
        cpu_s=None if summary is None else summary["cpu_s"],
    )


def order_tuning(db: Session, context: AppContext, caller: Caller, request: NewTuning) -> str:
    """Store the order of a tuning and return its id; `follow_tuning` starts it after the commit.

    Raises NotFound, InvalidConfig, InvalidInput if the options do not allow a tuning, or Busy if
    too many are unfinished.
    """
    named, configuration = _asked_configuration(db, request)
    if configuration.humanoid is not None:
        body = humanoid_by_hash(db, configuration.humanoid, lock=True)
        figure = parsed_figure(body.figure)
        configuration = without_parts(configuration, frozenset(figure.absent))
    _require_known(configuration, request.options)
    stored = request.options.model_dump(mode="json")
    tuned = tuned_axes(configuration, tuning_options(stored))
    if not tuned:
        free = [name for name in configuration.axes if name not in configuration.locked_axes]
        raise InvalidInput(
            "none of the chosen axes can be tuned",
            value=request.options.axes,
            valid=free,
            remedy="Choose an axis that can turn, or unlock its group.",
        )
    idle = [name for name in request.options.relay_torques_nm if name not in tuned]
    if idle:
        raise InvalidInput(
            f"a relay torque is given for {', '.join(idle)}, which this tuning does not tune",
            value=idle,
            valid=list(tuned),
            remedy="Leave these torques out, or choose and unlock their axes.",
        )
    content = loaded(configuration)
    row = AvatarTuningRow(
        id=new_id(),
        key=None if named is None else named.key,
        number=None if named is None else named.version,
        content_hash=content.content_hash,
        canonical_json=content.canonical_json,
        stature_m=request.stature_m,
        options=stored,
        state="tuning",
        by=caller.actor,
        at=context.clock.utc_now(),
    )
    TUNINGS.order(db, context, caller, row)
    return row.id


def _require_known(configuration: Configuration, options: TuningChoice) -> None:
    """Raise InvalidInput for axes that the body does not have."""
    for given, names in (
        ("the axes to tune include", options.axes or ()),
        ("a relay torque is given for", options.relay_torques_nm),
    ):
        unknown = [name for name in names if name not in configuration.axes]
        if unknown:
            raise InvalidInput(
                f"{given} {', '.join(map(repr, unknown))}, which is no axis of this body",
                value=unknown,
                valid=list(configuration.axes),
                remedy="Name axes of this body; nothing was started.",
            )


def follow_tuning(context: AppContext, tuning_id: str) -> TuningView:
    """Start, keep or end the work on a tuning as its committed state says, and return it."""
    context.part(TuningQueue).follow(tuning_id, _order_of)
    with context.database.reading() as db:
        return tuning_view(db, context, tuning_id)


def _asked_configuration(
    db: Session, request: NewTuning
) -> tuple[AvatarNamed | None, Configuration]:
    if request.configuration is not None:
        return None, checked(db, request.configuration).configuration
    named = cast("AvatarNamed", request.avatar)
    version = version_of(db, named.key, named.version)
    return AvatarNamed(key=version.key, version=version.number), typed(version)


def _order_of(db: Session, tuning_id: str) -> TuningOrder:
    row = TUNINGS.by_id(db, tuning_id)
    return TuningOrder(body_of(db, row, row.canonical_json), row.options)


def body_of(db: Session, row: AvatarTuningRow, canonical_json: str) -> TunedBody:
    """Return the body of a tuning with another configuration; raise NotDurable if damaged."""
    require_sound(row.canonical_json, row.content_hash)
    humanoid = parse_avatar_json(canonical_json).humanoid
    figure = None if humanoid is None else humanoid_by_hash(db, humanoid).figure
    return TunedBody(canonical_json, figure, row.stature_m)


def configuration_of(row: AvatarTuningRow) -> Configuration:
    """Return the configuration that was to be tuned; raise NotDurable if it was damaged."""
    require_sound(row.canonical_json, row.content_hash)
    return parse_avatar_json(row.canonical_json)


def _number_of_axes(row: AvatarTuningRow) -> int | None:
    try:
        return len(tuned_axes(configuration_of(row), tuning_options(row.options)))
    except NotDurable:
        return None


def _listed(row: AvatarTuningRow, context: AppContext) -> TuningListed:
    progress, damage = _progress(row, context)
    return TuningListed(
        id=row.id,
        state=cast("State", row.state),
        avatar=None if row.key is None else AvatarNamed(key=row.key, version=row.number),
        content_hash=row.content_hash,
        stature_m=row.stature_m,
        axes=_number_of_axes(row),
        progress=progress,
        trouble=row.trouble or damage,
        by=row.by,
        at=row.at,
        ended_at=row.ended_at,
    )


def _progress(
    row: AvatarTuningRow, context: AppContext
) -> tuple[TuningProgressView | None, str | None]:
    """Return the progress of a tuning that is not ready, and what of it is damaged."""
    if row.state == "ready":
        return None, None
    queue, damage = context.part(TuningQueue), None
    try:
        told = queue.files(row.id).progress()
    except DamagedProgress as error:
        told = None
        damage = (
            f"the files of this tuning are damaged ({error}): resume it, which measures again only"
            " what its journal lacks, or delete it"
        )
    waiting = row.state == "tuning" and (queue.place_of(row.id) != "started" or told is None)
    if told is None:
        none = TuningProgressView(
            waiting=waiting, attempt=1, phase="relay", axis="", done=0, total=0
        )
        return none, damage
    progress = TuningProgressView(
        waiting=waiting,
        attempt=told.attempt,
        phase=told.phase,
        axis=told.axis,
        done=told.done,
        total=told.total,
    )
    return progress, None
