"""Options of an avatar's model, and constants that are the same for all models.

The hips follow the participant in one of two ways:

- `carried`: they are a mocap body, whose pose is set at each step. They never lag, a teleport does
  no harm and the simulation is twice as fast; but they have no speed, so limbs do not feel the
  hips' acceleration, and nothing pushes them.
- `welded`: they are a free body, tied to the mocap body `HipsTarget` by a stiff weld. Limbs feel
  the hips' inertia. Code that teleports the target must also set the hips' own position and speed.

Each body part touches things with a shape. A part has its simple shapes (capsules and boxes) and,
where a humanoid model gives it a skin, a convex piece of that. Both can be in one model while only
one of them collides, so the choice can be changed while the avatar runs (`switches.use_collider`).
A part without a piece keeps its simple shapes.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, Literal

from app.science.avatar.body import COLLIDING

TIMESTEP_S: Final = 0.002
"""Time step of the simulation. When the target jumps over the full range, 5 ms is unstable at four
times the default gains, 2 ms at eight times."""
HIPS_TARGET = "HipsTarget"
"""The mocap body that pulls welded hips; carried hips are a mocap body themselves."""
LIMIT_SOLREF = (2.0 * TIMESTEP_S, 1.0)
"""Joint limits are as stiff as a time constant of two steps allows, and critically damped."""
WALL_SOLREF = (2.0 * TIMESTEP_S, 1.0)
WALL_SOLIMP = (0.99, 0.999, 0.001, 0.5, 2.0)
"""With `WALL_SOLREF` a hand at 2 m/s enters a wall by some 4 mm and never passes it."""
WELD_SOLREF = (2.0 * TIMESTEP_S, 1.0)
WELD_SOLIMP = (0.9, 0.95, 0.001, 0.5, 2.0)
"""With `WELD_SOLREF` the hips lag 6 ms behind their target. If the weld were as hard as a wall, it
and the motors of the legs would oscillate against each other at 12 Hz with the feet off the
floor."""
FRICTION = (0.5, 0.005, 0.0001)
"""Sliding, torsional and rolling friction of skin and cloth on smooth board, an estimate."""


@dataclass(frozen=True)
class ModelOptions:
    """Options with which a MuJoCo model is built.

    Attributes:
        hips: how the hips follow the participant; see the module docstring.
        gravity: whether gravity acts on the body.
        self_collision: whether parts collide with each other as `layers` defines.
        colliding: the pairs of collision layers that collide.
        delays_s: body part -> time by which the motors of its axes lag behind those of the others.
        carried_parts: the parts whose weight is carried (`compliance`).
        longest_delay_s: the longest latency that can be set while the model runs; see
            `MjModel.actuator_delay`. With zero there are no delay buffers.
        step_s: the time step. Walls, limits and welds become softer with a longer one: MuJoCo
            raises their time constants to two steps.
    """

    hips: Literal["carried", "welded"] = "carried"
    gravity: bool = True
    self_collision: bool = True
    longest_delay_s: float = 1.0
    colliding: frozenset[frozenset[str]] = COLLIDING
    delays_s: Mapping[str, float] = field(default_factory=dict)
    carried_parts: frozenset[str] = frozenset()
    step_s: float = TIMESTEP_S


DEFAULT_OPTIONS: Final = ModelOptions()
"""Carried hips, gravity, self-collision, up to one second of latency."""


ColliderKind = Literal["simple", "mesh", "none"]


@dataclass(frozen=True)
class Colliders:
    """The kinds of collider of the parts of one model.

    Attributes:
        kinds: body part -> kind; `simple` for parts that are absent.
        both: whether convex pieces are in the model in addition to the simple shapes.
    """

    kinds: Mapping[str, ColliderKind] = field(default_factory=dict)
    both: bool = False

    def of(self, part: str) -> ColliderKind:
        """Return the kind of collider of a part."""
        return self.kinds.get(part, "simple")


SIMPLE: Final = Colliders()
"""Colliders that use the simple shapes of every part."""
