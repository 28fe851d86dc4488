"""Change a running avatar: gravity, collisions, latency, casts, gains, boxes.

`apply` brings a model to the settings in force, whatever was changed before, and with the settings
of its configuration back to the model as it was built. The other methods change one thing.

A part may have both its simple shapes and a convex piece in the model, of which one collides;
`use_collider` chooses which one, and `set_collider` whether the part collides at all.

A body group is put in a cast by holding its axes: each hinge gets one angle as both limits, which
is as stiff as a joint's limit. A cast holds an axis where it is, or at a given angle, to which the
limits move at `CAST_SPEED_RAD_S`: a limit that jumped would hit the limb like a hammer. A model
built from a configuration with the group locked has no hinge there at all; holding is for a cast
that is put on while the body runs.

A motor's gains are the parameters of its actuator. They have exactly the same effect, whether the
model was built with them or given them later.

The boxes of a scene can be shown and hidden (`Boxes`). A study has boxes for the hands and boxes
for the feet, and only those of the current phase are in the room. The body passes through hidden
boxes. A part that is where a box appears is pushed out gently.
"""

from collections.abc import Callable, Collection, Mapping
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import (
    COLLIDING,
    LAYER_OF,
    LAYERS,
    NO_COLLISION,
    SCENE_BIT,
    collision_bits,
    layer_bit,
)
from app.science.avatar.configuration import AxisSettings, ColliderKind, RunningSettings
from app.science.avatar.mjcf import FLOOR, NO_TORQUE_NM, HingeTable, SimulationError
from app.science.rotations import FloatArray

if TYPE_CHECKING:
    import mujoco

_GRAVITY = 9.81
CAST_SPEED_RAD_S = 1.5
"""Speed at which a cast moves an axis to the angle at which it holds it."""
_ROUNDING_RAD = 1e-9


class Switches:
    """Changes the settings of one running model; `ranges_rad` (n, 2) are the current limits."""

    def __init__(self, model: "mujoco.MjModel", data: "mujoco.MjData", table: HingeTable) -> None:
        from mujoco import mjtGeom  # already loaded by the caller

        self._model, self._data, self._table = model, data, table
        self._limits: FloatArray = model.jnt_range[table.joints].copy()
        self.ranges_rad = self._limits.copy()
        self._own_delays_s: FloatArray = model.actuator_delay.copy()
        self._held: dict[str, float] = {}
        self._goals: dict[str, float] = {}
        shapes = model.geom_contype[model.geom_bodyid > 0]
        self._self_collision = bool(np.any(shapes > SCENE_BIT))
        self._layers = self._built_layers()
        self._touching = dict.fromkeys(table.bodies, True)
        self._is_piece = model.geom_type == int(mjtGeom.mjGEOM_MESH)
        self._kinds: dict[str, ColliderKind] = {
            part: self._built_kind(part) for part in table.bodies
        }

    @property
    def longest_delay_s(self) -> float:
        """Return the longest latency that this model can add to the delays of its own."""
        samples = self._model.actuator_history[:, 0] - 1
        spare_s = np.maximum(samples, 0) * float(self._model.opt.timestep) - self._own_delays_s
        return max(round(float(spare_s.min()), 9), 0.0) if spare_s.size else 0.0

    @property
    def delay_s(self) -> float:
        """Return the latency that is currently added."""
        added: FloatArray = self._model.actuator_delay - self._own_delays_s
        return float(added.max(initial=0.0))

    @property
    def held(self) -> frozenset[str]:
        """Return the axes that are held, as in a cast."""
        return frozenset(self._held)

    @property
    def held_rad(self) -> dict[str, float]:
        """Return the angle of each held axis: where it is held, or to where its cast moves it."""
        return {**self._held, **self._goals}

    def apply(
        self, settings: RunningSettings, held_before_rad: Mapping[str, float] | None = None
    ) -> None:
        """Bring the model to these settings; those of parts and axes that it lacks have no effect.

        Args:
            settings: the settings in force.
            held_before_rad: the angle of axes that are held without a given angle, if an earlier
                run of the model held them; else an axis stays where it is, and one that is in a
                cast already stays in it.
        """
        self.set_gravity(on=settings.gravity)
        self._self_collision, self._layers = settings.self_collision, settings.layers
        for part in self._table.bodies:
            kind = settings.colliders.get(part, self._kinds[part])
            has_piece = kind != "mesh" or bool(self._shapes(part, "mesh").any())
            self._kinds[part] = kind if has_piece else "simple"
            self._touching[part] = True
            self._set_masks(part)
        self.set_gains(
            {name: settings.axes[name] for name in self._table.names if name in settings.axes}
        )
        before = held_before_rad or {}
        hinges = [name for name in settings.held_rad if name in self._table.names]
        self.release([name for name in self._held if name not in hinges])
        for name in hinges:
            angle = settings.held_rad[name]
            if angle is None:
                angle = before.get(name)
            if angle is not None:
                self.hold_at({name: angle})
            elif name not in self._held:
                self.hold([name])

    def set_gains(self, axes: Mapping[str, AxisSettings]) -> None:
        """Set gains and greatest torque of axes; raises SimulationError for one without a hinge."""
        self._check_hinges(axes)
        model = self._model
        for name, settings in axes.items():
            row = int(model.actuator(name).id)
            # The parameters of a `pid` actuator without an integral: 0, -kp, -kd.
            model.actuator_biasprm[row, 1:3] = (-settings.kp, -settings.kd)
            torque = max(settings.max_torque_nm, NO_TORQUE_NM)
            model.actuator_forcerange[row] = (-torque, torque)

    def set_layers(self, colliding: frozenset[frozenset[str]]) -> None:
        """Let these pairs of layers collide, and no others."""
        self._layers = colliding
        for part in self._table.bodies:
            self._set_masks(part)

    def set_delay(self, delay_s: float) -> None:
        """Add this latency to all hinges from now on; zero bypasses the buffer.

        Parts that lag behind the others by the configuration keep their own delay beside it.

        Raises:
            SimulationError: below zero, or more than the model was built for.
        """
        if not 0.0 <= delay_s <= self.longest_delay_s:
            raise SimulationError(
                f"A delay of {delay_s} s is not possible: give 0 to {self.longest_delay_s:g} s, or"
                " build the model with a larger longest_delay_s."
            )
        self._model.actuator_delay[:] = self._own_delays_s + delay_s

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
        """Hold axes where they are; raises SimulationError for one without a hinge."""
        self._check_hinges(axes)
        for name in axes:
            row = self._table.names.index(name)
            angle = float(self._data.qpos[self._table.angles[row]])
            # A body that is pushed against a limit is a little beyond it.
            self._held[name] = float(np.clip(angle, *self._limits[row]))
            self._goals.pop(name, None)
        self._set_ranges()

    def hold_at(self, angles_rad: Mapping[str, float]) -> None:
        """Hold axes at these angles, to which `move_casts` moves them at `CAST_SPEED_RAD_S`.

        Raises:
            SimulationError: an axis has no hinge, or its angle is beyond its limits.
        """
        self._check_hinges(angles_rad)
        for name, angle in angles_rad.items():
            low, high = self._limits[self._table.names.index(name)]
            if not low - _ROUNDING_RAD <= angle <= high + _ROUNDING_RAD:
                raise SimulationError(
                    f"{name} cannot be held at {angle:g} rad: give {low:g} to {high:g} rad."
                )
        self.hold([name for name in angles_rad if name not in self._held])
        for name, angle in angles_rad.items():
            low, high = self._limits[self._table.names.index(name)]
            self._goals[name] = float(np.clip(angle, low, high))

    def move_casts(self, elapsed_s: float) -> None:
        """Move casts that are not yet at their angle; called for every frame."""
        if not self._goals:
            return
        way = CAST_SPEED_RAD_S * elapsed_s
        for name, goal in tuple(self._goals.items()):
            left = goal - self._held[name]
            if abs(left) <= way:
                self._held[name] = self._goals.pop(name)
            else:
                self._held[name] += way if left > 0.0 else -way
        self._set_ranges()

    def release(self, axes: Collection[str] | None = None) -> None:
        """Release held axes; all of them if none are named."""
        for name in tuple(self._held) if axes is None else axes:
            self._held.pop(name, None)
            self._goals.pop(name, None)
        self._set_ranges()

    def _set_ranges(self) -> None:
        self.ranges_rad = self._limits.copy()
        for name, angle in self._held.items():
            self.ranges_rad[self._table.names.index(name)] = angle
        self._model.jnt_range[self._table.joints] = self.ranges_rad

    def _check_hinges(self, axes: Collection[str]) -> None:
        unknown = [name for name in axes if name not in self._table.names]
        if unknown:
            raise SimulationError(
                f"The axis {unknown[0]} has no hinge, so it has no motor and cannot be held."
            )

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

    def _built_layers(self) -> frozenset[frozenset[str]]:
        """Return the pairs of layers that collide in the model as it was built.

        The standard pairs for layers without a shape, or if no parts collide with each other.
        """
        found = set(COLLIDING)
        model = self._model
        for part, body in self._table.bodies.items():
            own = (model.geom_bodyid == body) & (model.geom_contype > SCENE_BIT)
            for partners in model.geom_conaffinity[own][:1].tolist():
                for other in LAYERS:
                    pair = frozenset((LAYER_OF[part], other))
                    (found.add if partners & layer_bit(other) else found.discard)(pair)
        return frozenset(found)

    def _set_masks(self, part: str) -> None:
        bits = collision_bits(part, self_collision=self._self_collision, colliding=self._layers)
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
