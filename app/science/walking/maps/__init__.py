"""Maps of suitability over the steering parameters, and the interpolation between them.

`maps_of` makes the maps of all walks of a database, with progress, stop and resume;
`blending_space` and `multilinear` interpolate between dependencies and between nodes.
"""

from app.science.walking.maps.blending import ENTRIES, NEIGHBOURS, BlendingSpace, blending_space
from app.science.walking.maps.database import PERSONS, WalkDatabase, check_persons, database_of
from app.science.walking.maps.densifying import MAP_FLOATS, IntArray, MapArray
from app.science.walking.maps.interpolation import (
    MOST_NODES,
    Axes,
    axes_of,
    multilinear,
    radial_basis,
)
from app.science.walking.maps.maps import MapMaker, maps_of
from app.science.walking.maps.neighbours import neighbours
from app.science.walking.maps.suitability import PAPER, TIME_AWARE, DeviationMap, SuitabilityOptions

__all__ = [
    "ENTRIES",
    "MAP_FLOATS",
    "MOST_NODES",
    "NEIGHBOURS",
    "PAPER",
    "PERSONS",
    "TIME_AWARE",
    "Axes",
    "BlendingSpace",
    "DeviationMap",
    "IntArray",
    "MapArray",
    "MapMaker",
    "SuitabilityOptions",
    "WalkDatabase",
    "axes_of",
    "blending_space",
    "check_persons",
    "database_of",
    "maps_of",
    "multilinear",
    "neighbours",
    "radial_basis",
]
