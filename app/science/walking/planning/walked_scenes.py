"""Plan each walk in the scene in which it was walked.

The same people may be recorded in several set-ups: on the open floor, around a pole, between racks.
The path of a walk is planned in its own scene, so that a model learns from all of them together.
"""

from collections import Counter
from collections.abc import Iterable, Mapping

from app.science.walking.planning.grid_planner import LazyThetaPlanner
from app.science.walking.records import OPEN_FLOOR, Planner, Walk, WalkingError
from app.science.walking.scene import Scene, open_scene


class WalkedScenes:
    """The scenes of some walks, with a planner of each that is made when it is first needed."""

    def __init__(self, scenes: Mapping[str, Scene], usual: str | None = None) -> None:
        """Take scenes by name; `usual` is that of walks which name none, None for the open floor.

        Raises:
            WalkingError: `usual` is none of the scenes.
        """
        self._scenes = scenes
        self._planners: dict[str, LazyThetaPlanner] = {}
        self._usual = usual
        if usual is not None:
            self._known(usual)

    def scene_of(self, walk: Walk) -> str | None:
        """Return the name of a walk's scene, None for the open floor; raise WalkingError."""
        name = walk.scene or self._usual
        return None if name is None or name == OPEN_FLOOR else self._known(name)

    def planner_of(self, walk: Walk) -> Planner:
        """Return the planner of a walk's scene; raise WalkingError for an unknown scene."""
        name = self.scene_of(walk)
        if name is None:
            return LazyThetaPlanner(open_scene(walk.start_m, walk.goal_m))
        if name not in self._planners:
            self._planners[name] = LazyThetaPlanner(self._scenes[name])
        return self._planners[name]

    def counts(self, walks: Iterable[Walk]) -> list[tuple[str | None, int]]:
        """Return how many walks are in which scene, the most frequent first; None: open floor."""
        return Counter(self.scene_of(walk) for walk in walks).most_common()

    def _known(self, name: str) -> str:
        if name not in self._scenes:
            known = ", ".join(sorted(self._scenes)) or "none"
            raise WalkingError(
                f"There is no scene {name!r}: scenes are {known}, and {OPEN_FLOOR!r} is the floor"
                " without obstacles."
            )
        return name
