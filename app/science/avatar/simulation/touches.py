"""Determine which surfaces of a task the avatar touches, in the form that the task rules use.

A box is touched if the simulation found a contact in its last step: the hand rests against the
panel because the panel stops it. A mark on the floor stops nothing; it is touched by parts whose
shapes overlap it. A part that is not reported itself counts as the part above it, so fingers
count as the hand they belong to unless they are reported.

A touch continues until the part is farther away than a margin (hysteresis, as in `tasks.contacts`);
so for parts that no longer touch, the distance is computed.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import PARENT_OF
from app.science.skeleton import JOINT_NAMES

if TYPE_CHECKING:
    import mujoco

    from app.science.avatar.simulation.simulation import PhysicsAvatar

Bools = npt.NDArray[np.bool_]


class SurfaceTouches:
    """The touches of one avatar on S surfaces.

    Args:
        avatar: the avatar, in a scene with the surfaces (`scene.scene_of`).
        surfaces: the names of the surfaces.
        margin_m: distance at which a touch ends.
        parts: the P parts to report, by default the 22 joints of the skeleton.
    """

    def __init__(
        self,
        avatar: "PhysicsAvatar",
        surfaces: Sequence[str],
        margin_m: float,
        parts: Sequence[str] = JOINT_NAMES,
    ) -> None:
        import mujoco

        from app.science.avatar.simulation import touch_kernels  # loads the compiler

        self._mujoco, self._kernels = mujoco, touch_kernels
        self._model, self._data = avatar.model, avatar.data
        # MuJoCo's own array, which changes when other shapes are chosen.
        self._collides = avatar.model.geom_contype
        self._margin_m = margin_m
        boxes = avatar.boxes
        self._surface_geoms = [boxes.geoms[name] for name in surfaces]
        self._marks = [row for row, name in enumerate(surfaces) if not boxes.solid(name)]
        self._surface_of = np.full(avatar.model.ngeom, -1)
        self._surface_of[self._surface_geoms] = np.arange(len(surfaces))
        self._joint_of = _parts_of_geoms(avatar.model, parts)
        self._geoms_of = [
            np.flatnonzero(self._joint_of == row).tolist() for row in range(len(parts))
        ]
        self._continuing: Bools = np.zeros((len(surfaces), len(parts)), dtype=np.bool_)

    def read(self) -> tuple[Bools, Bools]:
        """Return which parts touch which surfaces, and which are near enough to continue a touch.

        Both are bool (S, P), after the simulation's last step.
        """
        touched = np.zeros_like(self._continuing)
        if self._data.ncon:
            geoms = self._data.contact.geom
            self._kernels.mark_contacts(geoms, self._surface_of, self._joint_of, touched)
        near = touched.copy()
        for row in self._marks:
            self._read_mark(row, touched, near)
        for surface, joint in self._kernels.left(self._continuing, near):
            # Of a part's alternative shapes some are switched off.
            solid = [geom for geom in self._geoms_of[joint] if self._collides[geom] > 0]
            distances = [self._distance_m(surface, geom) for geom in solid]
            near[surface, joint] = min(distances, default=np.inf) <= self._margin_m
        self._continuing = near & (self._continuing | touched)
        return touched, near

    def _read_mark(self, surface: int, touched: Bools, near: Bools) -> None:
        model = self._model
        for geom in self._kernels.near_geoms(
            self._surface_geoms[surface], self._data.geom_xpos, model.geom_rbound,
            self._collides, self._joint_of, self._margin_m,
        ):  # fmt: skip
            distance_m = self._distance_m(surface, geom)
            touched[surface, self._joint_of[geom]] |= distance_m <= 0.0
            near[surface, self._joint_of[geom]] |= distance_m <= self._margin_m

    def _distance_m(self, surface: int, geom: int) -> float:
        """Return the distance of a geom, at most twice the margin."""
        mark, farthest = self._surface_geoms[surface], 2.0 * self._margin_m
        distance = self._mujoco.mj_geomDistance
        return float(distance(self._model, self._data, geom, mark, farthest, None))


def _parts_of_geoms(model: "mujoco.MjModel", parts: Sequence[str]) -> npt.NDArray[np.int64]:
    """Return the reported part that each geom counts as, (n,); -1 for the scene's geoms."""
    index = {part: row for row, part in enumerate(parts)}
    joints = np.full(model.ngeom, -1, dtype=np.int64)
    for geom in range(model.ngeom):
        part: str | None = str(model.body(int(model.geom_bodyid[geom])).name)
        if part not in PARENT_OF:
            continue
        while part is not None and part not in index:
            part = PARENT_OF[part]
        joints[geom] = -1 if part is None else index[part]
    return joints
