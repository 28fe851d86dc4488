"""How well the headset's clock is known, live; the mapping itself is made at analysis."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

from app.features.record.alarms.alarm import Condition, WatchLimits
from app.wire import Probed

NANO = 1e-9


@dataclass
class ClockWatch:
    """Round trips of the last minute. `time_scale` seconds of the client pass in a real one."""

    limits: WatchLimits
    time_scale: float
    usable_s: float
    _trips: deque[tuple[float, float]] = field(default_factory=deque)

    def probed(self, reading: Probed, now_s: float) -> None:
        """Take one exchange; one that was not answered, or cannot be, says nothing."""
        trip_s = self._round_trip_s(reading)
        if trip_s is not None and trip_s >= 0.0:
            self.usable_s = now_s
            self._trips.append((now_s, trip_s))

    def _round_trip_s(self, reading: Probed) -> float | None:
        """Time on the way there and back, in real seconds."""
        received_s = reading.client_received_s
        if received_s is None or reading.server_received_ns is None:
            return None
        if reading.server_sent_ns is None:
            return None
        held_s = (reading.server_sent_ns - reading.server_received_ns) * NANO
        return (received_s - reading.client_sent_s) / self.time_scale - held_s

    def uncertainty_s(self, now_s: float) -> float | None:
        """Half of the smallest round trip: the offset cannot be off by more. None if unknown."""
        while self._trips and now_s - self._trips[0][0] > self.limits.clock_window_s:
            self._trips.popleft()
        return 0.5 * min(trip_s for _, trip_s in self._trips) if self._trips else None

    def look(self, now_s: float) -> Iterator[Condition]:
        """What is wrong with the clock now."""
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
                f"The headset's clock is known to ±{1000 * uncertainty_s:.0f} ms only",
                value=round(1000.0 * uncertainty_s, 1),
                unit="ms",
            )
