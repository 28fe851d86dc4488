"""Made-up avatar configurations, and hypothesis strategies that generate them."""

import math

from hypothesis import strategies as st

from app.science.avatar.body.parts import AXES_OF, PART_NAMES
from app.science.avatar.configuration.axis_settings import AxisSettings
from app.science.avatar.configuration.configuration import Configuration
from app.science.avatar.configuration.groups import axes_of
from app.science.avatar.configuration.model_options import ColliderKind
from app.science.avatar.configuration.templates import Drive, SingleJoint, primary_axis, shared_axes

DRIVEN = tuple(part for part in PART_NAMES if AXES_OF[part])
FINE_SPRING = AxisSettings(300.0, 20.0, 150.0, math.radians(-41.0), math.radians(125.0))

gains = st.floats(0.0, 1e6, allow_nan=False)
angles_rad = st.floats(-180.0, 180.0, allow_nan=False).map(math.radians)
limits_rad = st.floats(0.0, 180.0, allow_nan=False).map(math.radians)
drives = st.builds(Drive, gains, gains, gains)


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
    )


def whole_body(settings: AxisSettings = FINE_SPRING) -> Configuration:
    """Return a configuration of the whole body with the same settings for every axis."""
    return Configuration({axis.name: settings for part in DRIVEN for axis in AXES_OF[part]})


def axes_of_part(
    part: str, primary: AxisSettings, *shared: AxisSettings
) -> dict[str, AxisSettings]:
    """Return a part's axis settings by name, given those of the primary and the shared axes."""
    return {primary_axis(part): primary, **dict(zip(shared_axes(part), shared, strict=True))}
