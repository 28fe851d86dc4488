"""Run tunings one after the other, each in a process that can be stopped and resumed.

What a tuning has measured is kept in its folder (`folder`); a server that starts marks tunings that
it finds unfinished as stopped, and resuming goes on from there.
"""

from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Self

from app.features.movement.tuning.folder import TuningFolder
from app.features.movement.tuning.order import CannotTune, TuningOrder
from app.features.movement.tuning.worker_tasks import run_tuning
from app.models import AvatarTuningRow
from app.platform.context import AppContext
from app.platform.resumable_jobs import ResumableJobs
from app.platform.workers import Worker


def new_worker() -> Worker:
    """Create a worker process for one tuning, which can be ended separately."""
    return Worker()


@dataclass(eq=False)
class TuningQueue(ResumableJobs[TuningOrder]):
    """The queue of a server's tunings."""

    row: ClassVar[type[Any]] = AvatarTuningRow
    running: ClassVar[str] = "tuning"
    queue_name: ClassVar[str] = "avatar-tunings"
    broke: ClassVar[str] = (
        "the process that tuned it ended: resume it, and if that fails, too, see the server's log"
    )
    unstorable: ClassVar[str] = "it could not be stored: see the server's log, then resume it"

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the queue of a server, with its files in the data folder."""
        folder = context.settings.data_dir.resolve() / "tunings"
        return cls(folder, context.database, context.clock, context.background)

    def files(self, tuning_id: str) -> TuningFolder:
        """Return the folder of an unfinished tuning."""
        return TuningFolder(self.folder_of(tuning_id))

    def _new_worker(self) -> Worker:
        return new_worker()

    def _submit(self, worker: Worker, order: TuningOrder, folder: Path) -> "Future[dict[str, Any]]":
        return worker.submit(run_tuning, order, folder)

    def _refusal(self, error: Exception) -> str | None:
        return str(error) if isinstance(error, CannotTune) else None
