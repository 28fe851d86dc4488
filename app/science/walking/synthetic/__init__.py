"""Synthetic people who walk: populations with known parameters, for tests and demonstrations."""

from app.science.walking.synthetic.populations import POPULATIONS, Population, person_of, walk_along
from app.science.walking.synthetic.synthetic_walks import (
    Sample,
    laboratory_scenes,
    straight_path,
    synthetic_walks,
)

__all__ = [
    "POPULATIONS",
    "Population",
    "Sample",
    "laboratory_scenes",
    "person_of",
    "straight_path",
    "synthetic_walks",
    "walk_along",
]
