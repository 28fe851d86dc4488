"""The scripted headset's monotonic clock: the one its frames, its reports and its probes show."""

import time
from dataclasses import dataclass, field

from app.rehearsal.body import FRAME_RATE_HZ


@dataclass
class FrameClock:
    """Goes `speed` seconds a second, and never beyond the frame that was drawn last.

    So a machine that is too slow for the speed has a slower clock, as a headset that drops frames
    has not: only a rehearsal faster than life can come to that.
    """

    speed: float
    frame: int = 0
    _started_s: float = field(default_factory=time.monotonic)

    def start(self) -> None:
        """The first frame is due now."""
        self._started_s = time.monotonic()

    @property
    def t_s(self) -> float:
        """The time of the present frame."""
        return self.frame / FRAME_RATE_HZ

    def now_s(self) -> float:
        """The time at any moment, also between two frames."""
        return min(self.t_s, (time.monotonic() - self._started_s) * self.speed)

    @property
    def due_in_s(self) -> float:
        """How many real seconds until the next frame; not above zero where it is late."""
        return self._started_s + self.t_s / self.speed - time.monotonic()
