"""Convert stored avatar configurations to views: lists, checks and models."""

from collections.abc import Sequence
from functools import lru_cache
from itertools import groupby

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.errors import Conflict, NotDurable
from app.features.movement.avatar.schemas import (
    AvatarCheck,
    AvatarSummary,
    AvatarVersionDetail,
    AvatarVersionView,
    AvatarView,
    ModelToTry,
)
from app.features.movement.avatar.service import (
    avatar_by_key,
    checked,
    newest_version,
    typed,
    unknown_humanoid,
    version_of,
)
from app.features.movement.avatar.use import used_by
from app.features.movement.humanoids import humanoid_by_hash, parsed_figure
from app.models import Avatar, AvatarVersion, Study, StudySession
from app.platform.access import Caller, visible_to
from app.platform.config_problems import problem_views
from app.protocol import ConfigError, ConfigProblem
from app.protocol.avatar import file_of, load_avatar, parse_avatar_json
from app.protocol.avatar_joints import joint_views
from app.science.avatar.body import BodyError
from app.science.avatar.configuration import Configuration, missing_part_problems
from app.science.avatar.mjcf import FLOOR_ONLY, AvatarModel, LooseBox, Scene, avatar_model

MEDIA_TYPE = "application/xml"
_BOX_PLACE_M = (0.0, 4.0, 0.0)
"""Where a box hovers that has not been dropped: above every body."""


def avatar_list(db: Session, caller: Caller) -> list[AvatarSummary]:
    """Return every avatar of the lab, by key; damaged ones are named as such."""
    rows = db.scalars(select(AvatarVersion).order_by(AvatarVersion.key, AvatarVersion.number))
    titles = {avatar.key: avatar.title for avatar in db.scalars(select(Avatar))}
    used = _sessions_by_hash(db, caller)
    return [
        _summary(key, titles[key], list(versions), used)
        for key, versions in groupby(rows, key=lambda row: row.key)
    ]


def avatar_view(db: Session, caller: Caller, key: str) -> AvatarView:
    """Return one avatar with its versions; raise NotFound if there is none with this key."""
    avatar = avatar_by_key(db, key)
    rows = db.scalars(
        select(AvatarVersion).where(AvatarVersion.key == key).order_by(AvatarVersion.number.desc())
    )
    return AvatarView(
        key=key,
        title=avatar.title,
        by=avatar.by,
        at=avatar.at,
        newest=_detail(db, caller, avatar, newest_version(db, avatar)),
        versions=[version_view(row) for row in rows],
    )


def version_detail(
    db: Session, caller: Caller, key: str, number: int | None
) -> AvatarVersionDetail:
    """Return one version of an avatar in full, or the newest for None; raise NotFound."""
    return _detail(db, caller, avatar_by_key(db, key), version_of(db, key, number))


def version_view(row: AvatarVersion) -> AvatarVersionView:
    """Return one version of an avatar as an entry of a list."""
    return AvatarVersionView.model_validate(row, from_attributes=True)


def check_text(db: Session, text: str) -> AvatarCheck:
    """Return the configuration in a file, or every problem of the file with its place."""
    try:
        content = load_avatar(text)
        _check_body(db, content.configuration)
    except ConfigError as error:
        return AvatarCheck(ok=False, problems=problem_views(error))
    same = db.execute(
        select(AvatarVersion.key, AvatarVersion.number)
        .where(AvatarVersion.content_hash == content.content_hash)
        .order_by(AvatarVersion.key, AvatarVersion.number)
    )
    return AvatarCheck(
        ok=True,
        content_hash=content.content_hash,
        configuration=file_of(content.configuration),
        known=[(key, number) for key, number in same],
    )


def _check_body(db: Session, configuration: Configuration) -> None:
    for one in (*missing_part_problems(configuration), *unknown_humanoid(db, configuration)):
        problem = ConfigProblem(one.path, 0, 0, one.message, one.value, one.valid, one.remedy)
        raise ConfigError([problem])


def _summary(
    key: str, title: str, versions: Sequence[AvatarVersion], used: dict[str, int]
) -> AvatarSummary:
    newest = versions[-1]
    try:
        configuration = typed(newest)
    except NotDurable:
        configuration = None
    return AvatarSummary(
        key=key,
        title=title,
        newest=version_view(newest),
        versions=len(versions),
        content_hashes=[row.content_hash for row in versions],
        axes=None if configuration is None else len(configuration.axes),
        locked_axes=None if configuration is None else len(configuration.locked_axes),
        sessions=sum(used.get(one, 0) for one in {row.content_hash for row in versions}),
    )


def _detail(db: Session, caller: Caller, avatar: Avatar, row: AvatarVersion) -> AvatarVersionDetail:
    configuration = typed(row)
    return AvatarVersionDetail(
        **version_view(row).model_dump(),
        key=avatar.key,
        title=avatar.title,
        configuration=file_of(configuration),
        joints=joint_views(configuration),
        report=row.report,
        sessions=_sessions_by_hash(db, caller, row.content_hash).get(row.content_hash, 0),
        used_by=used_by(db, caller, row),
    )


def _sessions_by_hash(
    db: Session, caller: Caller, content_hash: str | None = None
) -> dict[str, int]:
    """Return the number of sessions in the caller's studies by configuration hash."""
    column = StudySession.avatar_configuration_hash
    condition = column.is_not(None) if content_hash is None else column == content_hash
    rows = db.execute(
        select(column, func.count())
        .join(Study, Study.id == StudySession.study_id)
        .where(condition, visible_to(caller))
        .group_by(column)
    )
    return {str(found): count for found, count in rows}


def model_of(db: Session, key: str, number: int | None, stature_m: float) -> AvatarModel:
    """Return the MuJoCo model of a version, or of the newest for None, on a floor.

    The stature is rounded to the millimetre. Raises NotFound, and Conflict if the configuration
    lacks a part that the body needs; NotDurable if the stored version was damaged.
    """
    version = version_of(db, key, number)
    typed(version)
    try:
        return _model(db, version.content_hash, version.canonical_json, stature_m, FLOOR_ONLY)
    except BodyError as error:
        raise Conflict(
            f"this avatar cannot be built: {error}",
            value=key,
            remedy="Save a version of the configuration in which this is corrected.",
        ) from None


def model_to_try(db: Session, request: ModelToTry) -> AvatarModel:
    """Return the MuJoCo model of a configuration that need not be stored; nothing is stored.

    Raises InvalidConfig with every problem of the configuration, and Conflict if it lacks a part
    that the body needs.
    """
    content = checked(db, request.configuration)
    box = request.box
    scene = FLOOR_ONLY if box is None else Scene(loose=(_hovering(box.edge_m, box.mass_kg),))
    try:
        return _model(db, content.content_hash, content.canonical_json, request.stature_m, scene)
    except BodyError as error:
        raise Conflict(
            f"this avatar cannot be built: {error}",
            value=content.content_hash,
            remedy="Correct the configuration and try again.",
        ) from None


def _hovering(edge_m: float, mass_kg: float) -> LooseBox:
    half = edge_m / 2.0
    return LooseBox("box", _BOX_PLACE_M, (half, half, half), mass_kg)


def _model(
    db: Session, content_hash: str, canonical_json: str, stature_m: float, scene: Scene
) -> AvatarModel:
    humanoid = parse_avatar_json(canonical_json).humanoid
    figure = None if humanoid is None else humanoid_by_hash(db, humanoid).figure
    return _built(content_hash, canonical_json, figure, round(stature_m, 3), scene)


@lru_cache(maxsize=16)
def _built(
    _content_hash: str, canonical_json: str, figure: str | None, stature_m: float, scene: Scene
) -> AvatarModel:
    return avatar_model(
        parse_avatar_json(canonical_json),
        stature_m,
        figure=None if figure is None else parsed_figure(figure),
        scene=scene,
    )
