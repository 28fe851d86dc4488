"""Soften the contacts of parts that are deep inside something, so that they are not thrown out.

Walls are so stiff that a moving hand enters them only by millimetres. A part that a teleport, or
hips carried through a wall, has put centimetres deep into something would leave it at hundreds of
metres per second. So the contacts of a part that is deeper than `DEEP_M` in something are soft,
with a time constant of `SOFT_SOLREF`, until it is less than `FREE_M` deep. After a teleport this
applies to all parts.
"""

from typing import TYPE_CHECKING

import numpy as np

from app.science.avatar.mjcf import HingeTable
from app.science.rotations import FloatArray

if TYPE_CHECKING:
    import mujoco

DEEP_M = 0.03
FREE_M = 0.005
SOFT_SOLREF = (0.1, 1.0)
SOFT_SOLIMP = (0.5, 0.8, 0.05, 0.5, 2.0)
_SOFT_PRIORITY = 2  # higher than the scene's


class SoftContacts:
    """Softens contacts according to how deep the parts of one body are inside other things."""

    def __init__(self, model: "mujoco.MjModel", data: "mujoco.MjData", table: HingeTable) -> None:
        self._model, self._data = model, data
        self._bodies = np.array(list(table.bodies.values()))
        self._default = (
            model.geom_priority.copy(),
            model.geom_solref.copy(),
            model.geom_solimp.copy(),
        )
        self._soft = np.zeros(model.nbody, dtype=np.bool_)
        self._any_soft = False

    def soften_all(self) -> None:
        """Make every contact of the body soft until its part is no longer deep inside anything."""
        self._soft[self._bodies] = True
        self._write()

    def watch(self) -> None:
        """Soften the contacts of parts deep inside something, and restore those of the others."""
        if not self._any_soft and not self._is_any_deep():
            return
        deepest = self._deepest_m()
        soft = np.where(self._soft, deepest > FREE_M, deepest > DEEP_M)
        if not np.array_equal(soft, self._soft):
            self._soft = soft
            self._write()

    def _is_any_deep(self) -> bool:
        # The smallest of a few numbers, without the checks of an array's own `min`.
        return self._data.ncon > 0 and bool(np.minimum.reduce(self._data.contact.dist) < -DEEP_M)

    def _deepest_m(self) -> FloatArray:
        """Return the greatest penetration depth of each body; zero for the world."""
        deepest = np.zeros(self._model.nbody)
        if self._data.ncon:
            bodies = self._model.geom_bodyid[self._data.contact.geom]
            np.maximum.at(deepest, bodies, -self._data.contact.dist[:, np.newaxis])
            deepest[0] = 0.0
        return deepest

    def _write(self) -> None:
        self._any_soft = bool(self._soft.any())
        model = self._model
        priority, solref, solimp = self._default
        soft = self._soft[model.geom_bodyid]
        model.geom_priority[:] = np.where(soft, _SOFT_PRIORITY, priority)
        model.geom_solref[:] = np.where(soft[:, np.newaxis], SOFT_SOLREF, solref)
        model.geom_solimp[:] = np.where(soft[:, np.newaxis], SOFT_SOLIMP, solimp)
