"""Convert sets of walks to the sources that worker processes read."""

from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput, NotFound
from app.features.movement.captures import source_of_capture
from app.features.movement.walking.scenes import scene_text, scene_texts
from app.features.movement.walking.schemas import (
    CapturesOrigin,
    Kind,
    PopulationOrigin,
    TracksOrigin,
    WalkSetView,
)
from app.features.movement.walking.sources import (
    LABORATORY,
    CapturedWalk,
    PopulationSource,
    TrackSource,
    WalkSource,
)
from app.platform.context import AppContext
from app.science.walking.records import OPEN_FLOOR

Scenes = tuple[tuple[str, str], ...]
"""Pairs of key and text of scenes."""


def source_of_set(db: Session, view: WalkSetView) -> WalkSource:
    """Return the source of a stored set, for a fit; raise Conflict if a scene of it is gone."""
    if isinstance(view.origin, PopulationOrigin):
        return _population(db, view.origin)
    content_hash = view.content_hash or ""
    scenes = tuple((key, walked_scene_text(db, key)) for key in scene_keys(view))
    if isinstance(view.origin, TracksOrigin):
        return tracks_source(view.origin, view.kind, content_hash, scenes)
    return captures_source(view.origin, content_hash, scenes)


def scene_keys(view: WalkSetView) -> list[str]:
    """Return the keys of the scenes that the walks of a set name, sorted."""
    named = {one.key for one in view.summary.scenes if one.key is not None}
    return sorted(named - {OPEN_FLOOR})


def walked_scene_text(db: Session, key: str) -> str:
    """Return the text of a scene that walks name; raise Conflict if it was deleted."""
    try:
        return scene_text(db, key)
    except NotFound as error:
        raise Conflict(
            f"walks of this set took place in the scene {key!r}, which was deleted",
            value=key,
            remedy="Add a scene with this key again, or add the walks again with another scene.",
        ) from error


def all_scenes(context: AppContext) -> Scenes:
    """Return key and text of every scene that a table may name."""
    with context.database.reading() as db:
        return scene_texts(db)


def tracks_source(
    origin: TracksOrigin, kind: Kind, content_hash: str, scenes: Scenes
) -> TrackSource:
    """Return the source of a table of tracks, which may name these scenes."""
    return TrackSource(
        name=origin.file_name,
        content_hash=content_hash,
        rate_hz=origin.rate_hz,
        metres_per_unit=origin.metres_per_unit,
        kind=kind,
        statures_m=tuple(sorted(origin.statures_m.items())),
        scenes=scenes,
        reads_columns=origin.reads_columns,
    )


def captures_source(origin: CapturesOrigin, content_hash: str, scenes: Scenes) -> TrackSource:
    """Return the source of tracks from captures, in these scenes.

    Raises InvalidInput for conflicting statures and for a scene that there is not.
    """
    names = [f"c{at}" for at in range(len(origin.captures))]
    statures: dict[str, float] = {}
    for one in origin.captures:
        tall = one.stature_m
        if tall is not None and statures.setdefault(one.subject, tall) != tall:
            raise InvalidInput(
                f"{one.subject} has two statures",
                value=tall,
                valid=statures[one.subject],
                remedy="Give each person one.",
            )
    _check_scenes(origin, [key for key, _ in scenes])
    return TrackSource(
        name="captures",
        content_hash=content_hash,
        statures_m=tuple(sorted(statures.items())),
        subjects=tuple(zip(names, (one.subject for one in origin.captures), strict=True)),
        titles=tuple(
            zip(names, (f"capture {one.capture_id[:8]}" for one in origin.captures), strict=True)
        ),
        scenes=scenes,
        walked_in=tuple(
            (name, one.scene)
            for name, one in zip(names, origin.captures, strict=True)
            if one.scene is not None
        ),
        numbers=tuple(
            (name, tuple(one.numbers.items()))
            for name, one in zip(names, origin.captures, strict=True)
        ),
    )


def _check_scenes(origin: CapturesOrigin, known: list[str]) -> None:
    for at, one in enumerate(origin.captures, start=1):
        if one.scene is not None and one.scene not in (*known, OPEN_FLOOR):
            raise InvalidInput(
                f"capture {at} of the set, of {one.subject}, names a scene that there is not",
                value=one.scene,
                valid=[*known, OPEN_FLOOR],
                remedy="Choose one of these, or add the scene's file first.",
            )


def population_source(context: AppContext, origin: PopulationOrigin) -> PopulationSource:
    """Return the source of synthetic walkers; raise NotFound for an unknown scene."""
    with context.database.reading() as db:
        return _population(db, origin)


def _population(db: Session, origin: PopulationOrigin) -> PopulationSource:
    scene = LABORATORY if origin.scene is None else scene_text(db, origin.scene)
    return PopulationSource(
        origin.population, origin.people, origin.repetitions, origin.seed, scene
    )


def captured_walks(
    context: AppContext, origin: CapturesOrigin
) -> tuple[tuple[str, CapturedWalk], ...]:
    """Return the captures of a set with their names in its table; raise NotFound."""
    found = []
    for at, one in enumerate(origin.captures):
        source = source_of_capture(context, one.capture_id)
        walk = CapturedWalk(
            name=source.name,
            content_hash=source.hash,
            companion_name=source.companion_name,
            companion_hash=source.companion_hash,
            metres_per_unit=source.metres_per_unit,
            up=source.up,
            body=one.body,
            max_bytes=context.settings.max_capture_bytes,
        )
        found.append((f"c{at}", walk))
    return tuple(found)
