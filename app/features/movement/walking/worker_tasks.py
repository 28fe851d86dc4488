"""The tasks of the worker processes for walking; the server only passes their names.

Each task imports what it needs when it runs: the server's own process never computes walks.
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
    """Tracks of captured people as one table, with its summary."""

    table: bytes
    summary: dict[str, Any]


def inspected_tracks(source: TrackSource, path: Path) -> dict[str, Any]:
    """Return a `WalksSummary` of a table on disk; raise Cannot."""
    return _tracks_summary(path.read_bytes(), source)


def inspected_population(source: PopulationSource) -> dict[str, Any]:
    """Return a `WalksSummary` of synthetic walkers; raise Cannot."""
    from app.features.movement.walking.reading import planned_walks
    from app.features.movement.walking.summaries import walks_summary

    return walks_summary(planned_walks(Store(""), source, None))


def captured_table(
    store: Store, captures: tuple[tuple[str, CapturedWalk], ...], source: TrackSource
) -> CapturedTable:
    """Return the tracks of captured people with their summary; raise Cannot."""
    from app.features.movement.walking.reading import table_of_captures

    table = table_of_captures(store, captures)
    return CapturedTable(table, _tracks_summary(table, source))


def fit_model(store: Store, order: FitOrder, folder: Path) -> dict[str, Any]:
    """Fit a model, with its files in `folder`, and return a `ModelSummary`; raise Cannot."""
    from app.features.movement.walking.fit_task import fit

    return fit(store, order, folder)


def plan_path(question: Question) -> list[tuple[float, float]]:
    """Return the points of a path; raise Cannot."""
    from app.features.movement.walking.predicting import path_of

    return [(float(x), float(y)) for x, y in path_of(question).points_m]


def predict_walk(store: Store, content_hash: str, question: Question) -> dict[str, Any]:
    """Predict how long people take on a path, as a `PredictionView`; raise Cannot."""
    from app.features.movement.walking.predicting import predict

    return predict(store, content_hash, question)


def slice_of(store: Store, content_hash: str, question: SliceQuestion) -> dict[str, Any]:
    """Return one slice of the map as a `SliceView`; raise Cannot."""
    from app.features.movement.walking.slicing import compute_slice

    return compute_slice(store, content_hash, question)


def _tracks_summary(data: bytes, source: TrackSource) -> dict[str, Any]:
    from app.features.movement.walking.reading import planned, scenes_of, table_of, walks_in
    from app.features.movement.walking.summaries import walks_summary
    from app.science.walking.recording import doubts_about

    table = table_of(data, source)
    walks = walks_in(table.tracks)
    notices = {
        "assumed": list(table.assumed),
        "doubts": doubts_about(walks),
        "spoilt_numbers": list(table.spoilt),
    }
    return walks_summary(planned(walks, scenes_of(source, None))) | notices
