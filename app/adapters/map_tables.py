"""Convert the database of a model's maps to what an archive stores, and back.

Its arrays become tables; its grid, its names and the people become part of the header.
"""

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any, Final

import numpy as np

from app.science.walking.maps import WalkDatabase
from app.science.walking.records import ParameterGrid, SteeringParameter

TABLES: Final = ("vectors", "deviations", "arrivals_s", "durations_s", "lengths_m")
"""The tables of a database, in the order of a content hash."""


def tables_of(base: WalkDatabase) -> dict[str, Any]:
    """Return the tables of a database, by their names."""
    return {name: getattr(base, name) for name in TABLES}


def header_of(base: WalkDatabase) -> dict[str, Any]:
    """Return what a header says of a database."""
    return {
        "parameters": [asdict(one) for one in base.grid.parameters],
        "values": [list(values) for values in base.grid.values],
        "metric": base.metric,
        "names": list(base.names),
        "subjects": list(base.subjects),
        "sources": list(base.sources),
        "kinds": list(base.kinds),
    }


def database_from(header: Mapping[str, Any], tables: Mapping[str, Any]) -> WalkDatabase:
    """Return the database of a header and its tables.

    Raises:
        KeyError, TypeError: the header is incomplete.
        WalkingError: tables and header do not fit each other.
    """
    grid = ParameterGrid(
        tuple(SteeringParameter(**one) for one in header["parameters"]),
        tuple(tuple(values) for values in header["values"]),
    )
    return WalkDatabase(
        grid=grid,
        metric=header["metric"],
        names=tuple(header["names"]),
        subjects=tuple(header["subjects"]),
        sources=tuple(header["sources"]),
        kinds=tuple(header["kinds"]),
        resting=np.array(header["resting"]) if "resting" in header else None,
        **{name: tables[name] for name in TABLES},
    )
