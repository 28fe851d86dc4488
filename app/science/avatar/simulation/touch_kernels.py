"""Compiled parts of `touches`, which run at every frame of a task.

Importing this module loads the compiler.
"""

import numpy as np
import numpy.typing as npt

from app.science.compiled import compiled
from app.science.rotations import FloatArray

Bools = npt.NDArray[np.bool_]
Integers = npt.NDArray[np.int64]


@compiled
def mark_contacts(
    geoms: npt.NDArray[np.int32], surface_of: Integers, joint_of: Integers, touched: Bools
) -> None:
    """Set (S, P) where a contact (n, 2) is between a surface's geom and a part's.

    `surface_of`, `joint_of`: row of each geom, -1 for those that are none.
    """
    for contact in range(geoms.shape[0]):
        first, second = geoms[contact, 0], geoms[contact, 1]
        if surface_of[first] >= 0 and joint_of[second] >= 0:
            touched[surface_of[first], joint_of[second]] = True
        if surface_of[second] >= 0 and joint_of[first] >= 0:
            touched[surface_of[second], joint_of[first]] = True


@compiled
def left(continuing: Bools, near: Bools) -> list[tuple[int, int]]:
    """Return the pairs (surface, part) that touched and are not known to be near, of (S, P)."""
    return [
        (surface, part)
        for surface in range(continuing.shape[0])
        for part in range(continuing.shape[1])
        if continuing[surface, part] and not near[surface, part]
    ]


@compiled
def near_geoms(
    mark: int, places_m: FloatArray, radii_m: FloatArray, solid: npt.NDArray[np.int32],
    joint_of: Integers, margin_m: float,
) -> list[int]:  # fmt: skip
    """Return the parts' solid geoms whose bounding sphere is within the margin of a mark's.

    `places_m`: (n, 3) and `radii_m`: (n,) of these spheres. `solid`: above 0 where geoms collide.
    """
    found = []
    for geom in range(places_m.shape[0]):
        if joint_of[geom] < 0 or solid[geom] <= 0:
            continue
        reach_m = radii_m[geom] + radii_m[mark] + margin_m
        squared = 0.0
        for axis in range(3):
            off = places_m[geom, axis] - places_m[mark, axis]
            squared += off * off
        if squared <= reach_m * reach_m:
            found.append(geom)
    return found
