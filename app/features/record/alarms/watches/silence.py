"""Detect that a connected headset sends nothing: taken off, asleep, or cut off."""

from collections.abc import Iterator
from dataclasses import dataclass

from app.features.record.alarms.alarm import Condition, WatchLimits

QUIET_S = 2.0
LATE_S = 1.0
"""A check that is this much overdue means that the server was suspended, not the headset."""


@dataclass
class SilenceWatch:
    """Measures how long expected frames have been missing, on the server's monotonic clock.

    `unread_until_s`: until then frames may have arrived without being read: before the socket
    opened, before frames were expected, or while the server itself was suspended or had stopped
    reading.
    """

    limits: WatchLimits
    unread_until_s: float
    recording: bool = False
    _running: bool = False
    _last_frame_s: float = float("-inf")
    _checked_s: float | None = None
    _loss_reported_s: float = float("-inf")

    def set_expected(self, now_s: float, *, recording: bool, running: bool) -> None:
        """Set whether frames are expected, and whether a phase's clock is running."""
        if recording and not self.recording:
            self.unread_until_s = now_s
        self.recording, self._running = recording, running

    def frame_arrived(self, now_s: float) -> None:
        """Record that a frame has arrived, on this or another socket of the session."""
        self._last_frame_s = max(self._last_frame_s, now_s)

    def is_quiet(self, now_s: float) -> bool:
        """Return whether no frame has arrived recently, so that earlier figures are out of date."""
        return now_s - self._last_frame_s > QUIET_S

    def note_check(self, now_s: float, *, reading: bool) -> None:
        """Record that the server is running, and whether it is reading from the socket."""
        checked_s, self._checked_s = self._checked_s, now_s
        slept = checked_s is not None and now_s - checked_s > self.limits.check_every_s + LATE_S
        if slept or not reading:
            self.unread_until_s = now_s

    def silent_s(self, now_s: float) -> float:
        """Return how long expected frames have been missing; 0 within the tolerated time."""
        silent_s = now_s - max(self._last_frame_s, self.unread_until_s)
        return silent_s if self.recording and silent_s >= self.limits.silent_s else 0.0

    def check(self, now_s: float, *, is_worn: bool = True) -> Iterator[Condition]:
        """Yield a condition if the headset, or the page on a screen, was silent for too long."""
        silent_s = self.silent_s(now_s)
        if silent_s > 0.0:
            sender = "headset" if is_worn else "page"
            yield Condition(
                "silent" if is_worn else "page_silent",
                f"The {sender} is connected but has sent no movement for {silent_s:.0f} s",
                value=round(silent_s, 1),
                unit="s",
            )

    def phase_is_lost(self, now_s: float) -> bool:
        """Return whether a running phase must be paused now for lack of frames.

        After True it returns False for the next `silent_s` seconds.
        """
        silent_s = self.silent_s(now_s)
        if silent_s == 0.0 or not self._running:
            return False
        if now_s - self._loss_reported_s < self.limits.silent_s:
            return False
        self._loss_reported_s = now_s
        return True
