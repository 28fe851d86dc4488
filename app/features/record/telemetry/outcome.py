"""What the writer tells a sender about its messages."""

from dataclasses import dataclass, field

from app.features.record.telemetry.positions import Position
from app.wire.messages import Message, StreamPosition


@dataclass
class Outcome:
    """What to tell the sender once the transaction is on disk; `messages` were stored for it,
    `frames_flagged` frames among them hold something broken.
    """

    positions: dict[tuple[str, int], StreamPosition] = field(default_factory=dict)
    notices: list[Message] = field(default_factory=list)
    phases_ended: list[int] = field(default_factory=list)
    messages: int = 0
    frames_flagged: int = 0

    def stored_up_to(self, position: Position) -> None:
        """Acknowledge a stream as far as it stands now."""
        _, stream, epoch = position.key
        self.positions[stream, epoch] = position.as_told
