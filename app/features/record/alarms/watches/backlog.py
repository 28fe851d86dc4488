"""Monitor how much movement is not on the server's disk yet."""

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from app.features.record.alarms.alarm import Condition, WatchLimits
from app.wire import Produced, StreamName, StreamPosition


@dataclass
class BacklogWatch:
    """Compares what the client has produced with what is stored, over all of its epochs.

    `frames_per_s` is how many frames the client produces per real second. Received frames count as
    unstored until they are acknowledged: if that takes long, the disk is the cause.
    """

    limits: WatchLimits
    frames_per_s: float = 90.0
    _made: dict[tuple[str, int], int] = field(default_factory=lambda: defaultdict(int))
    _stored: dict[tuple[str, int], int] = field(default_factory=lambda: defaultdict(int))
    _waiting_since_s: float | None = None

    def stored(self, positions: Iterable[StreamPosition]) -> None:
        """Record the positions up to which the streams are on disk."""
        for position in positions:
            self._stored[position.stream, position.epoch] = position.next_seq

    def produced(self, message: Produced) -> None:
        """Record how many frames the client says it has produced."""
        for stream, count in message.streams.items():
            # Use the latest count, not the maximum: a wrong one would keep the alarm open for ever.
            self._made[stream, message.epoch] = count

    def submitted(self, now_s: float) -> None:
        """Record that a message was submitted and waits to be written to disk."""
        if self._waiting_since_s is None:
            self._waiting_since_s = now_s

    def acknowledged(self, now_s: float, *, waiting: bool) -> None:
        """Record that messages were stored; `waiting` says whether others still wait."""
        self._waiting_since_s = now_s if waiting else None

    def lag_s(self, now_s: float) -> float:
        """Return how many seconds of movement would be lost if headset and server failed now."""
        unstored: dict[str, int] = defaultdict(int)
        for (stream, epoch), made in self._made.items():
            unstored[stream] += max(0, made - self._stored[stream, epoch])
        frames = max((unstored[stream] for stream in StreamName), default=0)
        waiting_s = 0.0 if self._waiting_since_s is None else now_s - self._waiting_since_s
        return max(frames / self.frames_per_s, waiting_s)

    def check(self, now_s: float) -> Iterator[Condition]:
        """Yield a condition if too much movement is unstored."""
        lag_s = self.lag_s(now_s)
        if lag_s > self.limits.backlog_s:
            yield Condition(
                "backlog",
                f"{lag_s:.0f} s of movement are not on the server's disk yet",
                value=round(lag_s, 1),
                unit="s",
            )
