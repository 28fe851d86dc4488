"""The road as a headset knows it: where it lies in the room, and how high its ground is.

The headset's page has the same rule (`frontend/src/vr/road/ground.ts`); the vectors in
`tests/vectors/road` hold both to it. The lab's floor is flat, so nobody is lifted: the street sinks
and rises under the participant, by the height of the ground below the hips, and each foot is set on
the ground where it is. That is the moving ground of Degen et al. (2022), seen from the body.
"""

from dataclasses import dataclass
from typing import Any, Final

ACROSS_M: Final = 0.3
"""Somebody who is this far behind the other kerb is across."""
HIPS_REACH_M: Final = 0.35
"""Over this far before and behind a kerb's edge the street sinks with the hips."""
FOOT_REACH_M: Final = 0.12
"""And so far a foot is led over it, so that neither heel nor toes stick in it."""


@dataclass(frozen=True)
class RoadShape:
    """What a headset knows of the road: from the start square to the kerb, and across.

    Attributes:
        lane_width_m: of each of two lanes.
        starts_behind_kerb_m: from the middle of the start square to the near kerb.
        step_s: of the scene.
        kerb_height_m: how far the carriageway lies below the pavement.
    """

    lane_width_m: float
    starts_behind_kerb_m: float
    step_s: float
    kerb_height_m: float

    @classmethod
    def of(cls, road: dict[str, Any]) -> "RoadShape":
        """Return the shape from a welcome's `road` (docs/protocol.md)."""
        lane_width_m = road["road"]["lane_width_m"]
        own = (road["starts_behind_kerb_m"], road["step_s"], road["kerb_height_m"])
        return cls(lane_width_m, *own)

    def y_m(self, z_m: float) -> float:
        """Return where somebody in the room is across the road."""
        return -z_m - self.lane_width_m - self.starts_behind_kerb_m

    def z_m(self, y_m: float) -> float:
        """Return where a place across the road is in the room."""
        return -y_m - self.lane_width_m - self.starts_behind_kerb_m

    def side(self, y_m: float) -> int:
        """Return -1 on the near side, 1 on the other, 0 in between."""
        if abs(y_m) < self.lane_width_m + ACROSS_M:
            return 0
        return 1 if y_m > 0.0 else -1

    def height_m(self, z_m: float, reach_m: float) -> float:
        """Return the ground's height above the carriageway, led softly over the kerbs' edges."""
        on_pavement_m = abs(self.y_m(z_m)) - self.lane_width_m
        share = min(1.0, max(0.0, on_pavement_m / (2.0 * reach_m) + 0.5))
        return self.kerb_height_m * share * share * (3.0 - 2.0 * share)

    def sunk_m(self, hips_z_m: float) -> float:
        """Return how far the street has sunk under somebody whose hips are there."""
        return self.height_m(hips_z_m, HIPS_REACH_M)

    def lift_m(self, ankle_m: tuple[float, float], hips_m: tuple[float, float]) -> float:
        """Return how far a foot is set above the lab's floor; see `simulation.Footing`."""
        return self.height_m(ankle_m[1], FOOT_REACH_M) - self.sunk_m(hips_m[1])
