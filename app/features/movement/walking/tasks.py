"""What is done in processes of their own; the server only names it.

Each loads what it needs when it is done there: the server itself never computes walks.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.features.movement.walking.sources import (
    CapturedWalk,
    FitOrder,
    PopulationSource,
    Question,
    SliceQuestion,
    Store,
    TrackSource,
)


@dataclass(frozen=True)
class CapturedTable:
    """Ways of captured people as one table of tracks, and what is in it."""

    table: bytes
    summary: dict[str, Any]


def inspected_tracks(source: TrackSource, path: Path) -> dict[str, Any]:
    """A `WalksSummary` of a table on disk; raises Cannot."""
    return _tracks_told(path.read_bytes(), source)


def inspected_population(source: PopulationSource) -> dict[str, Any]:
    """A `WalksSummary` of made-up walkers; raises Cannot."""
    from app.features.movement.walking.figures import walks_told
    from app.features.movement.walking.reading import planned_walks

    return walks_told(planned_walks(Store(""), source, None))


def captured_table(
    store: Store, captures: tuple[tuple[str, CapturedWalk], ...], source: TrackSource
) -> CapturedTable:
    """The ways of captured people, cut and counted; raises Cannot."""
    from app.features.movement.walking.reading import table_of_captures

    table = table_of_captures(store, captures)
    return CapturedTable(table, _tracks_told(table, source))


def fit_model(store: Store, order: FitOrder, folder: Path) -> dict[str, Any]:
    """Fit a model into a folder; a `ModelSummary`. Raises Cannot."""
    from app.features.movement.walking.fit_task import fit

    return fit(store, order, folder)


def plan_way(question: Question) -> list[tuple[float, float]]:
    """The points of a path; raises Cannot."""
    from app.features.movement.walking.predicting import way_asked

    return [(float(x), float(y)) for x, y in way_asked(question).points_m]


def predict_walk(store: Store, content_hash: str, question: Question) -> dict[str, Any]:
    """How long people take on a path, a `PredictionView`; raises Cannot."""
    from app.features.movement.walking.predicting import predicted

    return predicted(store, content_hash, question)


def slice_of(store: Store, content_hash: str, question: SliceQuestion) -> dict[str, Any]:
    """One slice of the map that answers, a `SliceView`; raises Cannot."""
    from app.features.movement.walking.slicing import sliced

    return sliced(store, content_hash, question)


def _tracks_told(data: bytes, source: TrackSource) -> dict[str, Any]:
    from app.features.movement.walking.figures import walks_told
    from app.features.movement.walking.reading import planned, tracks_of, walks_in

    return walks_told(planned(walks_in(tracks_of(data, source)), None))
