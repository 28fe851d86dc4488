"""The data types that all of walking shares: tracks, walks, paths, parameters, protocols.

Every instance is valid; invalid arguments raise `WalkingError`. Metres, seconds, radians.
"""

from app.science.walking.records.dependencies import Scaling, dependency_vectors, scaling_of
from app.science.walking.records.further import (
    MOST_FURTHER,
    NAME_PATTERN,
    check_name,
    check_names,
    check_varies,
    further_of,
    is_name,
    known_for,
)
from app.science.walking.records.model import (
    LENGTH,
    STATURE,
    TURNING,
    Kind,
    PlannedPath,
    PlannedWalk,
    Track,
    Walk,
    WalkingError,
    arc_of,
    check_stature,
)
from app.science.walking.records.parameters import (
    PAPER_GRID,
    PAPER_PARAMETERS,
    ParameterGrid,
    SteeringParameter,
    regular_grid,
)
from app.science.walking.records.protocols import (
    BoolArray,
    Course,
    Metric,
    PathFollower,
    Planner,
    Point,
    Reference,
    Trajectories,
    reference_of,
)

__all__ = [
    "LENGTH",
    "MOST_FURTHER",
    "NAME_PATTERN",
    "PAPER_GRID",
    "PAPER_PARAMETERS",
    "STATURE",
    "TURNING",
    "BoolArray",
    "Course",
    "Kind",
    "Metric",
    "ParameterGrid",
    "PathFollower",
    "PlannedPath",
    "PlannedWalk",
    "Planner",
    "Point",
    "Reference",
    "Scaling",
    "SteeringParameter",
    "Track",
    "Trajectories",
    "Walk",
    "WalkingError",
    "arc_of",
    "check_name",
    "check_names",
    "check_stature",
    "check_varies",
    "dependency_vectors",
    "further_of",
    "is_name",
    "known_for",
    "reference_of",
    "regular_grid",
    "scaling_of",
]
