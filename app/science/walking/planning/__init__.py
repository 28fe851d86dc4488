"""Short paths around obstacles.

`LazyThetaPlanner` plans in a `Scene`; `sees` says whether a straight line is free. The compiler is
loaded at the first question.
"""

from app.science.walking.planning.grid_planner import LazyThetaPlanner
from app.science.walking.planning.shortest import sees

__all__ = [
    "LazyThetaPlanner",
    "sees",
]
