"""Models without one of their parameters: what each is worth.

Without a dependency, walks are told apart by the others. Without a steering parameter, it is held
at one value for everybody, as a static model does, and the others remain distributed.
"""

from dataclasses import replace

import numpy as np

from app.science.walking.maps import WalkDatabase
from app.science.walking.records import ParameterGrid, WalkingError


def without_dependency(database: WalkDatabase, name: str) -> WalkDatabase:
    """The database without one of several dependencies; raises WalkingError for another name."""
    if name not in database.names or len(database.names) == 1:
        raise WalkingError(f"{name} cannot be left out of {', '.join(database.names)}.")
    kept = [at for at, own in enumerate(database.names) if own != name]
    names = tuple(database.names[at] for at in kept)
    return replace(database, names=names, vectors=database.vectors[:, kept])


def holding(database: WalkDatabase, parameter: str, value: float) -> WalkDatabase:
    """The database with a steering parameter held at the node nearest to a value.

    Raises:
        WalkingError: there is no such parameter.
    """
    grid = database.grid
    names = [one.name for one in grid.parameters]
    if parameter not in names:
        raise WalkingError(f"There is no parameter {parameter!r}: there are {', '.join(names)}.")
    axis = names.index(parameter)
    at = int(np.argmin(np.abs(np.array(grid.values[axis]) - value)))
    values = list(grid.values)
    values[axis] = (values[axis][at],)
    held = ParameterGrid(grid.parameters, tuple(values))
    count = len(database)
    cut = [
        np.take(table.reshape(count, *grid.shape), [at], axis=axis + 1).reshape(count, held.size)
        for table in (database.deviations, database.arrivals_s)
    ]
    return replace(database, grid=held, deviations=cut[0], arrivals_s=cut[1])
