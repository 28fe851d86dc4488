"""Read and write avatar configuration files: JSON for people, in degrees, with units in its keys.

The content becomes a `Configuration` (app.science.avatar.configuration), which checks what concerns
several keys. The content hash is computed from the configuration as canonical JSON, so the order of
keys, white space and 60 for 60.0 make no difference.
"""

import json
import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, Field, StringConstraints, TypeAdapter, ValidationError

from app.protocol.avatar_changes import LayerChange
from app.protocol.avatar_joints import DrivenPart, JointFile, axes_of_joint, joint_files
from app.protocol.common import Strict, canonical_json, sha256_of
from app.protocol.errors import ConfigError, ConfigProblem
from app.protocol.explanations import did_you_mean, explain, locate
from app.protocol.source import Path, Source, read_json
from app.science.avatar.body import AXIS_NAMES, COLLIDING, PART_NAMES, SWITCHABLE_LAYERS, Population
from app.science.avatar.configuration import (
    COMPLIANT_GROUPS,
    AvatarProblem,
    AvatarSettingsError,
    AxisSettings,
    ColliderKind,
    Compliance,
    Configuration,
    Hips,
    LimbTargets,
    TargetSpace,
    degrees_of,
    idle_delay_problems,
    layer_changes,
    piece_problems,
    same_layer_problem,
)
from app.science.instruments import DefinitionProblem

FORMAT: Final = "reembody-avatar"
SINGLE_FORMAT: Final = "reembody-avatar-single"
"""The format of a file in the single template, which has `joints` instead of `axes`."""
FORMATS: Final = (FORMAT, SINGLE_FORMAT)
VERSION: Final = 1
_SAVE_ONE = "Choose a file that was saved by the page Avatars or by `reembody avatar load`."

Angle = Annotated[float, Field(ge=-180, le=180, description="degrees from the T-pose")]
OwnDelay = Annotated[float, Field(ge=0, le=1000, description="ms, added to the latency")]
Percent = Annotated[float, Field(gt=0, le=100, description="% of the total mass")]
Name = Annotated[str, StringConstraints(min_length=1, max_length=40)]
HumanoidHash = Annotated[
    str,
    StringConstraints(pattern=r"^[0-9a-f]{64}$"),
    Field(description="the hash of an uploaded model: 64 digits from 0 to 9 and a to f"),
]


class AxisFile(Strict):
    """The settings of one driven axis. Equal limits lock it."""

    kp_nm_per_rad: Annotated[float, Field(ge=0, le=1e6, description="spring, N m per radian")]
    kd_nm_s_per_rad: Annotated[float, Field(ge=0, le=1e6, description="damper, N m s per radian")]
    max_torque_nm: Annotated[float, Field(ge=0, le=1e6, description="greatest torque, N m")]
    low_deg: Angle
    high_deg: Angle


class ComplianceFile(Strict):
    """How a group of body parts gives way when it is pushed.

    `stiffness_percent`: of the configured stiffness; the group's weight is carried if it is less
    than 100. `targets`: parts of an arm or leg return to their joint angles, or to their own
    direction in the world.
    """

    stiffness_percent: Annotated[float, Field(ge=1, le=100, description="%")] = 100.0
    targets: LimbTargets = "joint"


class AvatarFile(Strict):
    """An avatar's configuration.

    `axes`: those of all body parts that the model has, as in LeftUpperLegX. `hips`: moved with the
    participant's hips, or welded to them. `target_space`: joints follow the participant's joint
    angles, or parts their orientation in the room. `colliders` applies to all parts except those in
    `part_colliders`. `locked_groups` are fixed at the angles of `held_deg`, or else those of the
    T-pose. `humanoid` is the hash of the model whose body it has, left out for a body built from
    the participant's measures; `mesh` colliders need one.
    `layers`: the pairs of collision layers that differ from the standard matrix. `delays_ms`: body
    part -> milliseconds by which it lags, in addition to the condition's latency.
    `relative_masses_percent`: body part -> its share of the total mass, if not the population's.
    `compliance`: group -> how it gives way when pushed; groups that are absent are stiff.
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
    layers: Annotated[list[LayerChange] | None, Field(max_length=len(SWITCHABLE_LAYERS))] = None
    delays_ms: Annotated[dict[Name, OwnDelay] | None, Field(max_length=len(PART_NAMES))] = None
    relative_masses_percent: Annotated[
        dict[Name, Percent] | None, Field(max_length=len(PART_NAMES))
    ] = None
    compliance: Annotated[
        dict[Name, ComplianceFile] | None, Field(max_length=len(COMPLIANT_GROUPS))
    ] = None
    # A name too many is told by the names; the limit only bounds the work of doing so.
    axes: Annotated[dict[Name, AxisFile], Field(min_length=1, max_length=2 * len(AXIS_NAMES))]


@dataclass(frozen=True)
class LoadedAvatar:
    """A configuration with the SHA-256 of its content, which is computed from `canonical_json`."""

    configuration: Configuration
    content_hash: str
    canonical_json: str


class JointsFile(BaseModel):
    """The joints of a file in the single template; its other keys are those of `AvatarFile`."""

    joints: Annotated[dict[DrivenPart, JointFile], Field(min_length=1, max_length=len(PART_NAMES))]


_ADAPTER = TypeAdapter(AvatarFile)
_JOINTS = TypeAdapter(JointsFile)


def load_avatar(text: str) -> LoadedAvatar:
    """Parse a configuration file; raise ConfigError with its problems, each with its place.

    A file in the single template is converted to the multiple one.
    """
    source = read_json(text)
    _require_readable(source)
    problems = list(source.problems)
    adapter: TypeAdapter[Any] = _ADAPTER
    try:
        tree: Any = source.tree
        if isinstance(tree, dict) and tree.get("format") == SINGLE_FORMAT:
            adapter = _JOINTS
            tree = _split_tree(tree, _JOINTS.validate_json(json.dumps(tree)).joints)
            adapter = _ADAPTER
        configuration = configuration_of(_ADAPTER.validate_json(json.dumps(tree)))
        check_pieces(configuration)
    except ValidationError as error:
        raise ConfigError([*problems, *explain(error, adapter.json_schema(), source)]) from error
    except AvatarSettingsError as error:
        raise ConfigError([*problems, *(_located(one, source) for one in error.problems)]) from None
    if problems:
        raise ConfigError(problems)
    return loaded(configuration)


def _require_readable(source: Source) -> None:
    """Raise ConfigError if a file is of another kind, or of another version of its format.

    Its other values mean something else, so only this problem is reported.
    """
    if not isinstance(source.tree, dict):
        message = "This is no avatar configuration: it has no keys."
        raise ConfigError([*source.problems, ConfigProblem("", 1, 1, message, remedy=_SAVE_ONE)])
    form, version = source.tree.get("format"), source.tree.get("version")
    if form not in FORMATS:
        named = "it does not name its format" if form is None else f"its format is {form!r}"
        found = DefinitionProblem(
            ("format",), f"This is no avatar configuration: {named}.", form, list(FORMATS),
            f"{did_you_mean(form, FORMATS)}{_SAVE_ONE}",
        )  # fmt: skip
        raise ConfigError([*source.problems, locate(found, source, at_key=form is None)])
    if isinstance(version, bool):
        found = DefinitionProblem(
            ("version",), "The version is a number.", version, VERSION, f"Set it to {VERSION}."
        )
        raise ConfigError([*source.problems, locate(found, source)])
    if isinstance(version, int) and version != VERSION:
        found = DefinitionProblem(
            ("version",),
            f"The file has version {version} of the format; this release reads version {VERSION}.",
            version,
            VERSION,
            "Update Reembody if the file was made by a newer release."
            if version > VERSION
            else f"Set it to {VERSION} if the file was made by hand.",
        )
        raise ConfigError([*source.problems, locate(found, source)])


def loaded(configuration: Configuration) -> LoadedAvatar:
    """Return a configuration with its canonical form and hash."""
    canonical = canonical_json(content_of(configuration))
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
    tree = content_of(configuration)
    return _with_rows(tree, "axes", tree.pop("axes"))


def single_text(configuration: Configuration) -> str:
    """Format the configuration as a file in the single template, with one joint per line.

    What the single template cannot hold is not in the file (`joined`).
    """
    tree = {**content_of(configuration), "format": SINGLE_FORMAT}
    tree.pop("axes")
    joints = {
        part: joint.model_dump(mode="json", exclude_none=True)
        for part, joint in joint_files(configuration).items()
    }
    return _with_rows(tree, "joints", joints)


def _with_rows(tree: dict[str, Any], name: str, values: dict[str, Any]) -> str:
    """Format a tree with one line for every value below its last key, `name`."""
    head = json.dumps(tree, indent=2, ensure_ascii=False)[: -len("\n}")]
    rows = ",\n".join(f"    {json.dumps(key)}: {json.dumps(one)}" for key, one in values.items())
    return f'{head},\n  "{name}": {{\n{rows}\n  }}\n}}\n'


def _split_tree(tree: dict[str, Any], joints: dict[str, JointFile]) -> dict[str, Any]:
    """Return a file of the single template as one of the multiple template, not validated yet.

    Raise AvatarSettingsError if it has axes as well, since only one of both can count.
    """
    axes = {
        name: _axis_file(settings).model_dump()
        for part, joint in joints.items()
        for name, settings in axes_of_joint(part, joint).items()
    }
    if "axes" in tree:
        raise AvatarSettingsError(
            (
                AvatarProblem(
                    "axes",
                    "A file of the single template has joints, and no axes.",
                    value="axes beside joints",
                    valid="one of them",
                    remedy="Remove 'axes', or remove 'joints' and set the format to that of axes.",
                ),
            )
        )
    kept = {key: value for key, value in tree.items() if key not in ("joints", "format")}
    return {**kept, "format": FORMAT, "axes": axes}


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
    problems += _repeated_layers(file.layers or ())
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
        colliding=_colliding(file.layers or ()),
        delays_s={part: one / 1e3 for part, one in (file.delays_ms or {}).items()},
        relative_masses={
            part: one / 1e2 for part, one in (file.relative_masses_percent or {}).items()
        },
        compliance={
            group: Compliance(one.stiffness_percent / 1e2, one.targets)
            for group, one in (file.compliance or {}).items()
        },
    )


def _colliding(layers: Iterable[LayerChange]) -> frozenset[frozenset[str]]:
    """Return the pairs of layers that collide."""
    colliding = set(COLLIDING)
    for pair in layers:
        (colliding.add if pair.collide else colliding.discard)(frozenset(pair.layers))
    return frozenset(colliding)


def _repeated_layers(layers: Iterable[LayerChange]) -> Iterator[AvatarProblem]:
    """Yield a problem for every pair of layers that is named again, or is one layer twice."""
    first: dict[frozenset[str], int] = {}
    for at, one in enumerate(layers):
        if same := same_layer_problem(one.layers):
            yield same.prefixed(f"layers[{at}]")
        before = first.setdefault(frozenset(one.layers), at)
        if before != at:
            yield AvatarProblem(
                f"layers[{at}].layers",
                f"The pair {' with '.join(one.layers)} is named already, by layers[{before}].",
                value=list(one.layers),
                valid="every pair of layers once",
                remedy="Keep the entry that is meant, and remove the other one.",
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
        layers=[
            LayerChange(layers=(first, second), collide=collide)
            for first, second, collide in layer_changes(configuration.colliding)
        ]
        or None,
        delays_ms={part: _shown(1e3 * one) for part, one in configuration.delays_s.items()} or None,
        relative_masses_percent={
            part: _shown(1e2 * one) for part, one in configuration.relative_masses.items()
        }
        or None,
        compliance={
            group: ComplianceFile(
                stiffness_percent=_shown(1e2 * one.stiffness), targets=one.targets
            )
            for group, one in configuration.compliance.items()
        }
        or None,
        axes={name: _axis_file(axis) for name, axis in configuration.axes.items()},
    )


def _axis_file(axis: AxisSettings) -> AxisFile:
    return AxisFile(
        kp_nm_per_rad=axis.kp,
        kd_nm_s_per_rad=axis.kd,
        max_torque_nm=axis.max_torque_nm,
        low_deg=degrees_of(axis.low_rad),
        high_deg=degrees_of(axis.high_rad),
    )


def _shown(value: float) -> float:
    """Return a value as it is written, without the rounding error of its unit's conversion."""
    return round(value, 9)


def check_pieces(configuration: Configuration) -> None:
    """Raise AvatarSettingsError for what only a new configuration is refused for.

    That is mesh colliders without a humanoid model, and delays of parts that have no axis.
    """
    problems = (*piece_problems(configuration), *idle_delay_problems(configuration))
    if problems:
        raise AvatarSettingsError(problems)


def content_of(configuration: Configuration) -> dict[str, Any]:
    """Return the content of the file as plain values.

    Optional values that are not set are left out, so that they do not affect the hash.
    """
    return file_of(configuration).model_dump(mode="json", exclude_none=True)


def _located(problem: AvatarProblem, source: Source) -> ConfigProblem:
    found = DefinitionProblem(
        _steps(problem.path), problem.message, problem.value, problem.valid, problem.remedy
    )
    return locate(found, source)


def _steps(path: str) -> Path:
    """Parse a path: `locked_groups[0]` is ("locked_groups", 0)."""
    return tuple(int(part) if part.isdigit() else part for part in re.findall(r"[^.\[\]]+", path))
