"""Compute the movement of replays, one phase at a time, so that running sessions are not delayed.

Computing a phase of a minute takes a few tenths of a second, most of it in libraries that let other
threads run meanwhile. A worker process would take a second longer to start.
"""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Self

from app.database import Database
from app.platform.context import AppContext, Part


@dataclass
class ReplayQueue(Part):
    """Computes the movement of one phase after the other, in a thread."""

    database: Database
    _pool: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="replays")
    )

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the replay queue of a server."""
        return cls(context.database)

    def movement(
        self, session_id: str, phase_id: int, *, full: bool, rotations: bool = False
    ) -> bytes:
        """Return the movement of a phase as bytes (`app.features.results.replay.movement`)."""
        # Imported here because it loads scientific libraries, which would slow down the start.
        from app.features.results.replay.movement import placed_movement

        placing = self._pool.submit(
            placed_movement, self.database, session_id, phase_id, full=full, rotations=rotations
        )
        return placing.result()

    def stop(self) -> None:
        """Finish the phase in progress and cancel those that wait."""
        self._pool.shutdown(wait=True, cancel_futures=True)
