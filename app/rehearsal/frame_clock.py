"""The clock by which a scripted headset draws its frames, in real time or faster."""

import time
from dataclasses import dataclass, field
from typing import Final

from app.simulated_people.body import FRAME_RATE_HZ

LATE_S: Final = 0.2
"""How late a frame may be, in the headset's time, and still be caught up on."""


@dataclass
class FrameClock:
    """A clock that runs at `speed` seconds per second, but never beyond the last drawn frame.

    So if a machine is too slow for the speed, its clock is slower, unlike that of a headset, which
    drops frames: this can only happen in a rehearsal faster than real time. The clock does not
    catch up on the time it has lost: it would run faster than `speed` meanwhile, and the server
    would find more active time reported than has passed.
    """

    speed: float
    frame: int = 0
    lost_s: float = 0.0
    _started_s: float = field(default_factory=time.monotonic)

    def start(self) -> None:
        """Start the clock: the first frame is due now."""
        self._started_s = time.monotonic()

    @property
    def t_s(self) -> float:
        """The time of the current frame."""
        return self.frame / FRAME_RATE_HZ

    @property
    def speed_reached(self) -> float:
        """The speed so far, which is below `speed` where the machine was too slow for it."""
        return self.t_s / (self.t_s / self.speed + self.lost_s) if self.frame else self.speed

    def now_s(self) -> float:
        """Return the current time, which may be between two frames."""
        return min(self.t_s, (time.monotonic() - self._started_s) * self.speed)

    def wait_s(self) -> float:
        """Return the real seconds until the next frame is due; 0 if it is late.

        Faster than real time, a delay of more than `LATE_S` is lost.
        """
        due_in_s = self._started_s + self.t_s / self.speed - time.monotonic()
        if self.speed > 1.0 and -due_in_s * self.speed > LATE_S:
            self._started_s -= due_in_s
            self.lost_s -= due_in_s
        return max(0.0, due_in_s)
