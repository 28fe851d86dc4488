"""Load the real movements that benchmarks follow, if the shared data are available."""

import sys
from collections.abc import Iterator
from pathlib import Path

from app.science.skeleton import Movement
from tests.science.avatar.captured import LONG, REACH, TURN, WALK, movement_of
from tests.support.shared_data import SHARED_DATA_VARIABLE, shared_data_folder

CLIPS = {"walk": (WALK, False), "reach": (REACH, False), "turn": (TURN, True)}
"""File, and whether it travels: CMU 02_01 in place; a person who inspects objects on tables; CMU
05_06, a dancer who turns round four times over four metres."""
SIX_WALKS = (
    "cmu_bvh/02_01.bvh", "cmu_bvh/05_06.bvh", "cmu_bvh/06_01.bvh", "cmu_bvh/12_02.bvh",
    "bvh_toolbox/walk01.bvh", "c3d/Gait.c3d",
)  # fmt: skip
"""Walks from four sources; only the first was used while gains were chosen."""
LONG_WALK = LONG
"""A walk that is long enough to measure a latency."""


def movement(name: str, *, travels: bool = False) -> Movement | None:
    """Return a capture of the shared data on the product's body at 90 Hz, or None if missing."""
    path = shared_file("motion", name)
    return None if path is None else movement_of(path, travels=travels)


def shared_file(kind: str, name: str) -> Path | None:
    """Return the path of a shared data file; report it and return None if it is missing."""
    path = shared_data_folder() / kind / name
    if path.is_file():
        return path
    print(f"  {kind}/{name} is left out: {SHARED_DATA_VARIABLE} has no such file", file=sys.stderr)
    return None


def movements() -> Iterator[tuple[str, Movement]]:
    """Return the captures of `CLIPS` that are available."""
    for told, (name, travels) in CLIPS.items():
        found = movement(name, travels=travels)
        if found is not None:
            yield told, found
