"""The boxes of a scene, shown and taken away while the avatar runs.

A study has boxes for the hands and boxes for the feet, and only those of the present phase stand in
the room. What is not shown is passed through. A part that is where a box appears is pushed out
gently.
"""

from collections.abc import Callable, Collection
from typing import TYPE_CHECKING

import numpy as np

from app.science.avatar.mjcf import FLOOR, SimulationError

if TYPE_CHECKING:
    import mujoco


class Boxes:
    """The blocks of one model's scene; all of them are shown at first.

    `soften` makes every contact of the body a soft one for now (`soft_contacts`).
    """

    def __init__(self, model: "mujoco.MjModel", soften: Callable[[], None]) -> None:
        self._model, self._soften = model, soften
        of_scene = np.flatnonzero(model.geom_bodyid == 0).tolist()
        named = {str(model.geom(row).name): row for row in of_scene}
        self.geoms: dict[str, int] = {name: row for name, row in named.items() if name != FLOOR}
        rows = list(self.geoms.values())
        self._masks = {
            row: (int(model.geom_contype[row]), int(model.geom_conaffinity[row])) for row in rows
        }

    def solid(self, name: str) -> bool:
        """Whether a block can be touched when it is shown; a mark on the floor cannot."""
        return any(self._masks[self.geoms[name]])

    def show(self, names: Collection[str]) -> None:
        """Show these and no others. Raises SimulationError for one that the scene lacks."""
        unknown = [name for name in names if name not in self.geoms]
        if unknown:
            raise SimulationError(
                f"The scene has no {unknown[0]!r}: name one of {', '.join(self.geoms) or 'none'}."
            )
        for name, row in self.geoms.items():
            masks = self._masks[row] if name in names else (0, 0)
            self._model.geom_contype[row], self._model.geom_conaffinity[row] = masks
        self._soften()
