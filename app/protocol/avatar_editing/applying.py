"""Apply operations to a configuration, and say what changes and what is lost."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache

from app.protocol.avatar import check_pieces
from app.protocol.avatar_editing.axis_operations import ConvertTemplate
from app.protocol.avatar_editing.body_operations import Load
from app.protocol.avatar_editing.difference import ValueChange, differences
from app.protocol.avatar_editing.operation import AvatarOperation, Versions
from app.science.avatar.configuration import (
    AvatarProblem,
    AvatarSettingsError,
    Configuration,
    degrees_of,
    joined,
    primary_axis,
)


@dataclass(frozen=True)
class Loss:
    """A value that a conversion cannot keep.

    Attributes:
        operation: the position of the operation in the list, from 0.
        change: the value before and after.
        reason: why it cannot be kept.
    """

    operation: int
    change: ValueChange
    reason: str


@dataclass(frozen=True)
class OperationProblem:
    """Why an operation cannot be made; `operation` is its position, None for the whole result."""

    operation: int | None
    problem: AvatarProblem


@dataclass(frozen=True)
class Edited:
    """The result of operations.

    Attributes:
        configuration: the edited configuration, or the original one if there are problems.
        changed: every value that differs from the original.
        lost: what conversions could not keep.
        problems: why an operation cannot be made; if there are any, nothing was changed.
    """

    configuration: Configuration
    changed: tuple[ValueChange, ...] = ()
    lost: tuple[Loss, ...] = ()
    problems: tuple[OperationProblem, ...] = ()


def edited(
    configuration: Configuration, operations: Sequence[AvatarOperation], versions: Versions
) -> Edited:
    """Apply operations one after the other: all of them, or none if one cannot be made.

    Args:
        configuration: the configuration to edit; it stays unchanged.
        operations: what to do.
        versions: gives the saved versions that `load` names.
    """
    present, lost = configuration, list[Loss]()
    version = cache(versions)
    for at, operation in enumerate(operations):
        try:
            after = (
                operation.taken(present, operation.source(version))
                if isinstance(operation, Load)
                else operation.applied(present)
            )
        except AvatarSettingsError as error:
            problems = tuple(OperationProblem(at, one) for one in error.problems)
            return Edited(configuration, problems=problems)
        if isinstance(operation, ConvertTemplate) and after != present:
            lost += _losses(at, present, after)
        present = after
    try:
        check_pieces(present)
    except AvatarSettingsError as error:
        return Edited(
            configuration, problems=tuple(OperationProblem(None, one) for one in error.problems)
        )
    return Edited(present, differences(configuration, present), tuple(lost))


def fits_single_template(configuration: Configuration) -> bool:
    """Return whether one joint per part can hold every limit and gain of the configuration."""
    return joined(configuration, configuration.parts).axes == configuration.axes


def _losses(at: int, before: Configuration, after: Configuration) -> Iterator[Loss]:
    for change in differences(before, after):
        if change.axis is None or change.part is None:
            continue
        if change.field in ("low_deg", "high_deg"):
            limits = before.axes[change.axis]
            kept_deg = degrees_of(max(abs(limits.low_rad), abs(limits.high_rad)))
            reason = (
                f"One joint per part gives {change.axis} a symmetric limit: the greater of both"
                f" sides, {kept_deg:g} deg. The smaller one is lost."
            )
        else:
            reason = (
                f"One joint per part gives all axes of {change.part} but"
                f" {primary_axis(change.part)} one drive: that of the stiffest."
            )
        yield Loss(at, change, reason)
