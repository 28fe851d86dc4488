"""The physics avatar of a session: built for the participant, put on record, handed to the headset.

The model follows from configuration, stature and scene. It is recorded as a whole all the same: a
later version of the product may build another, and what a participant met must stay known. It tells
the participant's measures, so it is content beside the event log and goes with an erasure.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput
from app.features.movement.avatar import configuration_by_hash
from app.features.movement.humanoids import figure_by_hash
from app.features.record.sessions import (
    RecordAvatar,
    apply_command,
    content_body,
    contents_of,
    protocol_of_session,
    require_capture,
    store_content,
)
from app.platform.access import session_by_id
from app.platform.context import AppContext
from app.protocol import Tasks
from app.protocol.avatar import AvatarFile, file_of
from app.science.avatar.body import BodyError, Figure
from app.science.avatar.configuration import DEFAULT_OPTIONS, Configuration
from app.science.avatar.mjcf import AvatarModel, avatar_model, scene_of

Length = Annotated[float, Field(gt=0.0, le=3.0, allow_inf_nan=False)]


class AvatarWish(BaseModel):
    """Whose body it is: the participant's stature, and what else was measured of it.

    `segments_m`: lengths by the names of docs/avatar-configuration.md; the others follow from the
    stature.
    """

    model_config = ConfigDict(extra="forbid")

    stature_m: Annotated[float, Field(ge=0.5, le=2.6, allow_inf_nan=False)]
    segments_m: Annotated[dict[str, Length], Field(max_length=40)] = {}


class SessionAvatar(BaseModel):
    """A physics avatar in its study's scene, to be simulated as it stands.

    `mjcf` is the MuJoCo model with the boxes of all tasks, each named after its surface; the client
    shows those of the present phase. `model_hash` is the SHA-256 of its bytes and
    `configuration_hash` that of the configuration, both as they are on record. Added latency is set
    while it runs, up to `longest_delay_s`. `standing_hips_m`: how high its hips are when it stands;
    a model may have other legs than the participant, whose hips' height is scaled to it.
    """

    stature_m: float
    configuration_hash: str
    configuration: AvatarFile
    model_hash: str
    mjcf: str
    longest_delay_s: float
    standing_hips_m: float


CONTENT = "avatar"
"""Kind of the contents that hold models."""
MS_PER_S = 1000.0


@dataclass(frozen=True)
class Prepared:
    """A model that was built, and not yet recorded."""

    told: SessionAvatar
    segments_m: Mapping[str, float]


def prepare(db: Session, session_id: str, wish: AvatarWish) -> Prepared:
    """Build the session's avatar; done before the writing turn, which others wait for.

    Raises Conflict where the session's avatar is none of physics, InvalidInput for lengths that no
    body has.
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
    latest_s = max(one.latency_ms for one in protocol.conditions) / MS_PER_S
    longest_s = max(latest_s, DEFAULT_OPTIONS.longest_delay_s)
    stature_m = round(wish.stature_m, 3)
    figure = figure_by_hash(db, configuration.humanoid)
    model = _built(configuration, figure, stature_m, wish.segments_m, protocol.tasks, longest_s)
    told = SessionAvatar(
        stature_m=stature_m,
        configuration_hash=session.avatar_configuration_hash,
        configuration=file_of(configuration),
        model_hash=model.content_hash,
        mjcf=model.mjcf,
        longest_delay_s=longest_s,
        standing_hips_m=model.body.parts["Hips"].joint_m[1],
    )
    return Prepared(told, wish.segments_m)


def put_on_record(
    db: Session, context: AppContext, session_id: str, prepared: Prepared, actor: str
) -> None:
    """Record a model, unless it is the one that was recorded last.

    Raises Withdrawn and the like, as for everything that a headset sends.
    """
    session = session_by_id(db, session_id, lock=True)
    require_capture(db, session_id)
    told = prepared.told
    recorded = [content_body(row) for row in contents_of(db, session.id, CONTENT)]
    last = recorded[-1] if recorded else None
    if isinstance(last, dict) and last.get("model_hash") == told.model_hash:
        return
    body = {
        "stature_m": told.stature_m,
        "segments_m": dict(prepared.segments_m),
        "configuration_hash": told.configuration_hash,
        "model_hash": told.model_hash,
        "mjcf": told.mjcf,
    }
    now = context.clock.utc_now()
    content = store_content(db, session_id=session.id, kind=CONTENT, body=body, by=actor, now=now)
    command = RecordAvatar(configuration_hash=told.configuration_hash, content=content)
    apply_command(db, context, session, command, actor=actor)


def _built(
    configuration: Configuration,
    figure: Figure | None,
    stature_m: float,
    segments_m: Mapping[str, float],
    tasks: Tasks,
    longest_delay_s: float,
) -> AvatarModel:
    try:
        return avatar_model(
            configuration,
            stature_m,
            segments_m=segments_m,
            figure=figure,
            scene=scene_of(tuple(tasks.layouts().values())),
            longest_delay_s=longest_delay_s,
        )
    except BodyError as error:
        raise InvalidInput(
            f"there is no such body: {error}",
            value={"stature_m": stature_m, **segments_m},
            remedy="Measure the participant again, or leave the lengths of segments out.",
        ) from None
