"""The physics avatar of a session: built for the participant, recorded, and sent to the headset.

The model follows from configuration, stature and scene. It is nevertheless recorded as a whole: a
later version of the product may build a different model, and the avatar that a participant had must
remain on record. The model reveals the participant's measurements, so it is stored as content next
to the event log and is removed by an erasure.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput, NotFound
from app.features.movement.avatar import (
    SHIPPED,
    avatar_by_key,
    configuration_by_hash,
    newest_version,
)
from app.features.movement.humanoids import (
    body_by_name,
    figure_by_hash,
    humanoid_by_hash,
    named_bodies,
)
from app.features.record.sessions import (
    AVATAR,
    RUNS,
    RecordAvatar,
    apply_command,
    content_body,
    contents_of,
    protocol_of_session,
    require_capture,
    state_of,
    store_content,
)
from app.models import StudySession
from app.platform.access import session_by_id
from app.platform.context import AppContext
from app.protocol import BodyName, StudyProtocol, Tasks
from app.protocol.avatar import AvatarFile, file_of
from app.science.avatar.body import BodyError, Figure, proportions
from app.science.avatar.configuration import DEFAULT_OPTIONS, Configuration, missing_part_problems
from app.science.avatar.mjcf import AvatarModel, avatar_model, scene_of

Length = Annotated[float, Field(gt=0.0, le=3.0, allow_inf_nan=False, strict=True)]


class AvatarWish(BaseModel):
    """A request for a physics avatar: the participant's stature and any other lengths measured.

    `segments_m`: lengths by the names of docs/avatar-configuration.md; lengths left out follow from
    the stature. A shipped body has arms of the measured lengths; a body that was uploaded keeps its
    own lengths and uses none of them, but they must fit the stature there, too. `body`:
    the body to wear, one of those that the study's conditions name; if left
    out, the body of the avatar's configuration.
    """

    model_config = ConfigDict(extra="forbid")

    stature_m: Annotated[float, Field(ge=0.5, le=2.6, allow_inf_nan=False, strict=True)]
    segments_m: Annotated[dict[str, Length], Field(max_length=40)] = {}
    body: BodyName | None = None


class SessionAvatar(BaseModel):
    """A physics avatar in its study's scene, ready to be simulated.

    `mjcf` is the MuJoCo model with the boxes of all tasks, each named after its surface; the client
    shows those of the current phase. `model_hash` is the SHA-256 of its bytes and
    `configuration_hash` that of the session's configuration, both as recorded. `body` is the
    requested body and `humanoid` the hash of its model; `configuration` is the session's with that
    model. Added latency is set while the simulation runs, up to `longest_delay_s`.
    `standing_hips_m`: the height of the model's hips when it stands; since a model may have other
    leg lengths than the participant, the participant's hip height is scaled to it. `segments_m`:
    the measured lengths that the body has; the model named by `humanoid` is drawn with them, too.
    """

    stature_m: float
    configuration_hash: str
    configuration: AvatarFile
    model_hash: str
    mjcf: str
    longest_delay_s: float
    standing_hips_m: float
    body: str | None = None
    humanoid: str | None = None
    segments_m: dict[str, float] = {}


MS_PER_S = 1000.0
ARM_SEGMENTS = ("upper_arm", "forearm")
"""Measured lengths that a shipped body takes on."""


@dataclass(frozen=True)
class PreparedAvatar:
    """A physics avatar that was built but not recorded yet."""

    avatar: SessionAvatar


def prepare(db: Session, session_id: str, request: AvatarWish) -> PreparedAvatar:
    """Build the session's physics avatar; call this before opening the write transaction.

    Building takes too long for a write transaction, which others wait for. Raises Conflict if the
    session's avatar is not a physics avatar, and InvalidInput for lengths
    that no body has and for a body that no condition of the study names.
    """
    session = session_by_id(db, session_id)
    if session.avatar_configuration_hash is None:
        raise Conflict(
            "the avatar of this session is not moved by physics",
            value=session.avatar,
            remedy="Show the delayed copy; it needs no model.",
        )
    configuration = configuration_by_hash(db, session.avatar_configuration_hash)
    protocol = protocol_of_session(db, session)
    return _prepared(db, configuration, session.avatar_configuration_hash, protocol, request)


def trial_avatar(db: Session, session_id: str, stature_m: float) -> SessionAvatar:
    """Build the avatar that the session has at this stature, without recording it.

    For a session without a physics avatar it is the newest version of the standard one.
    """
    session = session_by_id(db, session_id)
    content_hash = session.avatar_configuration_hash
    if content_hash is None:
        content_hash = newest_version(db, avatar_by_key(db, SHIPPED)).content_hash
    configuration = configuration_by_hash(db, content_hash)
    protocol = protocol_of_session(db, session)
    wish = AvatarWish(stature_m=stature_m)
    return _prepared(db, configuration, content_hash, protocol, wish).avatar


def _prepared(
    db: Session,
    configuration: Configuration,
    configuration_hash: str,
    protocol: StudyProtocol,
    request: AvatarWish,
) -> PreparedAvatar:
    configuration = _with_body(db, configuration, protocol, request.body)
    largest_s = max(one.latency_ms for one in protocol.conditions) / MS_PER_S
    longest_s = max(largest_s, DEFAULT_OPTIONS.longest_delay_s)
    stature_m = round(request.stature_m, 3)
    figure = figure_by_hash(db, configuration.humanoid)
    _require_plausible(stature_m, request.segments_m)
    worn_m: Mapping[str, float] = request.segments_m
    if figure is not None:
        worn_m = _arms_of(db, configuration, request.segments_m)
        figure = figure.scaled(stature_m).with_arms(worn_m)
    model = _built(configuration, figure, stature_m, worn_m, protocol.tasks, longest_s)
    avatar = SessionAvatar(
        stature_m=stature_m,
        configuration_hash=configuration_hash,
        configuration=file_of(configuration),
        model_hash=model.content_hash,
        mjcf=model.mjcf,
        longest_delay_s=longest_s,
        standing_hips_m=model.body.parts["Hips"].joint_m[1],
        body=request.body,
        humanoid=configuration.humanoid,
        segments_m=dict(worn_m),
    )
    return PreparedAvatar(avatar)


def _arms_of(
    db: Session, configuration: Configuration, measured_m: Mapping[str, float]
) -> Mapping[str, float]:
    """Return the measured lengths that the model of a configuration takes on.

    Shipped bodies are made for people of any proportions; a model that was uploaded keeps its own,
    which may be what a study varies.
    """
    if configuration.humanoid is None:
        return {}
    if humanoid_by_hash(db, configuration.humanoid).origin != "shipped":
        return {}
    return {name: measured_m[name] for name in ARM_SEGMENTS if name in measured_m}


def record_avatar(
    db: Session, context: AppContext, session_id: str, prepared: PreparedAvatar, actor: str
) -> None:
    """Record the model of an avatar, unless it is the last one recorded for the same body.

    Raises Conflict for another model after the session's end, and Withdrawn and the other errors
    that apply to everything a headset sends.
    """
    session = session_by_id(db, session_id, lock=True)
    require_capture(db, session_id)
    avatar = prepared.avatar
    recorded = [content_body(row) for row in contents_of(db, session.id, AVATAR)]
    own = [one for one in recorded if isinstance(one, dict) and one.get("body") == avatar.body]
    if own and own[-1].get("model_hash") == avatar.model_hash:
        return
    if session.status not in RUNS:
        raise Conflict(
            f"the session is {session.status}, so nobody wears another body in it",
            value=session.status,
            valid=list(RUNS),
            remedy="Start another session.",
        )
    body = {
        **({} if avatar.body is None else {"body": avatar.body, "humanoid": avatar.humanoid}),
        "stature_m": avatar.stature_m,
        "segments_m": avatar.segments_m,
        "configuration_hash": avatar.configuration_hash,
        "model_hash": avatar.model_hash,
        "mjcf": avatar.mjcf,
    }
    now = context.clock.utc_now()
    content = store_content(db, session_id=session.id, kind=AVATAR, body=body, by=actor, now=now)
    command = RecordAvatar(
        configuration_hash=avatar.configuration_hash, content=content, body=avatar.body
    )
    apply_command(db, context, session, command, actor=actor)


def require_own_body(db: Session, session_id: str, content_hash: str) -> None:
    """Raise NotFound unless the session's headset can show the model with this hash."""
    if content_hash not in _bodies_of(db, session_by_id(db, session_id)):
        raise NotFound(
            "the avatar of this session wears no such body",
            value=content_hash,
            remedy="Fetch the bodies that POST /api/vr/avatar names as 'humanoid'.",
        )


def _bodies_of(db: Session, session: StudySession) -> frozenset[str]:
    """Return the hashes of all models that the session's headset can show, at any time.

    They are the body of the avatar's configuration and those that the study's conditions name, so
    neither an answer nor a request tells which body comes next; and that of the companion.
    """
    companion = state_of(session).companion
    shown = None if companion is None else companion.humanoid
    if session.avatar_configuration_hash is None:
        return frozenset() if shown is None else frozenset((shown,))
    configured = configuration_by_hash(db, session.avatar_configuration_hash).humanoid
    named = named_bodies(db)
    prescribed = (named.get(name) for name in protocol_of_session(db, session).bodies)
    return frozenset(one for one in (configured, shown, *prescribed) if one is not None)


def _with_body(
    db: Session, configuration: Configuration, protocol: StudyProtocol, body: str | None
) -> Configuration:
    """Return the configuration with the model of the named body; unchanged for None."""
    if body is None:
        return configuration
    if body not in protocol.bodies:
        raise InvalidInput(
            f"no condition of this study wears the body {body!r}",
            value=body,
            valid=list(protocol.bodies),
            remedy="Request one of these, or leave 'body' out for the body of the configuration.",
        )
    return replace(configuration, humanoid=body_by_name(db, body).hash)


def _built(
    configuration: Configuration,
    figure: Figure | None,
    stature_m: float,
    worn_m: Mapping[str, float],
    tasks: Tasks,
    longest_delay_s: float,
) -> AvatarModel:
    for one in missing_part_problems(configuration):
        raise Conflict(
            f"the avatar of this session cannot be used: {one.message}",
            value=one.value,
            valid=one.valid,
            remedy="Save a version of it in which these parts have all their axes, name that in a "
            "new version of the study, and start the session with this one.",
        )
    try:
        return avatar_model(
            configuration,
            stature_m,
            segments_m=worn_m if figure is None else {},
            figure=figure,
            scene=scene_of(tuple(tasks.layouts().values())),
            longest_delay_s=longest_delay_s,
        )
    except BodyError as error:
        raise _no_such_body(error, stature_m, worn_m) from None


def _require_plausible(stature_m: float, measured_m: Mapping[str, float]) -> None:
    """Raise InvalidInput for lengths that nobody has, also where the body does not use them."""
    try:
        proportions(stature_m, measured_m)
    except BodyError as error:
        raise _no_such_body(error, stature_m, measured_m) from None


def _no_such_body(
    error: BodyError, stature_m: float, measured_m: Mapping[str, float]
) -> InvalidInput:
    return InvalidInput(
        f"there is no such body: {error}",
        value={"stature_m": stature_m, **measured_m},
        remedy="Measure the participant again, or leave the lengths of segments out.",
    )
