"""How much movement is not on disk yet, live."""

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from app.features.record.alarms.alarm import Condition, WatchLimits
from app.wire import Produced, StreamName, StreamPosition


@dataclass
class BacklogWatch:
    """What the client has made against what is stored, for all of its runs.

    `frames_per_s` is how many frames the client makes in a real second. Frames that were received
    are waited for, too: if nothing is acknowledged for long, the disk is the reason.
    """

    limits: WatchLimits
    frames_per_s: float = 90.0
    _made: dict[tuple[str, int], int] = field(default_factory=lambda: defaultdict(int))
    _stored: dict[tuple[str, int], int] = field(default_factory=lambda: defaultdict(int))
    _waiting_since_s: float | None = None

    def stored(self, positions: Iterable[StreamPosition]) -> None:
        """So much is on disk."""
        for position in positions:
            self._stored[position.stream, position.epoch] = position.next_seq

    def produced(self, message: Produced) -> None:
        """The client has made so much."""
        for stream, count in message.streams.items():
            # The newest counts: a wrong one would else keep the alarm up for ever.
            self._made[stream, message.epoch] = count

    def handed_over(self, now_s: float) -> None:
        """A message waits for the disk."""
        if self._waiting_since_s is None:
            self._waiting_since_s = now_s

    def answered(self, now_s: float, *, waiting: bool) -> None:
        """Some are on disk; are others still waiting?"""
        self._waiting_since_s = now_s if waiting else None

    def behind_s(self, now_s: float) -> float:
        """Seconds of movement that would be lost if headset and server broke now."""
        behind: dict[str, int] = defaultdict(int)
        for (stream, epoch), made in self._made.items():
            behind[stream] += max(0, made - self._stored[stream, epoch])
        frames = max((behind[stream] for stream in StreamName), default=0)
        waiting_s = 0.0 if self._waiting_since_s is None else now_s - self._waiting_since_s
        return max(frames / self.frames_per_s, waiting_s)

    def look(self, now_s: float) -> Iterator[Condition]:
        """What is wrong with storing now."""
        behind_s = self.behind_s(now_s)
        if behind_s > self.limits.backlog_s:
            yield Condition(
                "backlog",
                f"{behind_s:.0f} s of movement are not on the server's disk yet",
                value=round(behind_s, 1),
                unit="s",
            )
