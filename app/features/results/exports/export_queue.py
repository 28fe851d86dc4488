"""The queue of exports: ordered, made one after the other, downloaded and removed.

The files are in a separate folder next to the database, which only the server can read. They are
removed when their owner deletes them, some time after the last download, when a participant of the
study is erased, and whenever the server starts or stops. Cancelling an export kills its process
immediately and removes what it had written.
"""

import logging
import shutil
import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from pathlib import Path
from typing import Self

from app.clock import Clock
from app.errors import NotFound, NotNow
from app.features.results.exports.jobs import KEEP_FOR, Job
from app.features.results.exports.schemas import ExportTrouble, ExportView
from app.features.results.exports.worker_messages import ExportFailure, ExportOrder, ExportResult
from app.platform.background import Background
from app.platform.context import AppContext, Part

log = logging.getLogger(__name__)
QUEUE = "exports"
MAX_OPEN = 5
"""How many exports an account may have queued or in progress."""
ENDED = ExportFailure(
    "the process that made the export ended",
    "Make it again; if that fails, too, check the server's log and memory.",
)


def make_archive(order: ExportOrder) -> ExportResult | ExportFailure:
    """Write the file, or return why it could not be made; runs in the worker process."""
    # Loads pandas, which the server's own process does not need.
    from app.features.results.exports.writing import make_export

    return make_export(order)


@dataclass(eq=False)
class ExportQueue(Part):
    """The queue of a server's exports, with the thread that makes them; thread-safe.

    `keep_free_bytes` of the disk are always left free.
    """

    folder: Path
    url: str
    clock: Clock
    keep_free_bytes: int
    background: Background
    _jobs: dict[str, Job] = field(default_factory=dict)
    _lock: threading.RLock = field(default_factory=threading.RLock)
    _maker: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="exports")
    )

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the export queue of a server, with its files in the scratch folder."""
        settings = context.settings
        return cls(
            settings.scratch_dir / "exports",
            settings.resolved_database_url,
            context.clock,
            settings.low_disk_bytes,
            context.background,
        )

    def start(self) -> None:
        """Remove files that an earlier run of the server left."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def stop(self) -> None:
        """Stop the exports in progress and remove every file."""
        self._drop(lambda _: True)
        self._maker.shutdown(wait=True, cancel_futures=True)
        shutil.rmtree(self.folder, ignore_errors=True)

    def order(self, job: Job) -> ExportView:
        """Queue an export, or return the open one for the same data.

        Raises NotNow if too many of the account's exports are open.
        """
        self._remove_expired()
        with self._lock:
            own_jobs = [
                one for one in self._jobs.values() if one.owner == job.owner and one.is_open
            ]
            existing = next((one for one in own_jobs if one.is_same_order(job)), None)
            if existing is not None:
                return self._view(existing)
            if len(own_jobs) >= MAX_OPEN:
                raise NotNow(
                    "too many of your exports are waiting",
                    value=len(own_jobs),
                    valid=f"up to {MAX_OPEN}",
                    remedy="Wait until one is ready, or cancel one.",
                )
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            self._jobs[job.id] = job
            self._maker.submit(self._make_or_fail, job)
            return self._view(job)

    def exports_of(self, owner: str) -> list[ExportView]:
        """Return an account's exports, newest first."""
        self._remove_expired()
        with self._lock:
            own_jobs = [self._view(job) for job in self._jobs.values() if job.owner == owner]
        return own_jobs[::-1]

    def find(self, owner: str, export_id: str) -> Job:
        """Return one of an account's exports.

        Raises NotFound if there is none, or if it belongs to another account.
        """
        self._remove_expired()
        with self._lock:
            job = self._jobs.get(export_id)
        if job is None or job.owner != owner:
            raise NotFound(
                "there is no such export",
                value=export_id,
                remedy="It was removed, or the server was restarted. Start the export again.",
            )
        return job

    def view(self, owner: str, export_id: str) -> ExportView:
        """Return the progress of an export; raise NotFound if there is none."""
        return self._view(self.find(owner, export_id))

    def cancel(self, owner: str, export_id: str) -> None:
        """Cancel an export, or remove its file; raise NotFound if there is none."""
        cancelled_job = self.find(owner, export_id)
        self._drop(lambda job: job is cancelled_job)

    def forget_study(self, study_key: str) -> None:
        """Remove all exports of a study, because one of its participants was erased."""
        self._drop(lambda job: job.study_key == study_key)

    def _view(self, job: Job) -> ExportView:
        return job.view(self.clock.monotonic_ns())

    def _make_or_fail(self, job: Job) -> None:
        """Make an export; an unexpected error marks it as failed, and the next one is made."""
        try:
            self._make(job)
        except Exception as error:
            log.exception("an export could not be created")
            self.background.failed(QUEUE, error)
            job.trouble = ExportTrouble(message=ENDED.message, remedy=ENDED.remedy)
            job.state = "failed"

    def _make(self, job: Job) -> None:
        order = ExportOrder(
            url=self.url,
            study_key=job.study_key,
            kind=job.kind,
            session_id=job.session_id,
            movement=job.movement,
            now=job.asked_at,
            to=job.path,
            meter=job.meter.path,
            keep_free_bytes=self.keep_free_bytes,
        )
        with self._lock:
            if job.cancelled:
                return
            job.state, job.began_ns = "making", self.clock.monotonic_ns()
            future = job.worker.submit(make_archive, order)
        try:
            result = future.result()
            self.background.recovered(QUEUE)
        except (BrokenProcessPool, CancelledError) as error:
            result = ENDED
            if not job.cancelled:
                self.background.failed(QUEUE, error)
        except Exception as error:
            log.exception("an export could not be created")
            result = ENDED
            self.background.failed(QUEUE, error)
        finally:
            job.worker.end()
        self._finish(job, result)

    def _finish(self, job: Job, result: ExportResult | ExportFailure) -> None:
        with self._lock:
            job.ended_ns = self.clock.monotonic_ns()
            if isinstance(result, ExportResult) and not job.cancelled:
                job.size_bytes, job.sha256 = result.size_bytes, result.sha256
                job.sessions, job.revealed = result.sessions, result.revealed
                job.made_at = self.clock.utc_now()
                job.state = "ready"
                self._schedule_expiry()
                return
            job.remove_files()
            if isinstance(result, ExportFailure):
                job.trouble = ExportTrouble(message=result.message, remedy=result.remedy)
            job.state = "failed"

    def _drop(self, matches: Callable[[Job], bool]) -> None:
        with self._lock:
            dropped = [job for job in self._jobs.values() if matches(job)]
            for job in dropped:
                job.cancelled = True
                del self._jobs[job.id]
        for job in dropped:
            # Kill the process first, so that nothing is written after the files are removed.
            job.worker.end()
            job.remove_files()

    def _remove_expired(self) -> None:
        now = self.clock.utc_now()
        self._drop(lambda job: job.expires_at is not None and job.expires_at <= now)

    def _expire_on_timer(self) -> None:
        try:
            self._remove_expired()
        except OSError as error:
            log.exception("a file that is due could not be removed")
            self.background.failed(QUEUE, error)
        with self._lock:
            if any(job.state == "ready" for job in self._jobs.values()):
                self._schedule_expiry()

    def _schedule_expiry(self) -> None:
        timer = threading.Timer(KEEP_FOR.total_seconds() + 1, self._expire_on_timer)
        timer.daemon = True
        timer.start()
