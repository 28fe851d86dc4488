"""Noticing that a headset says nothing though its socket is open: taken off, asleep, cut off."""

from collections.abc import Iterator
from dataclasses import dataclass

from app.features.record.alarms.alarm import Condition, WatchLimits

QUIET_S = 2.0
LATE_S = 1.0
"""A look that comes so much too late tells of the server's own pause, not of the headset's."""


@dataclass
class SilenceWatch:
    """Since when no frame has come while frames were wanted, in the server's monotonic seconds.

    `unheard_until_s`: until then frames may have come without being read: before the socket opened,
    before they were wanted, while the server itself stood still or had stopped reading.
    """

    limits: WatchLimits
    unheard_until_s: float
    recording: bool = False
    _running: bool = False
    _heard_s: float = float("-inf")
    _looked_s: float | None = None
    _lost_told_s: float = float("-inf")

    def follow(self, now_s: float, *, recording: bool, running: bool) -> None:
        """Frames are wanted, or not; a phase's clock runs, or not."""
        if recording and not self.recording:
            self.unheard_until_s = now_s
        self.recording, self._running = recording, running

    def heard(self, now_s: float) -> None:
        """A frame has come, here or on another socket of this session."""
        self._heard_s = max(self._heard_s, now_s)

    def is_quiet(self, now_s: float) -> bool:
        """Whether frames have ceased for a moment, wanted or not: figures of before are old."""
        return now_s - self._heard_s > QUIET_S

    def look_up(self, now_s: float, *, reading: bool) -> None:
        """Note that the server is awake, and whether it reads."""
        looked_s, self._looked_s = self._looked_s, now_s
        slept = looked_s is not None and now_s - looked_s > self.limits.look_every_s + LATE_S
        if slept or not reading:
            self.unheard_until_s = now_s

    def silent_s(self, now_s: float) -> float:
        """For how long nothing has come that should have; 0 while it is tolerable."""
        silent_s = now_s - max(self._heard_s, self.unheard_until_s)
        return silent_s if self.recording and silent_s >= self.limits.silent_s else 0.0

    def look(self, now_s: float) -> Iterator[Condition]:
        """What is wrong now."""
        silent_s = self.silent_s(now_s)
        if silent_s > 0.0:
            yield Condition(
                "silent",
                f"The headset is connected but has sent no movement for {silent_s:.0f} s",
                value=round(silent_s, 1),
                unit="s",
            )

    def phase_is_lost(self, now_s: float) -> bool:
        """Whether a running phase must be stopped now; said again only after another silence."""
        silent_s = self.silent_s(now_s)
        if silent_s == 0.0 or not self._running:
            return False
        if now_s - self._lost_told_s < self.limits.silent_s:
            return False
        self._lost_told_s = now_s
        return True
