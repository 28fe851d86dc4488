"""Change a running avatar: gravity, collisions, latency, casts, boxes.

A part may have both its simple shapes and a convex piece in the model, of which one collides;
`use_collider` chooses which one, and `set_collider` whether the part collides at all.

A body group is put in a cast by holding its axes: each hinge gets one angle as both limits, which
is as stiff as a joint's limit. A model built from a configuration with the group locked has no
hinge there at all; holding is for a cast that is put on while the body runs.

The boxes of a scene can be shown and hidden (`Boxes`). A study has boxes for the hands and boxes
for the feet, and only those of the current phase are in the room. The body passes through hidden
boxes. A part that is where a box appears is pushed out gently.
"""

from collections.abc import Callable, Collection
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import NO_COLLISION, SCENE_BIT, collision_bits
from app.science.avatar.configuration import ColliderKind
from app.science.avatar.mjcf import FLOOR, HingeTable, SimulationError
from app.science.rotations import FloatArray

if TYPE_CHECKING:
    import mujoco

_GRAVITY = 9.81


class Switches:
    """Changes the settings of one running model; `ranges_rad` (n, 2) are the current limits."""

    def __init__(self, model: "mujoco.MjModel", data: "mujoco.MjData", table: HingeTable) -> None:
        from mujoco import mjtGeom  # already loaded by the caller

        self._model, self._data, self._table = model, data, table
        self._limits: FloatArray = model.jnt_range[table.joints].copy()
        self.ranges_rad = self._limits.copy()
        self._held: dict[str, float] = {}
        shapes = model.geom_contype[model.geom_bodyid > 0]
        self._self_collision = bool(np.any(shapes > SCENE_BIT))
        self._touching = dict.fromkeys(table.bodies, True)
        self._is_piece = model.geom_type == int(mjtGeom.mjGEOM_MESH)
        self._kinds: dict[str, ColliderKind] = {
            part: self._built_kind(part) for part in table.bodies
        }

    @property
    def longest_delay_s(self) -> float:
        """Return the longest latency that this model can add."""
        samples = min(self._model.actuator_history[:, 0].tolist(), default=0)
        return max(samples - 1, 0) * float(self._model.opt.timestep)

    @property
    def delay_s(self) -> float:
        """Return the latency that is currently added."""
        return float(self._model.actuator_delay.max(initial=0.0))

    @property
    def held(self) -> frozenset[str]:
        """Return the axes that are held, as in a cast."""
        return frozenset(self._held)

    def set_delay(self, delay_s: float) -> None:
        """Add this latency to all hinges from now on; zero bypasses the buffer.

        Raises:
            SimulationError: below zero, or more than the model was built for.
        """
        if not 0.0 <= delay_s <= self.longest_delay_s:
            raise SimulationError(
                f"A delay of {delay_s} s is not possible: give 0 to {self.longest_delay_s:g} s, or"
                " build the model with a larger longest_delay_s."
            )
        self._model.actuator_delay[:] = delay_s

    def set_gravity(self, *, on: bool) -> None:
        """Switch gravity on or off."""
        self._model.opt.gravity[:] = (0.0, -_GRAVITY if on else 0.0, 0.0)

    def set_self_collision(self, *, on: bool) -> None:
        """Let body parts collide with each other, as the layers define, or only with the scene."""
        self._self_collision = on
        for part in self._table.bodies:
            self._set_masks(part)

    def set_collider(self, part: str, *, on: bool) -> None:
        """Let one body part collide, or pass through everything; raises SimulationError."""
        self._check(part)
        self._touching[part] = on
        self._set_masks(part)

    def collider(self, part: str) -> ColliderKind:
        """Return the kind of collider that one body part uses; raises SimulationError."""
        self._check(part)
        return self._kinds[part]

    def use_collider(self, part: str, kind: ColliderKind) -> None:
        """Let one body part collide with its simple shapes, its convex piece, or nothing.

        Raises:
            SimulationError: there is no such part, or the model has no piece of it.
        """
        self._check(part)
        if kind == "mesh" and not self._shapes(part, "mesh").any():
            raise SimulationError(
                f"The model has no convex piece of {part}: build it with a humanoid model whose"
                " skin covers the part, and with mesh colliders or switchable_colliders."
            )
        self._kinds[part] = kind
        self._set_masks(part)

    def hold(self, axes: Collection[str]) -> None:
        """Hold axes at their current angles; raises SimulationError for one without a hinge."""
        unknown = [name for name in axes if name not in self._table.names]
        if unknown:
            raise SimulationError(f"The axis {unknown[0]} has no hinge, so it cannot be held.")
        for name in axes:
            angle = self._data.qpos[self._table.angles[self._table.names.index(name)]]
            self._held[name] = float(angle)
        self._set_ranges()

    def release(self, axes: Collection[str] | None = None) -> None:
        """Release held axes; all of them if none are named."""
        for name in tuple(self._held) if axes is None else axes:
            self._held.pop(name, None)
        self._set_ranges()

    def _set_ranges(self) -> None:
        self.ranges_rad = self._limits.copy()
        for name, angle in self._held.items():
            self.ranges_rad[self._table.names.index(name)] = angle
        self._model.jnt_range[self._table.joints] = self.ranges_rad

    def _check(self, part: str) -> None:
        if part not in self._touching:
            raise SimulationError(
                f"The avatar has no {part!r}: name one of {', '.join(self._touching)}."
            )

    def _shapes(self, part: str, kind: ColliderKind) -> npt.NDArray[np.bool_]:
        """Return whether each geom is a shape of this part and kind, (ngeom,)."""
        if kind == "none":
            return np.zeros_like(self._is_piece)
        own: npt.NDArray[np.bool_] = self._model.geom_bodyid == self._table.bodies[part]
        shapes: npt.NDArray[np.bool_] = own & (self._is_piece == (kind == "mesh"))
        return shapes

    def _built_kind(self, part: str) -> ColliderKind:
        """Return the kind of collider of a part that the model was built with."""
        kinds: tuple[ColliderKind, ...] = ("simple", "mesh")
        masks = self._model.geom_contype
        return next((kind for kind in kinds if masks[self._shapes(part, kind)].any()), "none")

    def _set_masks(self, part: str) -> None:
        bits = collision_bits(part, self_collision=self._self_collision)
        if not self._touching[part] or self._kinds[part] == "none":
            bits = NO_COLLISION
        model, body = self._model, self._table.bodies[part]
        touching = self._shapes(part, self._kinds[part])
        own = model.geom_bodyid == body
        model.geom_contype[own] = np.where(touching[own], bits.contype, 0)
        model.geom_conaffinity[own] = np.where(touching[own], bits.conaffinity, 0)
        # MuJoCo compares the masks of bodies before those of their shapes.
        model.body_contype[body] = bits.contype
        model.body_conaffinity[body] = bits.conaffinity


if TYPE_CHECKING:
    import mujoco


class Boxes:
    """The boxes of one model's scene; all of them are shown at first.

    `soften` makes every contact of the body soft for a while (`soft_contacts`).
    """

    def __init__(self, model: "mujoco.MjModel", soften: Callable[[], None]) -> None:
        self._model, self._soften = model, soften
        scene_geoms = np.flatnonzero(model.geom_bodyid == 0).tolist()
        by_name = {str(model.geom(row).name): row for row in scene_geoms}
        self.geoms: dict[str, int] = {name: row for name, row in by_name.items() if name != FLOOR}
        rows = list(self.geoms.values())
        self._masks = {
            row: (int(model.geom_contype[row]), int(model.geom_conaffinity[row])) for row in rows
        }

    def solid(self, name: str) -> bool:
        """Return whether a box can be touched while it is shown; a mark on the floor cannot."""
        return any(self._masks[self.geoms[name]])

    def show(self, names: Collection[str]) -> None:
        """Show only the named boxes; raises SimulationError for one that the scene lacks."""
        unknown = [name for name in names if name not in self.geoms]
        if unknown:
            raise SimulationError(
                f"The scene has no {unknown[0]!r}: name one of {', '.join(self.geoms) or 'none'}."
            )
        for name, row in self.geoms.items():
            masks = self._masks[row] if name in names else (0, 0)
            self._model.geom_contype[row], self._model.geom_conaffinity[row] = masks
        self._soften()
