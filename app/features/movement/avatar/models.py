"""The model of an avatar for a person's stature, as a browser simulates it."""

from functools import lru_cache

from sqlalchemy.orm import Session

from app.errors import Conflict
from app.features.movement.avatar.service import typed, version_of
from app.features.movement.humanoids.service import humanoid_by_hash, parsed_figure
from app.protocol.avatar import parse_avatar_json
from app.science.avatar.body import BodyError
from app.science.avatar.mjcf import AvatarModel, avatar_model

MEDIA_TYPE = "application/xml"


def model_of(db: Session, key: str, number: int | None, stature_m: float) -> AvatarModel:
    """The model of a version, the newest for None, without a scene but the floor.

    The stature counts to the millimetre. Raises NotFound, and Conflict where the configuration
    lacks a part without which there is no body.
    """
    version = version_of(db, key, number)
    humanoid = typed(version).humanoid
    figure = None if humanoid is None else humanoid_by_hash(db, humanoid).figure
    try:
        return _built(version.content_hash, version.canonical_json, figure, round(stature_m, 3))
    except BodyError as error:
        raise Conflict(
            f"this avatar cannot be built: {error}",
            value=key,
            remedy="Save a version of the configuration in which this is mended.",
        ) from None


@lru_cache(maxsize=16)
def _built(
    _content_hash: str, canonical_json: str, figure: str | None, stature_m: float
) -> AvatarModel:
    return avatar_model(
        parse_avatar_json(canonical_json),
        stature_m,
        figure=None if figure is None else parsed_figure(figure),
    )
