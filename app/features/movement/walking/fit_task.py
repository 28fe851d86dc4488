"""Fit a model map by map in a worker process, so that it can be stopped and resumed.

A fit order and the walks that it refers to never change, so maps finished earlier stay valid.
"""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from app.adapters.walks.model_file import write_model
from app.features.movement.walking.progress import RECORD_BYTES, FitFolder
from app.features.movement.walking.reading import planned_walks, walk_name
from app.features.movement.walking.sources import Cannot, FitOrder, Store
from app.features.movement.walking.summaries import model_summary, scene_counts
from app.science.walking.following import SteeringFollower
from app.science.walking.maps import (
    PAPER,
    PERSONS,
    TIME_AWARE,
    DeviationMap,
    MapMaker,
    WalkDatabase,
    database_of,
    maps_of,
)
from app.science.walking.models import FitOptions, fitted
from app.science.walking.records import (
    LENGTH,
    PAPER_PARAMETERS,
    STATURE,
    TURNING,
    ParameterGrid,
    PlannedWalk,
    WalkingError,
    check_varies,
    known_for,
    regular_grid,
)

READINGS = {"chosen": None, "paper": PAPER, "time-aware": TIME_AWARE}
Json = dict[str, Any]


def fit(store: Store, order: FitOrder, folder: Path) -> Json:
    """Fit a model, with its files in `folder`, and return a `ModelSummary`; raise Cannot."""
    files = FitFolder(folder)
    files.write_stage("walks", 0, 0)
    read = planned_walks(store, order.source, order.scene)
    entries, left_out = _with_numbers(read, order.depends_on)
    _check_people(entries)
    follower = SteeringFollower()
    maker = MapMaker(regular_grid(PAPER_PARAMETERS, order.steps), follower)
    try:
        database = _database(files, entries, maker, order.depends_on)
        files.write_stage("blending", len(entries), maker.grid.size)
        options = FitOptions(order.seed, order.k, order.entries, READINGS[order.reading])
        found = fitted(database, options)
        digest = write_model(files.model, found, follower.rules)
        walked = {"left_out_walks": left_out, "scenes": scene_counts(entries)}
        return model_summary(found, digest) | walked
    except WalkingError as error:
        raise Cannot(str(error)) from None


def _with_numbers(
    read: list[PlannedWalk], names: tuple[str, ...]
) -> tuple[list[PlannedWalk], list[Json]]:
    """Return the walks that have all further numbers, and the others with their reasons."""
    try:
        without = known_for(read, names)
        entries = [one for at, one in enumerate(read) if at not in without]
        check_varies(entries, names)
    except WalkingError as error:
        raise Cannot(str(error)) from None
    return entries, [
        {"walk": walk_name(at + 1, read[at].walk), "reason": reason}
        for at, reason in without.items()
    ]


def _check_people(entries: list[PlannedWalk]) -> None:
    people = sorted({entry.walk.subject for entry in entries})
    if len(people) < PERSONS:
        raise Cannot(
            f"all {len(entries)} walks are of one person, {people[0]!r}",
            f"The model learns from at least {PERSONS} people how they differ: add walks of "
            "others, and name who walks in each.",
        )


def _database(
    files: FitFolder, entries: list[PlannedWalk], maker: MapMaker, further: tuple[str, ...]
) -> WalkDatabase:
    grid = maker.grid
    files.write_stage("maps", len(entries), grid.size)
    made = _kept_maps(files, entries, maker)
    with files.maps.open("ab") as file:
        threads = max(1, (os.cpu_count() or 2) - 1)
        for _, one in maps_of(entries, maker, done=range(len(made)), threads=threads):
            record = np.stack([one.deviations.ravel(), one.arrival_s.ravel()])
            file.write(record.astype("<f4").tobytes())
            file.flush()
            made.append(one)
    usual = (LENGTH, TURNING, STATURE)
    names = [name for name in usual if all(name in one.dependencies for one in entries)]
    return database_of(entries, made, (*names, *further))


def _kept_maps(files: FitFolder, entries: list[PlannedWalk], maker: MapMaker) -> list[DeviationMap]:
    """Return the maps that an earlier run finished, and truncate an incomplete last record."""
    if not files.maps.exists():
        return []
    nodes = maker.grid.size
    whole = min(files.maps.stat().st_size // (RECORD_BYTES * nodes), len(entries))
    os.truncate(files.maps, whole * RECORD_BYTES * nodes)
    records = np.fromfile(files.maps, dtype="<f4").reshape(whole, 2, nodes)
    return list(_as_maps(records.astype(np.float64), entries, maker.grid, maker.metric.name))


def _as_maps(
    records: np.ndarray[Any, np.dtype[np.float64]],
    entries: list[PlannedWalk],
    grid: ParameterGrid,
    metric: str,
) -> Iterator[DeviationMap]:
    for record, entry in zip(records, entries, strict=False):
        shape = grid.shape
        duration_s = entry.walk.duration_s
        yield DeviationMap(
            grid, metric, record[0].reshape(shape), record[1].reshape(shape), duration_s
        )
