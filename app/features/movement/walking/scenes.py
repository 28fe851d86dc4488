"""Scenes: those that come with the product, and those that the lab uploads."""

import hashlib
from functools import lru_cache

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.adapters.walks import load_scene, shipped_scenes
from app.errors import Conflict, NotFound
from app.features.movement.walking.schemas import (
    NewScene,
    ObstacleView,
    SceneListed,
    ScenePathView,
    SceneView,
)
from app.features.people.audit import record
from app.models import WalkingScene
from app.platform.access import Caller
from app.platform.config_problems import invalid_config
from app.platform.context import AppContext
from app.protocol import ConfigError
from app.science.walking.scene import Scene


@lru_cache(maxsize=1)
def _shipped() -> dict[str, tuple[str, Scene]]:
    """Return the text and scene of each scene that comes with the product, by key."""
    texts = {key: file.read_text(encoding="utf-8") for key, file in shipped_scenes().items()}
    return {key: (text, load_scene(text)) for key, text in texts.items()}


def scene_list(db: Session) -> list[SceneListed]:
    """Return all scenes: the lab's own by title, then those that come with the product."""
    rows = db.execute(
        select(WalkingScene.key, WalkingScene.title, WalkingScene.by, WalkingScene.at).order_by(
            WalkingScene.title, WalkingScene.key
        )
    )
    own = [
        SceneListed(key=row.key, title=row.title, shipped=False, by=row.by, at=row.at)
        for row in rows
    ]
    return own + [
        SceneListed(key=key, title=scene.title or key, shipped=True, by=None, at=None)
        for key, (_, scene) in _shipped().items()
    ]


def scene_text(db: Session, key: str) -> str:
    """Return the text of a scene's file; raise NotFound if there is no such scene."""
    if key in _shipped():
        return _shipped()[key][0]
    return _row(db, key).text


def scene_view(db: Session, key: str) -> SceneView:
    """Return one scene in full; raise NotFound if there is no such scene."""
    if key in _shipped():
        text, scene = _shipped()[key]
        return _view(scene, text, None)
    row = _row(db, key)
    return _view(load_scene(row.text), row.text, row)


def scene_texts(db: Session) -> tuple[tuple[str, str], ...]:
    """Return key and text of every scene: those of the product, and the lab's own."""
    own = db.execute(select(WalkingScene.key, WalkingScene.text).order_by(WalkingScene.key))
    shipped = ((key, text) for key, (text, _) in _shipped().items())
    return (*shipped, *((row.key, row.text) for row in own))


def add_scene(db: Session, context: AppContext, caller: Caller, request: NewScene) -> SceneView:
    """Store a scene file; raise InvalidConfig with every problem, Conflict if the key is in use."""
    try:
        scene = load_scene(request.text)
    except ConfigError as error:
        raise invalid_config("scene", error) from error
    if scene.name in _shipped() or db.get(WalkingScene, scene.name) is not None:
        raise Conflict(
            f"the scene {scene.name!r} already exists",
            value=scene.name,
            remedy="Give the file another key, or delete the other scene.",
        )
    row = WalkingScene(
        key=scene.name,
        title=scene.title or scene.name,
        text=request.text,
        content_hash=_hash(request.text),
        by=caller.actor,
        at=context.clock.utc_now(),
    )
    db.add(row)
    db.flush()
    _record(db, context, caller, row, "walking.scene_added")
    return _view(scene, request.text, row)


def remove_scene(db: Session, context: AppContext, caller: Caller, key: str) -> None:
    """Delete a scene of the lab; raise NotFound, or Conflict for one of the product.

    Models that were fitted in the scene do not need it any more. Sets of walks that name it keep
    the name: to fit a model to them, a scene of this key has to be added again.
    """
    if key in _shipped():
        raise Conflict(
            "this scene comes with the product and cannot be deleted",
            value=key,
            remedy="You can delete the lab's own scenes.",
        )
    row = _row(db, key)
    db.delete(row)
    db.flush()
    _record(db, context, caller, row, "walking.scene_removed")


def _row(db: Session, key: str) -> WalkingScene:
    row = db.get(WalkingScene, key)
    if row is None:
        raise NotFound("there is no such scene", value=key, remedy="Choose one from the list.")
    return row


def _view(scene: Scene, text: str, row: WalkingScene | None) -> SceneView:
    return SceneView(
        key=scene.name,
        title=scene.title or scene.name,
        shipped=row is None,
        by=None if row is None else row.by,
        at=None if row is None else row.at,
        about=scene.about,
        content_hash=_hash(text),
        bounds_m=scene.bounds_m,
        clearance_m=scene.clearance_m,
        obstacles=[
            ObstacleView(name=one.name, corners_m=[(float(x), float(y)) for x, y in one.corners_m])
            for one in scene.obstacles
        ],
        places=dict(scene.places),
        paths=[ScenePathView(name=p.name, start=p.start, goal=p.goal) for p in scene.paths],
    )


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _record(
    db: Session, context: AppContext, caller: Caller, row: WalkingScene, action: str
) -> None:
    record(
        db,
        actor=caller.actor,
        action=action,
        subject=f"walking_scene:{row.key}",
        details={"content": row.content_hash[:12]},
        now=context.clock.utc_now(),
    )
