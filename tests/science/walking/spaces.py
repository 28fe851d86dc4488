"""Small made-up walk databases and blending spaces for tests."""

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.maps.blending import BlendingSpace, blending_space
from app.science.walking.maps.database import WalkDatabase
from app.science.walking.maps.densifying import MAP_FLOATS
from app.science.walking.records.dependencies import scaling_of
from app.science.walking.records.model import LENGTH, STATURE
from app.science.walking.records.parameters import PAPER_PARAMETERS, ParameterGrid, regular_grid

NAMES = (LENGTH, STATURE)
GRID = regular_grid(PAPER_PARAMETERS, 5)
WALKS, PEOPLE = 120, 6


def dependency_rows(rng: np.random.Generator, walks: int = WALKS) -> FloatArray:
    """Return (walks, 2) lengths and statures; each person has one stature."""
    statures = 1.6 + 0.06 * np.arange(PEOPLE)
    lengths = rng.uniform(0.5, 4.0, walks)
    return np.stack([lengths, statures[np.arange(walks) % PEOPLE]], axis=-1)


def made_up_database(grid: ParameterGrid = GRID, walks: int = WALKS, seed: int = 1) -> WalkDatabase:
    """Return walks that take L / v + v / a; a person's v grows with their stature."""
    rng = np.random.default_rng(seed)
    rows = dependency_rows(rng, walks)
    preferred = np.clip(rows[:, 1] - 0.6 + 0.05 * rng.standard_normal(walks), 0.3, 1.9)
    speeds, changes = grid.nodes[:, 0], grid.nodes[:, 1]
    arrivals = rows[:, :1] / speeds + speeds / changes
    durations = rows[:, 0] / preferred + preferred / 1.5
    deviations = np.abs(arrivals - durations[:, None]) + 0.1 * np.abs(changes - 1.5)
    return WalkDatabase(
        grid,
        "euclidean",
        NAMES,
        rows,
        deviations.astype(MAP_FLOATS),
        arrivals.astype(MAP_FLOATS),
        durations,
        rows[:, 0],
        tuple(f"person {at % PEOPLE}" for at in range(walks)),
        tuple(f"walk {at}" for at in range(walks)),
        ("synthetic",) * walks,
    )


def made_up_space(grid: ParameterGrid = GRID, k: int = 20, entries: int = 400) -> BlendingSpace:
    """Return a densified blending space of maps with one peak each."""
    rng = np.random.default_rng(2)
    rows = dependency_rows(rng)
    peaks = np.stack([0.4 + 0.3 * rows[:, 0], rows[:, 1] - 0.6, 1.5 - 0.2 * rows[:, 0]], axis=-1)
    away = (grid.nodes[None] - peaks[:, None]) / np.array([0.4, 0.5, 0.8])
    values = np.exp(-(away**2).sum(axis=-1)).astype(MAP_FLOATS)
    scaling = scaling_of(NAMES, rows)
    return blending_space(grid, scaling, rows, values, rng=rng, entries=entries, k=k)
