"""Where movement is placed: one phase at a time, so that running sessions go on beside it.

Placing a phase of a minute takes a few tenths of a second, most of it in libraries that let other
threads compute meanwhile. In a process of its own it would begin a second later.
"""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Self

from app.database import Database
from app.platform.context import AppContext, Part


@dataclass
class ReplayDesk(Part):
    """Places the movement of one phase after the other."""

    database: Database
    _pool: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="replays")
    )

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """The replays of a server's sessions."""
        return cls(context.database)

    def movement(self, session_id: str, phase_id: int, *, full: bool) -> bytes:
        """The bytes of `app.features.results.replay.movement`; waits for them."""
        # Loads the science, which the start of the server need not wait for.
        from app.features.results.replay.movement import placed_movement

        placing = self._pool.submit(placed_movement, self.database, session_id, phase_id, full=full)
        return placing.result()

    def stop(self) -> None:
        """Finish the phase under way; whoever waits for another is refused."""
        self._pool.shutdown(wait=True, cancel_futures=True)
