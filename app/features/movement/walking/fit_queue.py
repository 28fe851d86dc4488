"""Fit models of walking one after the other, in a worker process that can be stopped.

Each fit has a folder next to the database for its finished maps. Stopping kills the process, and
resuming continues after the last finished map, even after a restart of the server. Only complete
models are stored in the database.
"""

import hashlib
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Self

from sqlalchemy.orm import Session

from app.errors import as_sentences
from app.features.movement.files import compress, store
from app.features.movement.walking.progress import FitFolder, Progress
from app.features.movement.walking.sources import Cannot, FitOrder, Store
from app.features.movement.walking.worker_tasks import fit_model
from app.models import WalkingModelRow
from app.platform.context import AppContext
from app.platform.resumable_jobs import ResumableJobs
from app.platform.workers import Worker


def new_worker() -> Worker:
    """Create a worker process for one fit, which can be ended separately."""
    return Worker()


@dataclass(eq=False)
class FitQueue(ResumableJobs[FitOrder]):
    """The queue of a server's fits."""

    row: ClassVar[type[Any]] = WalkingModelRow
    running: ClassVar[str] = "fitting"
    queue_name: ClassVar[str] = "walking-fits"
    broke: ClassVar[str] = (
        "the process that fitted it ended: resume it, and if that fails, too, see the server's log"
    )
    unstorable: ClassVar[str] = "it could not be stored: see the server's log, then resume it"

    url: str = ""

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the fitting queue of a server, with its files in the data folder."""
        settings = context.settings
        return cls(
            settings.data_dir.resolve() / "walking",
            context.database,
            context.clock,
            context.background,
            url=settings.resolved_database_url,
        )

    def progress(self, model_id: str) -> Progress | None:
        """Return the progress of a running or stopped fit, None if it has no files."""
        place = self.place_of(model_id)
        files = FitFolder(self.folder_of(model_id))
        if place == "waiting":
            stored = files.progress()
            return Progress("waiting", stored.maps, stored.maps_total)
        progress = files.progress() if files.folder.is_dir() else None
        if place is not None and progress is not None and progress.stage == "waiting":
            return Progress("walks")  # its process is starting
        return progress

    def _new_worker(self) -> Worker:
        return new_worker()

    def _submit(self, worker: Worker, order: FitOrder, folder: Path) -> "Future[dict[str, Any]]":
        return worker.submit(fit_model, Store(self.url), order, folder)

    def _refusal(self, error: Exception) -> str | None:
        return as_sentences(error.reason, error.remedy) if isinstance(error, Cannot) else None

    def _keeping(
        self, folder: Path, summary: dict[str, Any]
    ) -> Callable[[Session], dict[str, Any]]:
        del summary
        file = FitFolder(folder).model
        with file.open("rb") as stream:
            content_hash: str = hashlib.file_digest(stream, "sha256").hexdigest()
        compressed, size = file.with_name("compressed"), file.stat().st_size
        compress(file, compressed)

        def keep(db: Session) -> dict[str, Any]:
            store(db, content_hash, size, compressed)
            return {"content_hash": content_hash}

        return keep
