"""Plan short paths around obstacles.

`LazyThetaPlanner` plans in a `Scene`; `sees` returns whether a straight line is free. The compiler
is loaded with the first call.
"""

from app.science.walking.planning.grid_planner import LazyThetaPlanner
from app.science.walking.planning.shortest import sees

__all__ = [
    "LazyThetaPlanner",
    "sees",
]
