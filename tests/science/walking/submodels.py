"""Walk databases without one parameter, which show what each parameter contributes.

Without one dependency, walks are distinguished by the others only. A steering parameter is removed
by fixing it to one value for everybody, as in a static model; the others remain distributed.
"""

from dataclasses import replace

import numpy as np

from app.science.walking.maps import WalkDatabase
from app.science.walking.records import ParameterGrid, WalkingError


def without_dependency(database: WalkDatabase, name: str) -> WalkDatabase:
    """Return the database without one dependency.

    Raises:
        WalkingError: the dependency is unknown or the only one.
    """
    if name not in database.names or len(database.names) == 1:
        raise WalkingError(f"{name} cannot be left out of {', '.join(database.names)}.")
    remaining = [at for at, own in enumerate(database.names) if own != name]
    names = tuple(database.names[at] for at in remaining)
    return replace(database, names=names, vectors=database.vectors[:, remaining])


def with_fixed_parameter(database: WalkDatabase, parameter: str, value: float) -> WalkDatabase:
    """Return the database with a steering parameter fixed to the node nearest to a value.

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
    fixed_grid = ParameterGrid(grid.parameters, tuple(values))
    count = len(database)
    cut = [
        np.take(table.reshape(count, *grid.shape), [at], axis=axis + 1).reshape(
            count, fixed_grid.size
        )
        for table in (database.deviations, database.arrivals_s)
    ]
    return replace(database, grid=fixed_grid, deviations=cut[0], arrivals_s=cut[1])
