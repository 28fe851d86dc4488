"""Sets of walks as the processes that read them are told them."""

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
    """What a fit needs to know of a stored set."""
    if isinstance(view.origin, PopulationOrigin):
        return _population(db, view.origin)
    content_hash = view.content_hash or ""
    if isinstance(view.origin, TracksOrigin):
        return tracks_source(view.origin, view.kind, content_hash)
    return captures_source(view.origin, content_hash)


def tracks_source(origin: TracksOrigin, kind: Kind, content_hash: str) -> TrackSource:
    """A table as the process is told it."""
    return TrackSource(
        name=origin.file_name,
        content_hash=content_hash,
        rate_hz=origin.rate_hz,
        metres_per_unit=origin.metres_per_unit,
        kind=kind,
        statures_m=tuple(sorted(origin.statures_m.items())),
    )


def captures_source(origin: CapturesOrigin, content_hash: str) -> TrackSource:
    """Ways cut from captures as the process is told them; raises InvalidInput."""
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
    """Made-up walkers as the process is told them; raises NotFound."""
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
    """Captures as the process is told them, by their names in the table; raises NotFound."""
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
