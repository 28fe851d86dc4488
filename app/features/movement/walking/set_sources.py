"""Convert sets of walks to the sources that worker processes read."""

from sqlalchemy.orm import Session

from app.errors import InvalidInput
from app.features.movement.captures import source_of_capture
from app.features.movement.walking.scenes import scene_text
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


def source_of_set(db: Session, view: WalkSetView) -> WalkSource:
    """Return the source of a stored set, for a fit."""
    if isinstance(view.origin, PopulationOrigin):
        return _population(db, view.origin)
    content_hash = view.content_hash or ""
    if isinstance(view.origin, TracksOrigin):
        return tracks_source(view.origin, view.kind, content_hash)
    return captures_source(view.origin, content_hash)


def tracks_source(origin: TracksOrigin, kind: Kind, content_hash: str) -> TrackSource:
    """Return the source of a table of tracks."""
    return TrackSource(
        name=origin.file_name,
        content_hash=content_hash,
        rate_hz=origin.rate_hz,
        metres_per_unit=origin.metres_per_unit,
        kind=kind,
        statures_m=tuple(sorted(origin.statures_m.items())),
    )


def captures_source(origin: CapturesOrigin, content_hash: str) -> TrackSource:
    """Return the source of tracks from captures; raise InvalidInput for conflicting statures."""
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
    return TrackSource(
        name="captures",
        content_hash=content_hash,
        statures_m=tuple(sorted(statures.items())),
        subjects=tuple(zip(names, (one.subject for one in origin.captures), strict=True)),
        titles=tuple(
            zip(names, (f"capture {one.capture_id[:8]}" for one in origin.captures), strict=True)
        ),
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
