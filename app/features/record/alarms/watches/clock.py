"""Monitor how accurately the headset's clock is known during a session.

The mapping between the clocks is computed later, in the analysis.
"""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

from app.features.record.alarms.alarm import Condition, WatchLimits
from app.wire import Probed

NANO = 1e-9


@dataclass
class ClockWatch:
    """Round-trip times of the last minute. `time_scale` client seconds pass per real second."""

    limits: WatchLimits
    time_scale: float
    usable_s: float
    _trips: deque[tuple[float, float]] = field(default_factory=deque)

    def probed(self, reading: Probed, now_s: float) -> None:
        """Record a clock probe; one that is unanswered or has a negative round trip is ignored."""
        trip_s = self._round_trip_s(reading)
        if trip_s is not None and trip_s >= 0.0:
            self.usable_s = now_s
            self._trips.append((now_s, trip_s))

    def _round_trip_s(self, reading: Probed) -> float | None:
        """Return a probe's network time there and back, in real seconds; None if unanswered."""
        received_s = reading.client_received_s
        if received_s is None or reading.server_received_ns is None:
            return None
        if reading.server_sent_ns is None:
            return None
        held_s = (reading.server_sent_ns - reading.server_received_ns) * NANO
        return (received_s - reading.client_sent_s) / self.time_scale - held_s

    def uncertainty_s(self, now_s: float) -> float | None:
        """Return the greatest possible error of the clock offset, or None if it is unknown.

        This is half of the smallest round trip.
        """
        while self._trips and now_s - self._trips[0][0] > self.limits.clock_window_s:
            self._trips.popleft()
        return 0.5 * min(trip_s for _, trip_s in self._trips) if self._trips else None

    def check(self, now_s: float) -> Iterator[Condition]:
        """Yield a condition if the headset's clock is unknown or not known accurately enough."""
        waited_s = now_s - self.usable_s
        uncertainty_s = self.uncertainty_s(now_s)
        if waited_s > self.limits.clock_unknown_s:
            yield Condition(
                "clock_unknown",
                f"No usable reading of the headset's clock for {waited_s:.0f} s",
                value=round(waited_s, 1),
                unit="s",
            )
        elif uncertainty_s is not None and uncertainty_s > self.limits.clock_uncertain_s:
            yield Condition(
                "clock_uncertain",
                f"The headset's clock is known only to ±{1000 * uncertainty_s:.0f} ms",
                value=round(1000.0 * uncertainty_s, 1),
                unit="ms",
            )
