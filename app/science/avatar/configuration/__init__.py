"""The settings of an avatar: limits, gains, colliders and locks, axis by axis.

A `Configuration` is always consistent: invalid values are rejected with a list of all
`AvatarProblem`s. `lock`, `with_axis` and similar functions return an edited copy.
"""

from app.science.avatar.configuration.axis_settings import (
    MAX_TORQUE_NM,
    AvatarProblem,
    AvatarSettingsError,
    AxisSettings,
    degrees_of,
)
from app.science.avatar.configuration.configuration import (
    DEFAULT_MASS_KG,
    Configuration,
    Hips,
    TargetSpace,
    piece_problems,
)
from app.science.avatar.configuration.editing import lock, with_axis, with_global, without_parts
from app.science.avatar.configuration.groups import GROUP_NAMES, GROUPS, axes_of, parts_of
from app.science.avatar.configuration.limits import ANATOMIC, Preset, limits_of
from app.science.avatar.configuration.model_options import (
    DEFAULT_OPTIONS,
    FRICTION,
    HIPS_TARGET,
    LIMIT_SOLREF,
    SIMPLE,
    TIMESTEP_S,
    WALL_SOLIMP,
    WALL_SOLREF,
    WELD_SOLIMP,
    WELD_SOLREF,
    ColliderKind,
    Colliders,
    ModelOptions,
)
from app.science.avatar.configuration.running import RunningSettings, as_configured

__all__ = [
    "ANATOMIC",
    "DEFAULT_MASS_KG",
    "DEFAULT_OPTIONS",
    "FRICTION",
    "GROUPS",
    "GROUP_NAMES",
    "HIPS_TARGET",
    "LIMIT_SOLREF",
    "MAX_TORQUE_NM",
    "SIMPLE",
    "TIMESTEP_S",
    "WALL_SOLIMP",
    "WALL_SOLREF",
    "WELD_SOLIMP",
    "WELD_SOLREF",
    "AvatarProblem",
    "AvatarSettingsError",
    "AxisSettings",
    "ColliderKind",
    "Colliders",
    "Configuration",
    "Hips",
    "ModelOptions",
    "Preset",
    "RunningSettings",
    "TargetSpace",
    "as_configured",
    "axes_of",
    "degrees_of",
    "limits_of",
    "lock",
    "parts_of",
    "piece_problems",
    "with_axis",
    "with_global",
    "without_parts",
]
