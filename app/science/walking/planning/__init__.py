"""Plan short paths around obstacles.

`LazyThetaPlanner` plans in a `Scene`, `WalkedScenes` each walk in its own; `sees` returns whether a
straight line is free. The compiler is loaded with the first call.
"""

from app.science.walking.planning.grid_planner import LazyThetaPlanner
from app.science.walking.planning.shortest import sees
from app.science.walking.planning.walked_scenes import WalkedScenes

__all__ = [
    "LazyThetaPlanner",
    "WalkedScenes",
    "sees",
]
