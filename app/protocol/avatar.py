"""Read and write avatar configuration files: JSON for people, in degrees, with units in its keys.

The content becomes a `Configuration` (app.science.avatar.configuration), which checks what concerns
several keys. The content hash is computed from the configuration as canonical JSON, so the order of
keys, white space and 60 for 60.0 make no difference.
"""

import json
import math
import re
from dataclasses import dataclass
from typing import Annotated, Any, Final, Literal

from pydantic import Field, StringConstraints, TypeAdapter, ValidationError

from app.protocol.common import Strict, canonical_json, sha256_of
from app.protocol.errors import ConfigError, ConfigProblem
from app.protocol.explanations import explain, locate
from app.protocol.source import Path, Source, read_source
from app.science.avatar.body import AXIS_NAMES, PART_NAMES, Population
from app.science.avatar.configuration import (
    AvatarProblem,
    AvatarSettingsError,
    AxisSettings,
    ColliderKind,
    Configuration,
    Hips,
    TargetSpace,
    degrees_of,
    piece_problems,
)
from app.science.instruments import DefinitionProblem

FORMAT: Final = "reembody-avatar"
VERSION: Final = 1

Angle = Annotated[float, Field(ge=-180, le=180, description="degrees from the T-pose")]
Name = Annotated[str, StringConstraints(min_length=1, max_length=40)]
HumanoidHash = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{64}$")]


class AxisFile(Strict):
    """The settings of one driven axis. Equal limits lock it."""

    kp_nm_per_rad: Annotated[float, Field(ge=0, le=1e6, description="spring, N m per radian")]
    kd_nm_s_per_rad: Annotated[float, Field(ge=0, le=1e6, description="damper, N m s per radian")]
    max_torque_nm: Annotated[float, Field(ge=0, le=1e6, description="greatest torque, N m")]
    low_deg: Angle
    high_deg: Angle


class AvatarFile(Strict):
    """An avatar's configuration.

    `axes`: those of all body parts that the model has, as in LeftUpperLegX. `hips`: moved with the
    participant's hips, or welded to them. `target_space`: joints follow the participant's joint
    angles, or parts their orientation in the room. `colliders` applies to all parts except those in
    `part_colliders`. `locked_groups` are fixed at the angles of `held_deg`, or else those of the
    T-pose. `humanoid` is the hash of the model whose body it has, left out for a body built from
    the participant's measures; `mesh` colliders need one.
    """

    format: Literal["reembody-avatar"]
    version: Literal[1]
    total_mass_kg: Annotated[float, Field(ge=1, le=500, description="kg, of the whole body")]
    population: Population
    gravity: bool
    self_collision: bool
    hips: Hips
    target_space: TargetSpace
    colliders: ColliderKind
    part_colliders: Annotated[dict[Name, ColliderKind], Field(max_length=len(PART_NAMES))]
    humanoid: HumanoidHash | None = None
    locked_groups: Annotated[list[Name], Field(max_length=len(PART_NAMES) + 20)]
    held_deg: Annotated[dict[Name, Angle], Field(max_length=len(AXIS_NAMES))]
    axes: Annotated[dict[Name, AxisFile], Field(min_length=1, max_length=len(AXIS_NAMES))]


@dataclass(frozen=True)
class LoadedAvatar:
    """A configuration with the SHA-256 of its content, which is computed from `canonical_json`."""

    configuration: Configuration
    content_hash: str
    canonical_json: str


_ADAPTER = TypeAdapter(AvatarFile)


def load_avatar(text: str) -> LoadedAvatar:
    """Parse a configuration file; raise ConfigError with its problems, each with its place."""
    source = _source(text)
    problems = list(source.problems)
    try:
        file = _ADAPTER.validate_json(json.dumps(source.tree))
        configuration = configuration_of(file)
        check_pieces(configuration)
    except ValidationError as error:
        raise ConfigError([*problems, *explain(error, _ADAPTER.json_schema(), source)]) from error
    except AvatarSettingsError as error:
        raise ConfigError([*problems, *(_located(one, source) for one in error.problems)]) from None
    if problems:
        raise ConfigError(problems)
    return loaded(configuration)


def loaded(configuration: Configuration) -> LoadedAvatar:
    """Return a configuration with its canonical form and hash."""
    canonical = canonical_json(_tree(configuration))
    return LoadedAvatar(configuration, sha256_of(canonical), canonical)


def parse_avatar_json(canonical: str) -> Configuration:
    """Parse a configuration stored as canonical JSON; raise ConfigError if it is invalid."""
    try:
        return configuration_of(_ADAPTER.validate_json(canonical))
    except ValidationError as error:
        raise ConfigError(explain(error, _ADAPTER.json_schema(), Source())) from error
    except AvatarSettingsError as error:
        raise ConfigError(_located(one, Source()) for one in error.problems) from None


def avatar_text(configuration: Configuration) -> str:
    """Format the configuration as a readable file with one axis per line.

    The same configuration always gives the same bytes.
    """
    tree = _tree(configuration)
    axes = tree.pop("axes")
    head = json.dumps(tree, indent=2, ensure_ascii=False)[: -len("\n}")]
    rows = ",\n".join(f"    {json.dumps(name)}: {json.dumps(axis)}" for name, axis in axes.items())
    return f'{head},\n  "axes": {{\n{rows}\n  }}\n}}\n'


def configuration_of(file: AvatarFile) -> Configuration:
    """Convert a file to a configuration.

    Raise AvatarSettingsError with all problems of its axes.
    """
    problems: list[AvatarProblem] = []
    axes: dict[str, AxisSettings] = {}
    for name, axis in file.axes.items():
        try:
            axes[name] = AxisSettings(
                kp=axis.kp_nm_per_rad,
                kd=axis.kd_nm_s_per_rad,
                max_torque_nm=axis.max_torque_nm,
                low_rad=math.radians(axis.low_deg),
                high_rad=math.radians(axis.high_deg),
            )
        except AvatarSettingsError as error:
            problems += [one.prefixed(f"axes.{name}") for one in error.problems]
    if problems:
        raise AvatarSettingsError(tuple(problems))
    return Configuration(
        axes=axes,
        total_mass_kg=file.total_mass_kg,
        population=file.population,
        gravity=file.gravity,
        self_collision=file.self_collision,
        hips=file.hips,
        target_space=file.target_space,
        colliders=file.colliders,
        part_colliders=file.part_colliders,
        humanoid=file.humanoid,
        locked_groups=tuple(file.locked_groups),
        held_rad={name: math.radians(angle) for name, angle in file.held_deg.items()},
    )


def file_of(configuration: Configuration) -> AvatarFile:
    """Convert a configuration to the content of a file."""
    return AvatarFile(
        format=FORMAT,
        version=VERSION,
        total_mass_kg=configuration.total_mass_kg,
        population=configuration.population,
        gravity=configuration.gravity,
        self_collision=configuration.self_collision,
        hips=configuration.hips,
        target_space=configuration.target_space,
        colliders=configuration.colliders,
        part_colliders=dict(configuration.part_colliders),
        humanoid=configuration.humanoid,
        locked_groups=list(configuration.locked_groups),
        held_deg={name: degrees_of(angle) for name, angle in configuration.held_rad.items()},
        axes={
            name: AxisFile(
                kp_nm_per_rad=axis.kp,
                kd_nm_s_per_rad=axis.kd,
                max_torque_nm=axis.max_torque_nm,
                low_deg=degrees_of(axis.low_rad),
                high_deg=degrees_of(axis.high_rad),
            )
            for name, axis in configuration.axes.items()
        },
    )


def check_pieces(configuration: Configuration) -> None:
    """Raise AvatarSettingsError if mesh colliders are configured without a humanoid model."""
    problems = tuple(piece_problems(configuration))
    if problems:
        raise AvatarSettingsError(problems)


def _tree(configuration: Configuration) -> dict[str, Any]:
    """Return the content of the file as plain values.

    Optional values that are not set are left out, so that they do not affect the hash.
    """
    return file_of(configuration).model_dump(mode="json", exclude_none=True)


def _source(text: str) -> Source:
    """Parse the text with the parser of study files, which records lines.

    JSON is a subset of YAML.
    """
    try:
        # In JSON, raw tabs can only be white space, but this parser requires spaces.
        return read_source(text.replace("\t", " "))
    except ConfigError as unreadable:
        try:
            json.loads(text)
        except json.JSONDecodeError as error:
            message = f"This is not JSON: {error.msg}."
            remedy = "Check commas, brackets and quotes here and in the line before."
            problem = ConfigProblem("", error.lineno, error.colno, message, remedy=remedy)
            raise ConfigError([problem]) from unreadable
        except RecursionError:
            pass
        raise


def _located(problem: AvatarProblem, source: Source) -> ConfigProblem:
    found = DefinitionProblem(
        _steps(problem.path), problem.message, problem.value, problem.valid, problem.remedy
    )
    return locate(found, source)


def _steps(path: str) -> Path:
    """Parse a path: `locked_groups[0]` is ("locked_groups", 0)."""
    return tuple(int(part) if part.isdigit() else part for part in re.findall(r"[^.\[\]]+", path))
