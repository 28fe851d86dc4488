"""Made-up avatar configurations, and hypothesis strategies that generate them."""

import math
from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from hypothesis import strategies as st

from app.science.avatar.body.deleva import Population
from app.science.avatar.body.layers import COLLIDING, SWITCHABLE_LAYERS
from app.science.avatar.body.parts import AXES_OF, PART_NAMES, mirrored_name
from app.science.avatar.configuration.axis_settings import AxisSettings
from app.science.avatar.configuration.compliance import (
    COMPLIANT_GROUPS,
    LIMBS,
    Compliance,
    LimbTargets,
)
from app.science.avatar.configuration.configuration import Configuration
from app.science.avatar.configuration.groups import axes_of, parts_of
from app.science.avatar.configuration.model_options import ColliderKind
from app.science.avatar.configuration.templates import Drive, SingleJoint, primary_axis, shared_axes

T = TypeVar("T")
DRIVEN = tuple(part for part in PART_NAMES if AXES_OF[part])
PAIRS = sorted(SWITCHABLE_LAYERS, key=sorted)
FINE_SPRING = AxisSettings(300.0, 20.0, 150.0, math.radians(-41.0), math.radians(125.0))

gains = st.floats(0.0, 1e6, allow_nan=False)
angles_rad = st.floats(-180.0, 180.0, allow_nan=False).map(math.radians)
limits_rad = st.floats(0.0, 180.0, allow_nan=False).map(math.radians)
drives = st.builds(Drive, gains, gains, gains)
softness = st.builds(Compliance, st.floats(0.01, 1.0))


@st.composite
def axis_settings(draw: st.DrawFn) -> AxisSettings:
    """Draw axis settings with any gains and any range."""
    low, high = sorted((draw(angles_rad), draw(angles_rad)))
    return AxisSettings(draw(gains), draw(gains), draw(gains), low, high)


@st.composite
def single_joints(draw: st.DrawFn) -> SingleJoint:
    """Draw a single joint of any driven part."""
    part = draw(st.sampled_from(DRIVEN))
    low, high = sorted((draw(angles_rad), draw(angles_rad)))
    others = shared_axes(part)
    return SingleJoint(
        part=part,
        low_rad=low,
        high_rad=high,
        drive=draw(drives),
        limits_rad={name: draw(limits_rad) for name in others},
        shared_drive=draw(drives) if others else None,
    )


@st.composite
def part_axes(draw: st.DrawFn) -> tuple[str, dict[str, AxisSettings]]:
    """Draw a driven part with any settings of its axes."""
    part = draw(st.sampled_from(DRIVEN))
    return part, {axis.name: draw(axis_settings()) for axis in AXES_OF[part]}


@st.composite
def configurations(draw: st.DrawFn) -> Configuration:
    """Draw a configuration of a few parts, some of them locked."""
    parts = draw(st.lists(st.sampled_from(DRIVEN), min_size=1, max_size=4, unique=True))
    axes = {name: draw(axis_settings()) for part in parts for name in axes_of(part)}
    locked = draw(st.lists(st.sampled_from(parts), unique=True))
    names = [name for part in locked for name in axes_of(part)]
    held_axes = draw(st.lists(st.sampled_from(names), unique=True)) if names else []
    colliders: ColliderKind = draw(st.sampled_from(("simple", "mesh", "none")))
    head_of_skin = draw(st.booleans())
    switched = draw(st.frozensets(st.sampled_from(PAIRS), max_size=3))
    delayed = draw(st.dictionaries(st.sampled_from(parts), st.floats(0.0, 1.0), max_size=2))
    soft = draw(st.dictionaries(st.sampled_from(COMPLIANT_GROUPS), softness, max_size=2))
    shares = draw(st.dictionaries(st.sampled_from(parts), st.floats(0.001, 0.2), max_size=2))
    modelled = colliders == "mesh" or head_of_skin or draw(st.booleans())
    return Configuration(
        axes=axes,
        total_mass_kg=draw(st.floats(1.0, 500.0)),
        population=draw(st.sampled_from(("male", "female", "average"))),
        gravity=draw(st.booleans()),
        self_collision=draw(st.booleans()),
        hips=draw(st.sampled_from(("carried", "welded"))),
        target_space=draw(st.sampled_from(("local", "world"))),
        colliders=colliders,
        part_colliders={"Head": "mesh"} if head_of_skin else {},
        humanoid=draw(st.text("0123456789abcdef", min_size=64, max_size=64)) if modelled else None,
        locked_groups=tuple(locked),
        held_rad={name: axes[name].clamped(draw(angles_rad)) for name in held_axes},
        colliding=COLLIDING ^ switched,
        delays_s=delayed,
        relative_masses=shares,
        compliance=soft,
    )


def made_up(seed: int) -> Configuration:
    """Return the made-up configuration with this number: many parts, most of them on both sides.

    It takes a fraction of the time of `configurations`, whose failures are made smaller.
    """
    rng = np.random.default_rng(seed)

    def some(names: Sequence[T], share: float) -> list[T]:
        return [one for one in names if rng.random() < share]

    def one_of(names: Sequence[T]) -> T:
        return names[int(rng.integers(len(names)))]

    def angle_deg() -> float:
        return one_of(
            (float(rng.uniform(-180.0, 180.0)), float(rng.integers(-180, 181)), 0.0, 45.0)
        )

    def axis() -> AxisSettings:
        low, high = sorted(math.radians(angle_deg()) for _ in range(2))
        kp, kd, torque = (one_of((0.0, float(rng.uniform(0.0, 1e4)), 300.0)) for _ in range(3))
        return AxisSettings(kp, kd, torque, low, high)

    chosen = [*some(DRIVEN, 0.08), one_of(DRIVEN)]
    parts = list(dict.fromkeys((*chosen, *map(mirrored_name, some(chosen, 0.8)))))
    axes = {name: axis() for part in parts for name in axes_of(part)}
    locked = some(parts, 0.2)
    held = some([name for part in locked for name in axes_of(part)], 0.5)
    kinds: tuple[ColliderKind, ...] = ("simple", "none")
    populations: tuple[Population, ...] = ("male", "female", "average")
    delays_s = {part: float(rng.uniform(0.0, 1.0)) for part in some(parts, 0.2)}

    def softness_of(group: str) -> Compliance:
        # A limb with a part that lags cannot have targets in the world.
        may_turn = group in LIMBS and not set(delays_s).intersection(parts_of(group))
        targets: tuple[LimbTargets, ...] = ("joint", "world") if may_turn else ("joint",)
        return Compliance(one_of((1.0, 0.1, float(rng.uniform(0.01, 1.0)))), one_of(targets))

    return Configuration(
        axes=axes,
        total_mass_kg=float(rng.uniform(1.0, 500.0)),
        population=one_of(populations),
        gravity=one_of((True, False)),
        self_collision=one_of((True, False)),
        hips=one_of(("carried", "welded")),
        target_space=one_of(("local", "world")),
        colliders=one_of(kinds),
        part_colliders={part: one_of(kinds) for part in some(parts, 0.3)},
        locked_groups=tuple(locked),
        held_rad={name: axes[name].clamped(math.radians(angle_deg())) for name in held},
        colliding=COLLIDING ^ frozenset(some(PAIRS, 0.03)),
        delays_s=delays_s,
        relative_masses={part: float(rng.uniform(0.001, 0.02)) for part in some(parts, 0.2)},
        compliance={group: softness_of(group) for group in some(COMPLIANT_GROUPS, 0.4)},
    )


def whole_body(settings: AxisSettings = FINE_SPRING) -> Configuration:
    """Return a configuration of the whole body with the same settings for every axis."""
    return Configuration({axis.name: settings for part in DRIVEN for axis in AXES_OF[part]})


def axes_of_part(
    part: str, primary: AxisSettings, *shared: AxisSettings
) -> dict[str, AxisSettings]:
    """Return a part's axis settings by name, given those of the primary and the shared axes."""
    return {primary_axis(part): primary, **dict(zip(shared_axes(part), shared, strict=True))}
