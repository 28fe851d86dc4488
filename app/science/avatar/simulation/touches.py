"""Which surfaces of a task the avatar touches, as the rules of the tasks want to know it.

A touch of a box is a contact that the simulation found in its last step: the hand stands at the
panel because the panel holds it up. A mark on the floor holds nothing up; it is touched by what is
at it. Fingers touch as the hand they are on, and any other part without a joint of its own as the
part above it.

A touch, once begun, is held until the part is a little way off (hysteresis, as in
`tasks.contacts`); so for parts that have just let go the distance is asked for.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import PARENT_OF
from app.science.skeleton import JOINT_INDEX

if TYPE_CHECKING:
    import mujoco

    from app.science.avatar.simulation.simulation import PhysicsAvatar

Bools = npt.NDArray[np.bool_]


class SurfaceTouches:
    """The touches of one avatar with S surfaces.

    Args:
        avatar: in a scene with the surfaces (`scene.scene_of`).
        surfaces: their names.
        margin_m: how far a part may go before a touch is over.
    """

    def __init__(self, avatar: "PhysicsAvatar", surfaces: Sequence[str], margin_m: float) -> None:
        import mujoco

        self._mujoco, self._model, self._data = mujoco, avatar.model, avatar.data
        self._margin_m = margin_m
        boxes = avatar.boxes
        self._surface_geoms = [boxes.geoms[name] for name in surfaces]
        self._marks = [row for row, name in enumerate(surfaces) if not boxes.solid(name)]
        self._surface_of = np.full(avatar.model.ngeom, -1)
        self._surface_of[self._surface_geoms] = np.arange(len(surfaces))
        self._joint_of = _joints_of_geoms(avatar.model)
        self._held: Bools = np.zeros((len(surfaces), len(JOINT_INDEX)), dtype=np.bool_)

    def read(self) -> tuple[Bools, Bools]:
        """Touches after the last step, and what is near enough to hold one: two bool (S, 22)."""
        touched = np.zeros_like(self._held)
        if self._data.ncon:
            first, second = self._data.contact.geom.T
            for geoms, others in ((first, second), (second, first)):
                surfaces, joints = self._surface_of[geoms], self._joint_of[others]
                hit = (surfaces >= 0) & (joints >= 0)
                touched[surfaces[hit], joints[hit]] = True
        near = touched.copy()
        for row in self._marks:
            self._read_mark(row, touched, near)
        for surface, joint in np.argwhere(self._held & ~near):
            geoms = np.flatnonzero((self._joint_of == joint) & self._solid())
            near[surface, joint] = self._distance_m(int(surface), geoms) <= self._margin_m
        self._held = near & (self._held | touched)
        return touched, near

    def _read_mark(self, surface: int, touched: Bools, near: Bools) -> None:
        mark, model = self._surface_geoms[surface], self._model
        apart = self._data.geom_xpos - self._data.geom_xpos[mark]
        reach = model.geom_rbound + model.geom_rbound[mark] + self._margin_m
        close = (np.einsum("gi,gi->g", apart, apart) <= reach**2) & (self._joint_of >= 0)
        close &= self._solid()
        for geom in np.flatnonzero(close):
            distance_m = self._distance_m(surface, np.array([geom]))
            touched[surface, self._joint_of[geom]] |= distance_m <= 0.0
            near[surface, self._joint_of[geom]] |= distance_m <= self._margin_m

    def _solid(self) -> Bools:
        """Shapes that touch things; others of the same part may wait to be chosen."""
        return np.asarray(self._model.geom_contype > 0)

    def _distance_m(self, surface: int, geoms: npt.NDArray[np.intp]) -> float:
        """Of the nearest of these shapes; twice the margin where all are further away."""
        mark, farthest = self._surface_geoms[surface], 2.0 * self._margin_m
        distance = self._mujoco.mj_geomDistance
        found = [
            distance(self._model, self._data, int(geom), mark, farthest, None) for geom in geoms
        ]
        return float(min(found, default=farthest))


def _joints_of_geoms(model: "mujoco.MjModel") -> npt.NDArray[np.int64]:
    """(n,) joint of the skeleton that each shape counts for; -1 for the scene's."""
    found = np.full(model.ngeom, -1, dtype=np.int64)
    for geom in range(model.ngeom):
        part: str | None = str(model.body(int(model.geom_bodyid[geom])).name)
        if part not in PARENT_OF:
            continue
        while part is not None and part not in JOINT_INDEX:
            part = PARENT_OF[part]
        found[geom] = -1 if part is None else JOINT_INDEX[part]
    return found
