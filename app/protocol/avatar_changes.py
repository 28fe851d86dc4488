"""Define the changes to a running avatar: gravity, collisions, casts and gains, as a frozen value.

A study gives changes to one of its phases, and an operator makes them during a session; both use
this value. It says how the avatar differs from its configuration while the changes are in force.
What is left out stays as it is. If a part, an axis or a pair of layers is named more than once, the
later entry applies. `settings_in_force` applies several changes one after the other: those of the
study, then those of the operator.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from math import radians
from typing import Annotated, Any, Final

from pydantic import AfterValidator, Field, StringConstraints

from app.protocol.common import Strict, refusal
from app.science.avatar.body import AXIS_NAMES, LAYERS, SWITCHABLE_LAYERS
from app.science.avatar.configuration import (
    GROUP_NAMES,
    MAX_TORQUE_NM,
    AvatarProblem,
    AvatarSettingsError,
    AxisSettings,
    ColliderKind,
    Configuration,
    RunningSettings,
    as_configured,
    axes_of,
    degrees_of,
    parts_of,
)

MAX_FACTOR: Final = 8.0
"""How many times stronger than configured a motor can be made. With steps of 2 ms, motors with
eight times the usual gains are still stable when their target jumps over the full range."""
MAX_ENTRIES: Final = 100


def _known_group(name: str) -> str:
    return _one_of(name, GROUP_NAMES, "There is no body group {0!r}.", "Name a body group or part.")


def _known_motor(name: str) -> str:
    names = (*GROUP_NAMES, *AXIS_NAMES)
    return _one_of(
        name, names, "There is no body group or axis {0!r}.", "Name a body group, part or axis."
    )


def _known_axis(name: str) -> str:
    return _one_of(
        name, AXIS_NAMES, "There is no axis {0!r}.", "Name an axis such as LeftUpperLegX."
    )


def _known_layer(name: str) -> str:
    return _one_of(name, LAYERS, "There is no collision layer {0!r}.", "Name one of the layers.")


def _one_of(name: str, names: Sequence[str], message: str, remedy: str) -> str:
    if name not in names:
        raise refusal(message.format(name), value=name, valid=list(names), remedy=remedy)
    return name


_Name = Annotated[str, StringConstraints(min_length=1, max_length=40)]
BodyGroup = Annotated[
    _Name, AfterValidator(_known_group), Field(description="a body group or part, as in left_arm")
]
Motor = Annotated[
    _Name, AfterValidator(_known_motor), Field(description="a body group, part or axis")
]
AxisName = Annotated[_Name, AfterValidator(_known_axis), Field(description="an axis")]
Layer = Annotated[_Name, AfterValidator(_known_layer), Field(description="a collision layer")]
Degrees = Annotated[float, Field(ge=-180, le=180, description="degrees from the T-pose")]
Factor = Annotated[
    float | None,
    Field(ge=0, le=MAX_FACTOR, description="times the configuration's value"),
    Field(exclude_if=lambda value: value is None),
]
Gain = Annotated[
    float | None,
    Field(ge=0, le=1e6, description="0 to 1e6"),
    Field(exclude_if=lambda value: value is None),
]
_IF_ANY = Field(exclude_if=lambda value: not value)
_IF_SET = Field(exclude_if=lambda value: value is None)


class ColliderChange(Strict):
    """The collider of the parts of a body group; `none` lets them pass through everything."""

    group: BodyGroup
    kind: ColliderKind


class LayerChange(Strict):
    """Whether the parts of two collision layers collide with each other."""

    # A list is converted to a tuple in requests, too.
    layers: Annotated[tuple[Layer, Layer], Field(strict=False)]
    collide: bool


class Cast(Strict):
    """A cast around a body group, which holds its axes.

    `held_deg`: axis -> the angle to which the axis is moved, and at which it is then held. Axes
    without an angle are held where they are when the cast is put on.
    """

    group: BodyGroup
    held_deg: Annotated[
        dict[AxisName, Degrees],
        Field(default_factory=dict, max_length=len(AXIS_NAMES)),
        _IF_ANY,
    ]


class GainChange(Strict):
    """The gains and greatest torque of the motors of a group, part or axis.

    Each is a factor of the configuration's value, or a value for each of these axes.
    """

    motors: Motor
    kp_factor: Factor = None
    kd_factor: Factor = None
    max_torque_factor: Factor = None
    kp_nm_per_rad: Gain = None
    kd_nm_s_per_rad: Gain = None
    max_torque_nm: Gain = None


class AvatarChanges(Strict):
    """Changes to a running avatar, compared with its configuration.

    `released`: body groups whose cast is taken off, such as one that the study has put on.
    """

    gravity: Annotated[bool | None, _IF_SET] = None
    self_collision: Annotated[bool | None, _IF_SET] = None
    colliders: Annotated[
        tuple[ColliderChange, ...], Field(max_length=MAX_ENTRIES, strict=False), _IF_ANY
    ] = ()
    layers: Annotated[
        tuple[LayerChange, ...], Field(max_length=MAX_ENTRIES, strict=False), _IF_ANY
    ] = ()
    released: Annotated[
        tuple[BodyGroup, ...], Field(max_length=MAX_ENTRIES, strict=False), _IF_ANY
    ] = ()
    casts: Annotated[tuple[Cast, ...], Field(max_length=MAX_ENTRIES, strict=False), _IF_ANY] = ()
    gains: Annotated[
        tuple[GainChange, ...], Field(max_length=MAX_ENTRIES, strict=False), _IF_ANY
    ] = ()

    @property
    def is_empty(self) -> bool:
        """Whether nothing is changed."""
        return not self.as_json()

    def as_json(self) -> dict[str, Any]:
        """Return the content as plain values, without what is not set."""
        return self.model_dump(mode="json")


def settings_in_force(
    configuration: Configuration, *changes: AvatarChanges | None
) -> RunningSettings:
    """Return the settings of an avatar after several changes, made one after the other.

    Raises:
        AvatarSettingsError: a change cannot be made to this avatar; the error lists every problem.
    """
    settings = as_configured(configuration)
    problems: list[AvatarProblem] = []
    for one in changes:
        if one is not None:
            problems += change_problems(configuration, one)
    if problems:
        raise AvatarSettingsError(tuple(problems))
    for one in changes:
        if one is not None:
            settings = _changed(configuration, settings, one)
    return settings


def _changed(
    configuration: Configuration, settings: RunningSettings, changes: AvatarChanges
) -> RunningSettings:
    colliders, layers = dict(settings.colliders), set(settings.layers)
    for collider in changes.colliders:
        colliders.update(dict.fromkeys(parts_of(collider.group), collider.kind))
    for pair in changes.layers:
        (layers.add if pair.collide else layers.discard)(frozenset(pair.layers))
    held = dict(settings.held_rad)
    for group in changes.released:
        for axis in axes_of(group):
            held.pop(axis, None)
    for cast in changes.casts:
        for axis in driven_axes_of(configuration, cast.group):
            angle_deg = cast.held_deg.get(axis)
            held[axis] = None if angle_deg is None else radians(angle_deg)
    axes, configured = dict(settings.axes), configuration.motors
    for gain in changes.gains:
        for axis in driven_axes_of(configuration, gain.motors):
            axes[axis] = _with_gains(configured[axis], axes[axis], gain)
    return RunningSettings(
        gravity=settings.gravity if changes.gravity is None else changes.gravity,
        self_collision=(
            settings.self_collision if changes.self_collision is None else changes.self_collision
        ),
        colliders=colliders,
        layers=frozenset(layers),
        held_rad={axis: held[axis] for axis in AXIS_NAMES if axis in held},
        axes=axes,
    )


def _with_gains(
    configured: AxisSettings, present: AxisSettings, change: GainChange
) -> AxisSettings:
    def one(value: float | None, factor: float | None, own: float, now: float) -> float:
        if value is not None:
            return value
        return now if factor is None else factor * own

    return replace(
        present,
        kp=one(change.kp_nm_per_rad, change.kp_factor, configured.kp, present.kp),
        kd=one(change.kd_nm_s_per_rad, change.kd_factor, configured.kd, present.kd),
        max_torque_nm=min(
            one(
                change.max_torque_nm,
                change.max_torque_factor,
                configured.max_torque_nm,
                present.max_torque_nm,
            ),
            MAX_TORQUE_NM,
        ),
    )


def driven_axes_of(configuration: Configuration, name: str) -> tuple[str, ...]:
    """Return the axes of a group, part or axis that have a motor in this configuration."""
    names = (name,) if name in AXIS_NAMES else axes_of(name)
    locked = configuration.locked_axes
    return tuple(one for one in names if one in configuration.axes and one not in locked)


def change_problems(
    configuration: Configuration, changes: AvatarChanges
) -> Iterator[AvatarProblem]:
    """Yield every reason why a change cannot be made to an avatar of this configuration."""
    yield from _collider_problems(configuration, changes.colliders)
    yield from _layer_problems(changes.layers)
    yield from _cast_problems(configuration, changes.casts)
    yield from _gain_problems(configuration, changes.gains)


def _collider_problems(
    configuration: Configuration, colliders: Iterable[ColliderChange]
) -> Iterator[AvatarProblem]:
    for at, one in enumerate(colliders):
        if one.kind == "mesh" and not configuration.uses_pieces:
            yield AvatarProblem(
                f"colliders[{at}].kind",
                "The avatar has no mesh colliders: its configuration names no model that has them.",
                value="mesh",
                valid=["simple", "none"],
                remedy="Choose 'simple', or a configuration with a model and mesh colliders.",
            )


def _layer_problems(layers: Iterable[LayerChange]) -> Iterator[AvatarProblem]:
    for at, one in enumerate(layers):
        if frozenset(one.layers) not in SWITCHABLE_LAYERS:
            yield AvatarProblem(
                f"layers[{at}].layers",
                f"Collisions of {one.layers[0]} with {one.layers[1]} cannot be switched: they"
                " are the same layer, or overlap in usual poses.",
                value=list(one.layers),
                valid=[sorted(pair) for pair in sorted(map(sorted, SWITCHABLE_LAYERS))],
                remedy="Choose one of the valid pairs.",
            )


def _cast_problems(configuration: Configuration, casts: Iterable[Cast]) -> Iterator[AvatarProblem]:
    for at, cast in enumerate(casts):
        driven = driven_axes_of(configuration, cast.group)
        if not driven:
            yield _not_driven(configuration, f"casts[{at}].group", cast.group)
            continue
        for axis, angle_deg in cast.held_deg.items():
            path = f"casts[{at}].held_deg.{axis}"
            if axis not in driven:
                yield AvatarProblem(
                    path,
                    f"{axis} is not a driven axis of {cast.group}, so this cast cannot hold it.",
                    value=axis,
                    valid=list(driven),
                    remedy="Name an axis of the group that has a motor, or remove the angle.",
                )
                continue
            limits = configuration.axes[axis]
            low, high = degrees_of(limits.low_rad), degrees_of(limits.high_rad)
            if not low <= angle_deg <= high:
                yield AvatarProblem(
                    path,
                    f"{axis} cannot be held at {angle_deg:g} deg.",
                    value=angle_deg,
                    valid=f"from {low:g} to {high:g}",
                    remedy="Give an angle within the limits of the axis.",
                )


def _gain_problems(
    configuration: Configuration, gains: Iterable[GainChange]
) -> Iterator[AvatarProblem]:
    fields = (("kp", "kp_nm_per_rad"), ("kd", "kd_nm_s_per_rad"))
    for at, gain in enumerate(gains):
        path = f"gains[{at}]"
        given = gain.model_dump(exclude={"motors"}, exclude_none=True)
        if not given:
            yield AvatarProblem(
                path,
                f"Nothing is said about the motors of {gain.motors}.",
                valid=sorted(set(GainChange.model_fields) - {"motors"}),
                remedy="Give a factor or a value, or remove the entry.",
            )
        for factor, value in (*((f"{a}_factor", b) for a, b in fields), _TORQUE):
            if factor in given and value in given:
                yield AvatarProblem(
                    f"{path}.{factor}",
                    f"Both a factor and a value are given for {gain.motors}.",
                    value=given[factor],
                    valid=[factor, value],
                    remedy=f"Give {factor} or {value}, not both.",
                )
        driven = driven_axes_of(configuration, gain.motors)
        if not driven:
            yield _not_driven(configuration, f"{path}.motors", gain.motors)
        for name, field in fields:
            asked = given.get(field)
            too_stiff = [
                axis
                for axis in driven
                if asked is not None
                and asked > MAX_FACTOR * getattr(configuration.axes[axis], name)
            ]
            if too_stiff:
                most = MAX_FACTOR * getattr(configuration.axes[too_stiff[0]], name)
                yield AvatarProblem(
                    f"{path}.{field}",
                    f"{asked:g} is more than {MAX_FACTOR:g} times the configured value of "
                    f"{too_stiff[0]}; the simulation could become unstable.",
                    value=asked,
                    valid=f"from 0 to {most:g}",
                    remedy="Give a smaller value, or save a configuration with stronger motors.",
                )


_TORQUE = ("max_torque_factor", "max_torque_nm")


def _not_driven(configuration: Configuration, path: str, name: str) -> AvatarProblem:
    valid = [one for one in GROUP_NAMES if driven_axes_of(configuration, one)]
    return AvatarProblem(
        path,
        f"No axis of {name} is driven in this configuration: {name} is missing or locked, or has "
        "no axes.",
        value=name,
        valid=valid,
        remedy="Choose a body group or part with a motor.",
    )
