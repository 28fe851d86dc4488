"""The ground under a simulated participant's feet where the floor that they walk on is flat."""

from typing import Protocol


class Footing(Protocol):
    """Protocol of a ground that is shown to somebody on a flat floor, such as a road with kerbs.

    Nobody is lifted by what is only seen: hips, head and hands stay where they are, and each foot
    is set on the ground that is seen there. Metres; places are (x, z).
    """

    def lift_m(self, ankle_m: tuple[float, float], hips_m: tuple[float, float]) -> float:
        """Return how far the foot with its ankle there is set above the flat floor."""
