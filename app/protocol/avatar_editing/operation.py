"""What all operations on avatar configurations share: their base, the types of their values."""

from collections.abc import Callable, Iterable
from typing import Annotated, Final

from pydantic import AfterValidator, Field, StringConstraints

from app.protocol.avatar_changes import BodyGroup, Motor
from app.protocol.common import Strict, refusal
from app.science.avatar.body import AXIS_NAMES, PART_NAMES
from app.science.avatar.configuration import (
    ASPECTS,
    Aspect,
    AvatarProblem,
    AvatarSettingsError,
    Configuration,
    axes_of,
    parts_of,
)

MAX_TARGETS: Final = 200
MAX_FACTOR: Final = 1_000.0

Versions = Callable[[str, int | None], Configuration]
"""Returns a saved version of an avatar by key and number, or the newest version for None. Raises
AvatarSettingsError if there is none."""


def _known_part(name: str) -> str:
    if name not in PART_NAMES:
        raise refusal(
            f"There is no body part {name!r}.",
            value=name,
            valid=list(PART_NAMES),
            remedy="Name a body part as in Unity's HumanBodyBones.",
        )
    return name


Amount = Annotated[float | None, Field(ge=0, le=1e6)]
Factor = Annotated[float | None, Field(ge=0, le=MAX_FACTOR, description="times the present value")]
Angle = Annotated[float | None, Field(ge=-180, le=180, description="degrees from the T-pose")]
Half = Annotated[float, Field(ge=0, le=180, description="degrees to either side of the T-pose")]
Part = Annotated[str, StringConstraints(min_length=1, max_length=40), AfterValidator(_known_part)]
Targets = Annotated[tuple[Motor, ...], Field(min_length=1, max_length=MAX_TARGETS, strict=False)]
Groups = Annotated[tuple[BodyGroup, ...], Field(min_length=1, max_length=MAX_TARGETS, strict=False)]
Aspects = Annotated[tuple[Aspect, ...], Field(min_length=1, max_length=len(ASPECTS), strict=False)]


class AvatarOperation(Strict):
    """One edit of a configuration."""

    def applied(self, configuration: Configuration) -> Configuration:
        """Return the edited configuration; raise AvatarSettingsError with every problem."""
        raise NotImplementedError


def present_axes(configuration: Configuration, targets: Iterable[str]) -> tuple[str, ...]:
    """Return the axes of the targets that the configuration has, in the body's order.

    Raise AvatarSettingsError for a target without any.
    """
    chosen: set[str] = set()
    for at, name in enumerate(targets):
        own = (name,) if name in AXIS_NAMES else axes_of(name)
        present = [one for one in own if one in configuration.axes]
        if not present:
            raise _absent(configuration, f"targets[{at}]", name)
        chosen.update(present)
    return tuple(name for name in configuration.axes if name in chosen)


def present_parts(configuration: Configuration, targets: Iterable[str]) -> tuple[str, ...]:
    """Return the driven parts of the targets that the configuration has, in the body's order."""
    present = configuration.parts
    chosen: set[str] = set()
    for at, name in enumerate(targets):
        own = [one for one in parts_of(name) if one in present]
        if not own:
            raise _absent(configuration, f"targets[{at}]", name)
        chosen.update(own)
    return tuple(one for one in present if one in chosen)


def require_values(operation: AvatarOperation, beside: set[str]) -> None:
    """Raise AvatarSettingsError if an operation gives no value `beside` these keys."""
    given = operation.model_dump(exclude=beside, exclude_none=True)
    if not any(value != {} for value in given.values()):
        names = [name for name in type(operation).model_fields if name not in beside]
        raise problem(
            "", "Nothing is to be changed.", valid=names, remedy="Give at least one of the values."
        )


def problem(
    path: str, message: str, *, value: object = None, valid: object = None, remedy: str = ""
) -> AvatarSettingsError:
    """Make the error of one invalid value of an operation."""
    return AvatarSettingsError((AvatarProblem(path, message, value, valid, remedy),))


def _absent(configuration: Configuration, path: str, name: str) -> AvatarSettingsError:
    return problem(
        path,
        f"{name} has no driven axis in this configuration.",
        value=name,
        valid=list(configuration.parts),
        remedy="Name a body group, part or axis that the configuration has.",
    )
