"""Let groups of body parts give way when something pushes them, and come back afterwards.

Without compliance a body is as stiff as its gains, which are chosen to follow a person closely: a
force of 100 N at the shin turns it by less than a degree. A group's compliance has two sides:

- `stiffness`, a share s of the gains in the configuration: kp becomes s kp and kd becomes sqrt(s)
  kd, which keeps the damping ratio, as the damping of an axis of inertia I is kd / (2 sqrt(kp I)).
  A soft limb would sag under its own weight, so the weight of the group's parts is carried: without
  a push, a soft limb rests where a stiff one does, or nearer to its target.
- `targets` of arms and legs: `joint` keeps the angles of the joints, so a shin that is pushed turns
  with its thigh as one piece. `world` lets each part return to its own direction, whatever the part
  above it does (`app.science.avatar.targets.limb_yield`).

Source: Karas (2020), chapter 9: limbs that react stiffly, as their targets are local rotations.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Literal, get_args

from app.science.avatar.configuration.axis_settings import AvatarProblem, AxisSettings
from app.science.avatar.configuration.groups import PART_OF, parts_of

LimbTargets = Literal["joint", "world"]
LIMBS: Final = ("left_arm", "right_arm", "left_leg", "right_leg")
COMPLIANT_GROUPS: Final = ("trunk", "head", *LIMBS, "left_fingers", "right_fingers")
"""Groups that can be compliant; together they are the whole body, and none overlaps another."""
MIN_STIFFNESS: Final = 0.01
_DECIMALS: Final = 9


@dataclass(frozen=True)
class Compliance:
    """How a group gives way.

    Attributes:
        stiffness: share of the configured stiffness, from `MIN_STIFFNESS` to 1.
        targets: what the parts of an arm or leg return to; see the module docstring.
    """

    stiffness: float = 1.0
    targets: LimbTargets = "joint"


_STIFF: Final = Compliance()
_GROUP_OF: Mapping[str, str] = MappingProxyType(
    {part: group for group in COMPLIANT_GROUPS for part in parts_of(group)}
)


def compliant_groups(names: Iterable[str]) -> tuple[str, ...]:
    """Return the groups that can be compliant and together are the named ones.

    A name that is no such group stays as it is, so that the configuration refuses it by its name.
    """
    found: dict[str, None] = {}
    for name in names:
        parts = set(parts_of(name))
        inside = [one for one in COMPLIANT_GROUPS if parts.issuperset(parts_of(one))]
        found.update(dict.fromkeys(inside or [name]))
    return tuple(found)


def normal(compliance: Mapping[str, Compliance]) -> dict[str, Compliance]:
    """Return the groups that differ from a stiff body, in their order, rounded as in a file."""
    rounded = {
        group: Compliance(round(100.0 * one.stiffness, _DECIMALS) / 100.0, one.targets)
        for group, one in compliance.items()
    }
    return {
        group: rounded[group]
        for group in COMPLIANT_GROUPS
        if group in rounded and rounded[group] != _STIFF
    }


def softened(
    axes: Mapping[str, AxisSettings], compliance: Mapping[str, Compliance]
) -> dict[str, AxisSettings]:
    """Return the settings of axes with the stiffness of their groups."""
    found = dict(axes)
    for name, own in axes.items():
        share = compliance.get(_GROUP_OF[PART_OF[name]], _STIFF).stiffness
        if share != 1.0:
            found[name] = own.with_values(kp=share * own.kp, kd=math.sqrt(share) * own.kd)
    return found


def carried_parts(compliance: Mapping[str, Compliance]) -> frozenset[str]:
    """Return the parts whose weight is carried: those of groups that are less stiff."""
    soft = [group for group, one in compliance.items() if one.stiffness != 1.0]
    return frozenset(part for group in soft for part in parts_of(group) if part != "Hips")


def world_limbs(compliance: Mapping[str, Compliance]) -> tuple[str, ...]:
    """Return the limbs whose parts return to their own direction."""
    return tuple(group for group in LIMBS if compliance.get(group, _STIFF).targets == "world")


def compliance_problems(
    compliance: Mapping[str, Compliance], delays_s: Mapping[str, float]
) -> Iterator[AvatarProblem]:
    """Yield a problem for every group that cannot be compliant like this."""
    for group, one in compliance.items():
        path = f"compliance.{group}"
        if group not in COMPLIANT_GROUPS:
            yield AvatarProblem(
                path,
                f"{group!r} is no group that can be compliant.",
                value=group,
                valid=list(COMPLIANT_GROUPS),
                remedy="Name one of the valid groups.",
            )
            continue
        if not (math.isfinite(one.stiffness) and MIN_STIFFNESS <= one.stiffness <= 1.0):
            yield AvatarProblem(
                f"{path}.stiffness_percent",
                f"{100 * one.stiffness:g} % is out of range.",
                value=100 * one.stiffness,
                valid=f"from {100 * MIN_STIFFNESS:g} to 100 %",
                remedy="Give the share of the configured stiffness.",
            )
        if one.targets not in get_args(LimbTargets) or (
            one.targets == "world" and group not in LIMBS
        ):
            yield AvatarProblem(
                f"{path}.targets",
                f"{one.targets!r} targets are not possible for {group}.",
                value=one.targets,
                valid=list(get_args(LimbTargets)) if group in LIMBS else ["joint"],
                remedy=f"World targets are for {', '.join(LIMBS)}.",
            )
        late = [part for part in parts_of(group) if delays_s.get(part)]
        if one.targets == "world" and late:
            yield AvatarProblem(
                f"{path}.targets",
                f"{late[0]} lags by a delay of its own, so it would react to a push too late and"
                " swing.",
                value=one.targets,
                valid=["joint"],
                remedy="Choose joint targets, or take the delay out; the condition's latency does"
                " no harm.",
            )
