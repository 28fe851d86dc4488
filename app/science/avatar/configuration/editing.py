"""Edit a configuration: each function returns a new one and leaves the original unchanged."""

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import replace
from math import pi
from typing import Final, Literal, get_args

from app.science.avatar.body import PART_NAMES, mirrored_name
from app.science.avatar.configuration.axis_settings import (
    AvatarProblem,
    AvatarSettingsError,
    AxisSettings,
)
from app.science.avatar.configuration.compliance import COMPLIANT_GROUPS, Compliance
from app.science.avatar.configuration.configuration import Configuration
from app.science.avatar.configuration.groups import GROUP_NAMES, PART_OF, axes_of, parts_of
from app.science.avatar.configuration.limits import ANATOMIC
from app.science.avatar.configuration.model_options import ColliderKind
from app.science.avatar.configuration.optional import same_layer_problem

Aspect = Literal["gains", "limits", "colliders", "casts", "delays", "compliance"]
"""What of a body part is copied: from the other side, or from another configuration."""
ASPECTS: Final[tuple[Aspect, ...]] = get_args(Aspect)
Direction = Literal["left_to_right", "right_to_left", "swap"]
Motion = Literal["locked", "limited", "free"]


def lock(
    configuration: Configuration, group: str, held_rad: Mapping[str, float] | None = None
) -> Configuration:
    """Lock a group of body parts, as by a plaster cast, and keep its limits for unlocking.

    Args:
        configuration: the configuration to edit.
        group: a body group or a part.
        held_rad: axis of the group -> angle at which it is held; axes that are absent are held at
            the T-pose's, as far as the limits allow. Locking a locked group replaces its angles.

    Raises:
        AvatarSettingsError: an unknown group, an axis of another group, or an angle beyond the
            limits.
    """
    return replace(
        configuration,
        locked_groups=(*(one for one in configuration.locked_groups if one != group), group),
        held_rad={**_held_outside(configuration, group), **(held_rad or {})},
    )


def unlock(configuration: Configuration, group: str) -> Configuration:
    """Unlock a group; locked groups that overlap it stay locked.

    Raises AvatarSettingsError if there is no such group.
    """
    parts_of(group)
    remaining = tuple(one for one in configuration.locked_groups if one != group)
    still_locked = {name for one in remaining for name in axes_of(one)}
    held = {name: angle for name, angle in configuration.held_rad.items() if name in still_locked}
    return replace(configuration, locked_groups=remaining, held_rad=held)


def mirror_left_to_right(configuration: Configuration) -> Configuration:
    """Give every axis of the right side the settings of its left counterpart.

    A positive angle is the same movement on both sides, so no sign changes. Locked groups and
    colliders stay unchanged, and so do parts that only one side of the model has.
    """
    return mirrored(configuration, "left_to_right")


def mirrored(
    configuration: Configuration,
    direction: Direction,
    *,
    group: Iterable[str] = ("all",),
    aspects: Collection[Aspect] = ("gains", "limits"),
) -> Configuration:
    """Copy settings from one side of the body to the other, or exchange the two sides.

    A positive angle is the same movement on both sides, so no sign changes. Copying twice gives
    what copying once gives; exchanging twice gives the original.

    Args:
        configuration: the configuration to edit.
        direction: the side that is copied and the side that receives, or `swap`.
        group: the groups or parts of either side that take part; both counterparts count.
        aspects: what is copied.

    Raises:
        AvatarSettingsError: no such group, a copied cast holds an axis beyond its limits, or a limb
            would have world targets and a part with a delay of its own.
    """
    named = {part for one in group for part in parts_of(one)}
    named |= {mirrored_name(part) for part in named}
    receiving = {
        "left_to_right": ("Right",), "right_to_left": ("Left",), "swap": ("Left", "Right"),
    }[direction]  # fmt: skip
    parts = [part for part in PART_NAMES if part in named and part.startswith(receiving)]
    return _copied(configuration, configuration, {p: mirrored_name(p) for p in parts}, aspects)


def reset(
    configuration: Configuration,
    source: Configuration,
    *,
    group: Iterable[str] = ("all",),
    aspects: Collection[Aspect] = ASPECTS,
) -> Configuration:
    """Give the parts of some groups the settings that they have in another configuration.

    Parts that one of the two configurations lacks stay as they are. Casts and compliance belong to
    groups: those of a group are reset if all of its parts are.

    Raises:
        AvatarSettingsError: no such group, a copied cast holds an axis beyond its limits, or a limb
            would have world targets and a part with a delay of its own.
    """
    named = {part for one in group for part in parts_of(one)}
    return _copied(configuration, source, {p: p for p in PART_NAMES if p in named}, aspects)


def with_axes(
    configuration: Configuration,
    names: Iterable[str],
    edit: Callable[[str, AxisSettings], AxisSettings],
) -> Configuration:
    """Return the configuration with some of its axes edited by a function of name and settings.

    Names of axes that the configuration lacks are passed over.

    Raises:
        AvatarSettingsError: the problems of every axis, each below `axes` and the axis' name.
    """
    axes, problems = dict(configuration.axes), list[AvatarProblem]()
    for name in names:
        if name not in axes:
            continue
        try:
            axes[name] = edit(name, axes[name])
        except AvatarSettingsError as error:
            problems += [one.prefixed(f"axes.{name}") for one in error.problems]
    if problems:
        raise AvatarSettingsError(tuple(problems))
    return replace(configuration, axes=axes)


def with_motion(
    configuration: Configuration, names: Iterable[str], motion: Motion
) -> Configuration:
    """Set how axes may turn: not at all, as a human body's do, or over the full circle.

    `locked` fixes an axis at the permitted angle nearest to the T-pose's. Source: Karas (2020),
    section 2.2.2, Locked, Limited and Free.
    """

    def edit(name: str, settings: AxisSettings) -> AxisSettings:
        if motion == "locked":
            return settings.locked_at(0.0)
        low, high = (-pi, pi) if motion == "free" else _anatomic(name)
        return settings.with_values(low_rad=low, high_rad=high)

    return with_axes(configuration, names, edit)


def with_colliders(
    configuration: Configuration, groups: Iterable[str], kind: ColliderKind
) -> Configuration:
    """Give the parts of some groups one kind of collider; raises AvatarSettingsError.

    Only parts that differ from the whole body's kind are kept as exceptions, so that equal
    colliders have equal hashes. `all` sets the whole body's kind.
    """
    chosen = tuple(groups)
    if "all" in chosen:
        return replace(configuration, colliders=kind, part_colliders={})
    kinds = {**configuration.part_colliders}
    kinds.update({part: kind for one in chosen for part in parts_of(one)})
    return replace(configuration, part_colliders=_exceptions(configuration.colliders, kinds))


def with_global(
    configuration: Configuration,
    *,
    group: str = "all",
    kp: float | None = None,
    kd: float | None = None,
    max_torque_nm: float | None = None,
) -> Configuration:
    """Give every axis of a group the same gains or torque limit; what is None stays unchanged.

    Raises AvatarSettingsError: no such group, or an invalid value.
    """
    given = {"kp": kp, "kd": kd, "max_torque_nm": max_torque_nm}
    values = {name: value for name, value in given.items() if value is not None}
    chosen = set(axes_of(group))
    axes = {
        name: settings.with_values(**values) if name in chosen else settings
        for name, settings in configuration.axes.items()
    }
    return replace(configuration, axes=axes)


def with_axis(configuration: Configuration, name: str, settings: AxisSettings) -> Configuration:
    """Return the configuration with new settings for one axis.

    Raises AvatarSettingsError for an unknown axis.
    """
    return replace(configuration, axes={**configuration.axes, name: settings})


def without_parts(configuration: Configuration, missing: frozenset[str]) -> Configuration:
    """Return the configuration for a model that lacks some body parts, such as a finger."""
    removed = {name for part in missing for name in axes_of(part)}
    return replace(
        configuration,
        axes={name: one for name, one in configuration.axes.items() if name not in removed},
        held_rad={name: one for name, one in configuration.held_rad.items() if name not in removed},
    )


def _held_outside(configuration: Configuration, group: str) -> dict[str, float]:
    own = set(axes_of(group))
    return {name: angle for name, angle in configuration.held_rad.items() if name not in own}


def with_layers(
    configuration: Configuration, pair: tuple[str, str], *, collide: bool
) -> Configuration:
    """Let the parts of two collision layers collide, or not; raises AvatarSettingsError."""
    if same := same_layer_problem(pair):
        raise AvatarSettingsError((same,))
    change = configuration.colliding.union if collide else configuration.colliding.difference
    return replace(configuration, colliding=change((frozenset(pair),)))


def with_delays(
    configuration: Configuration, groups: Iterable[str], delay_s: float
) -> Configuration:
    """Let the parts of some groups lag behind the others; raises AvatarSettingsError."""
    driven = {part for one in groups for part in parts_of(one)} & set(configuration.parts)
    return replace(
        configuration, delays_s={**configuration.delays_s, **dict.fromkeys(driven, delay_s)}
    )


def with_compliance(
    configuration: Configuration, groups: Iterable[str], compliance: Compliance
) -> Configuration:
    """Let some groups give way when they are pushed; raises AvatarSettingsError."""
    return replace(
        configuration,
        compliance={**configuration.compliance, **dict.fromkeys(groups, compliance)},
    )


def _copied(
    target: Configuration,
    source: Configuration,
    counterparts: Mapping[str, str],
    aspects: Collection[Aspect],
) -> Configuration:
    """Copy aspects of parts: receiving part of `target` -> the part of `source` that it follows."""
    axes, kinds = dict(target.axes), {**target.part_colliders}
    delays = dict(target.delays_s)
    groups, held = list(target.locked_groups), dict(target.held_rad)
    for name in target.axes:
        part = counterparts.get(PART_OF[name])
        own = None if part is None else source.axes.get(_renamed(name, PART_OF[name], part))
        if own is None:
            continue
        if "gains" in aspects:
            axes[name] = axes[name].with_values(
                kp=own.kp, kd=own.kd, max_torque_nm=own.max_torque_nm
            )
        if "limits" in aspects:
            axes[name] = axes[name].with_values(low_rad=own.low_rad, high_rad=own.high_rad)
    if "colliders" in aspects:
        kinds.update({part: source.collider_of(own) for part, own in counterparts.items()})
        kinds = _exceptions(target.colliders, kinds)
    if "delays" in aspects:
        delays |= {part: source.delays_s.get(own, 0.0) for part, own in counterparts.items()}
    if "casts" in aspects:
        groups, held = _copied_casts(target, source, counterparts)
    compliance = dict(target.compliance)
    if "compliance" in aspects:
        compliance |= _copied_compliance(source, counterparts)
    return replace(
        target,
        axes=axes,
        part_colliders=kinds,
        locked_groups=tuple(groups),
        held_rad=held,
        delays_s=delays,
        compliance=compliance,
    )


def _copied_compliance(
    source: Configuration, counterparts: Mapping[str, str]
) -> dict[str, Compliance]:
    """Return the compliance of every group of which all parts are copied."""
    by_parts = {frozenset[str | None](parts_of(group)): group for group in COMPLIANT_GROUPS}
    found: dict[str, Compliance] = {}
    for group in COMPLIANT_GROUPS:
        own = by_parts.get(frozenset(counterparts.get(part) for part in parts_of(group)))
        if own is not None:
            found[group] = source.compliance.get(own, Compliance())
    return found


def _copied_casts(
    target: Configuration, source: Configuration, counterparts: Mapping[str, str]
) -> tuple[list[str], dict[str, float]]:
    """Return locked groups and held angles after the casts of some parts are copied.

    A group takes part if all of its driven parts do. Groups that reach beyond the copied parts,
    such as the whole body, stay as they are.
    """
    back = {own: part for part, own in counterparts.items()}
    mirrors = any(part != own for part, own in counterparts.items())

    def inside(group: str, parts: Collection[str]) -> bool:
        return set(parts_of(group)) <= set(parts)

    kept = [one for one in target.locked_groups if not inside(one, counterparts)]
    came = [
        _mirrored_group(one) if mirrors else one
        for one in source.locked_groups
        if inside(one, back)
    ]
    groups = [one for one in GROUP_NAMES if one in {*kept, *came}]
    still = {name for one in kept for name in axes_of(one)}
    held = {name: angle for name, angle in target.held_rad.items() if name in still}
    arrived = {name for one in came for name in axes_of(one)}
    for name, angle in source.held_rad.items():
        part = back.get(PART_OF[name])
        own = None if part is None else _renamed(name, PART_OF[name], part)
        if own in arrived and own in target.axes:
            held[own] = angle
    return groups, held


def _mirrored_group(group: str) -> str:
    for side, other in (("left_", "right_"), ("right_", "left_")):
        if group.startswith(side):
            return other + group.removeprefix(side)
    return mirrored_name(group)


def _renamed(axis: str, part: str, other: str) -> str:
    return other + axis.removeprefix(part)


def _exceptions(whole: ColliderKind, kinds: Mapping[str, ColliderKind]) -> dict[str, ColliderKind]:
    return {part: kind for part, kind in kinds.items() if kind != whole}


def _anatomic(name: str) -> tuple[float, float]:
    return ANATOMIC[name].low_rad, ANATOMIC[name].high_rad
