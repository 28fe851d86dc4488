"""Fit models of walking one after the other, in a worker process that can be stopped.

Each fit has a folder next to the database for its finished maps. Stopping kills the process, and
resuming continues after the last finished map, even after a restart of the server. Only complete
models are stored in the database.
"""

import hashlib
import logging
import shutil
import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from app.clock import Clock
from app.database import Database
from app.errors import as_sentences
from app.features.movement.files import compress, store
from app.features.movement.walking.progress import FitFolder, Progress
from app.features.movement.walking.sources import Cannot, FitOrder, Store
from app.features.movement.walking.worker_tasks import fit_model
from app.models import WalkingModelRow
from app.platform.background import Background
from app.platform.context import AppContext, Part
from app.platform.workers import Worker

log = logging.getLogger(__name__)
QUEUE = "walking-fits"
BROKE = "the process that fitted it ended: resume it, and if that fails, too, see the server's log"


def new_worker() -> Worker:
    """Create a worker process for one fit, which can be ended separately."""
    return Worker()


@dataclass(eq=False)
class _Fit:
    model_id: str
    order: FitOrder
    files: FitFolder
    worker: Worker = field(default_factory=lambda: new_worker())
    cancelled: bool = False
    started_making: bool = False


@dataclass(eq=False)
class FitQueue(Part):
    """The queue of a server's fits, with the thread that runs them; thread-safe."""

    folder: Path
    url: str
    database: Database
    clock: Clock
    background: Background
    _fits: dict[str, _Fit] = field(default_factory=dict)
    _lock: threading.RLock = field(default_factory=threading.RLock)
    _maker: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="fits")
    )

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the fitting queue of a server, with its files in the data folder."""
        settings = context.settings
        return cls(
            settings.data_dir.resolve() / "walking",
            settings.resolved_database_url,
            context.database,
            context.clock,
            context.background,
        )

    def start(self) -> None:
        """Mark fits that an earlier run of the server left as stopped; their maps are kept."""
        with self.database.reading() as db:
            fitting = select(WalkingModelRow.id).where(WalkingModelRow.state == "fitting")
            left = db.scalars(fitting).all()
        if left:
            with self.database.writing() as db:
                db.execute(
                    update(WalkingModelRow)
                    .where(WalkingModelRow.id.in_(left))
                    .values(state="stopped")
                )

    def stop(self) -> None:
        """Stop all fits; their finished maps are kept."""
        with self._lock:
            fits = list(self._fits.values())
        for fit in fits:
            self.halt(fit.model_id)
        self._maker.shutdown(wait=True, cancel_futures=True)

    def order(self, model_id: str, order: FitOrder) -> None:
        """Queue the fit of a model, or resume it."""
        files = FitFolder(self.folder / model_id)
        files.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        fit = _Fit(model_id, order, files)
        with self._lock:
            self._fits[model_id] = fit
        done = self._maker.submit(self._make_or_fail, fit)
        done.add_done_callback(lambda one: self.background.watched(QUEUE, one))

    def halt(self, model_id: str) -> None:
        """End the process of a fit, or remove it from the queue."""
        with self._lock:
            fit = self._fits.pop(model_id, None)
            if fit is None:
                return
            fit.cancelled = True
        fit.worker.end()

    def forget(self, model_id: str) -> None:
        """Stop a fit and delete its finished maps."""
        self.halt(model_id)
        shutil.rmtree(self.folder / model_id, ignore_errors=True)

    def progress(self, model_id: str) -> Progress | None:
        """Return the progress of a running or stopped fit, None if it has no files."""
        with self._lock:
            fit = self._fits.get(model_id)
            if fit is not None and not fit.started_making:
                stored = fit.files.progress()
                return Progress("waiting", stored.maps, stored.maps_total)
        files = FitFolder(self.folder / model_id)
        progress = files.progress() if files.folder.is_dir() else None
        if fit is not None and progress is not None and progress.stage == "waiting":
            return Progress("walks")  # its process is starting
        return progress

    def _make_or_fail(self, fit: _Fit) -> None:
        """Run a fit; mark it as failed on an unexpected error, and raise that for the queue."""
        try:
            self._make(fit)
        except Exception:
            self._settle(fit, None, BROKE)
            raise

    def _make(self, fit: _Fit) -> None:
        with self._lock:
            if fit.cancelled:
                return
            fit.started_making = True
            future = fit.worker.submit(fit_model, Store(self.url), fit.order, fit.files.folder)
        summary, trouble = _outcome(future)
        fit.worker.end()
        if fit.cancelled:
            return
        try:
            self._settle(fit, summary, trouble)
        except Exception:
            log.exception("a fitted model could not be stored")
            self._settle(fit, None, "it could not be stored: see the server's log, then resume it")

    def _settle(self, fit: _Fit, summary: dict[str, Any] | None, trouble: str | None) -> None:
        keep = None if summary is None else _storing(fit.files.model)
        with self.database.writing() as db:
            # Store the content first, because `store` expunges every row from the session.
            content_hash = None if keep is None else keep(db)
            row = db.get(WalkingModelRow, fit.model_id, with_for_update=True)
            if row is None or row.state != "fitting" or fit.cancelled:
                db.rollback()
                return
            row.content_hash = content_hash
            row.summary, row.trouble = summary, trouble
            row.state = "failed" if summary is None else "ready"
            row.ended_at = self.clock.utc_now()
        with self._lock:
            self._fits.pop(fit.model_id, None)
        if summary is not None:
            shutil.rmtree(fit.files.folder, ignore_errors=True)


def _outcome(future: "Future[dict[str, Any]]") -> tuple[dict[str, Any] | None, str | None]:
    try:
        return future.result(), None
    except Cannot as error:
        return None, as_sentences(error.reason, error.remedy)
    except (BrokenProcessPool, CancelledError):
        return None, BROKE
    except Exception as error:
        log.exception("a model could not be fitted")
        return None, f"{type(error).__name__}: see the server's log"


def _storing(file: Path) -> Callable[[Session], str]:
    with file.open("rb") as stream:
        content_hash: str = hashlib.file_digest(stream, "sha256").hexdigest()
    compressed, size = file.with_name("compressed"), file.stat().st_size
    compress(file, compressed)

    def keep(db: Session) -> str:
        store(db, content_hash, size, compressed)
        return content_hash

    return keep
