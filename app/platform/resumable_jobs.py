"""Run long jobs one after the other, each in a worker process that can be ended and resumed.

Each job has a folder next to the database, in which its process keeps what is finished. Stopping
kills the process; resuming starts another one, which goes on from the folder's content, even after
a restart of the server. Only a complete result reaches the database.

The row of a job says whether it is to run. Whoever has changed the row, and committed that, calls
`follow`, which reads the row again: so the queue agrees with the last commit, in whichever order
several people's requests arrive.
"""

import logging
import shutil
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Generic, TypeVar

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from app.clock import Clock
from app.database import Database
from app.platform.background import Background
from app.platform.context import Part
from app.platform.workers import Worker

log = logging.getLogger(__name__)
Order = TypeVar("Order")
Summary = dict[str, Any]


@dataclass(eq=False)
class _Job(Generic[Order]):
    job_id: str
    order: Order
    worker: Worker
    cancelled: bool = False
    started: bool = False


@dataclass(eq=False)
class ResumableJobs(Part, ABC, Generic[Order]):
    """A queue of resumable jobs, with the thread that runs them; thread-safe.

    `folder` holds the folders of all jobs. Each job has a row in the database, with the columns
    `id`, `state`, `trouble`, `summary` and `ended_at`; `running` is its state while it is in the
    queue, and the others are `stopped`, `ready` and `failed`.
    """

    row: ClassVar[type[Any]]
    running: ClassVar[str]
    queue_name: ClassVar[str]
    """The name under which failures of the queue are reported."""
    broke: ClassVar[str]
    """The trouble of a job whose process has died."""
    unstorable: ClassVar[str]
    """The trouble of a job whose result could not be stored."""

    folder: Path
    database: Database
    clock: Clock
    background: Background
    _jobs: dict[str, _Job[Order]] = field(default_factory=dict)
    _lock: threading.RLock = field(default_factory=threading.RLock)
    # Held from reading a row to acting on it; never wait for it within a transaction.
    _following: threading.Lock = field(default_factory=threading.Lock)
    _maker: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="resumable-jobs")
    )

    def start(self) -> None:
        """Mark jobs that an earlier run of the server left as stopped; their folders are kept."""
        table = self.row
        with self.database.reading() as db:
            left = db.scalars(select(table.id).where(table.state == self.running)).all()
        if left:
            with self.database.writing() as db:
                db.execute(update(table).where(table.id.in_(left)).values(state="stopped"))

    def stop(self) -> None:
        """Stop all jobs; their folders are kept."""
        with self._lock:
            jobs = list(self._jobs.values())
        for job in jobs:
            self.halt(job.job_id)
        self._maker.shutdown(wait=True, cancel_futures=True)

    def follow(self, job_id: str, order_of: Callable[[Session, str], Order]) -> None:
        """Queue, keep or end a job as its committed row says.

        `order_of` returns the order of a job that is not in the queue yet, and may raise. Call this
        after the commit, outside transactions.
        """
        with self._following:
            with self.database.reading() as db:
                runs = self._runs(db.get(self.row, job_id))
                queued = self.place_of(job_id) is not None
                order = order_of(db, job_id) if runs and not queued else None
            if order is not None:
                self._queue(job_id, order)
            elif not runs:
                self._end(job_id)

    def halt(self, job_id: str) -> None:
        """End the process of a job, or remove it from the queue, whatever its row says."""
        with self._following:
            self._end(job_id)

    def forget(self, job_id: str) -> None:
        """Stop a job and delete its folder."""
        with self._following:
            self._end(job_id)
            shutil.rmtree(self.folder_of(job_id), ignore_errors=True)

    def folder_of(self, job_id: str) -> Path:
        """Return the folder of a job, which exists while it is unfinished."""
        return self.folder / job_id

    def place_of(self, job_id: str) -> str | None:
        """Return whether a job is `waiting` or `started`; None if it is not in the queue."""
        with self._lock:
            job = self._jobs.get(job_id)
            if job is None:
                return None
            return "started" if job.started else "waiting"

    @abstractmethod
    def _new_worker(self) -> Worker:
        """Create a worker process for one job."""

    @abstractmethod
    def _submit(self, worker: Worker, order: Order, folder: Path) -> "Future[Summary]":
        """Start a job in its process; its result is the summary to be stored."""

    @abstractmethod
    def _refusal(self, error: Exception) -> str | None:
        """Return the trouble of a job that raised `error` deliberately, else None."""

    def _keeping(self, folder: Path, summary: Summary) -> Callable[[Session], dict[str, Any]]:
        """Return a function that stores more than the summary and returns columns to be set.

        This is called outside the transaction, for what takes long.
        """
        del folder, summary
        return lambda _: {}

    def _runs(self, row: Any) -> bool:
        return row is not None and row.state == self.running

    def _queue(self, job_id: str, order: Order) -> None:
        self.folder_of(job_id).mkdir(mode=0o700, parents=True, exist_ok=True)
        job = _Job(job_id, order, self._new_worker())
        with self._lock:
            self._jobs[job_id] = job
        done = self._maker.submit(self._run_or_fail, job)
        done.add_done_callback(lambda one: self.background.watched(self.queue_name, one))

    def _end(self, job_id: str) -> None:
        with self._lock:
            job = self._jobs.pop(job_id, None)
            if job is None:
                return
            job.cancelled = True
        job.worker.end()

    def _run_or_fail(self, job: _Job[Order]) -> None:
        """Run a job; mark it as failed on an unexpected error, and raise that for the queue."""
        try:
            self._run(job)
        except Exception:
            self._settle(job, None, self.broke)
            raise

    def _run(self, job: _Job[Order]) -> None:
        with self._lock:
            if job.cancelled:
                return
            job.started = True
            future = self._submit(job.worker, job.order, self.folder_of(job.job_id))
        summary, trouble = self._outcome(future)
        job.worker.end()
        if job.cancelled:
            return
        try:
            self._settle(job, summary, trouble)
        except Exception:
            log.exception("the result of a job could not be stored")
            self._settle(job, None, self.unstorable)

    def _outcome(self, future: "Future[Summary]") -> tuple[Summary | None, str | None]:
        try:
            return future.result(), None
        except (BrokenProcessPool, CancelledError):
            return None, self.broke
        except Exception as error:
            trouble = self._refusal(error)
            if trouble is None:
                log.exception("a job has failed: %s", self.queue_name)
                trouble = f"{type(error).__name__}: see the server's log"
            return None, trouble

    def _settle(self, job: _Job[Order], summary: Summary | None, trouble: str | None) -> None:
        folder = self.folder_of(job.job_id)
        keep = None if summary is None else self._keeping(folder, summary)
        # While this is held, nobody can take the job for one that still runs, or queue another.
        with self._following:
            try:
                stored = self._store(job, trouble, summary, keep)
            finally:
                self._leave(job)
            if stored and summary is not None:
                shutil.rmtree(folder, ignore_errors=True)

    def _store(
        self,
        job: _Job[Order],
        trouble: str | None,
        summary: Summary | None,
        keep: Callable[[Session], dict[str, Any]] | None,
    ) -> bool:
        """Store how a job has ended; return False if it was stopped or deleted meanwhile."""
        with self.database.writing() as db:
            # Store other content first, because that may expunge every row from the session.
            columns = {} if keep is None else keep(db)
            row: Any = db.get(self.row, job.job_id, with_for_update=True)
            if job.cancelled or not self._runs(row):
                db.rollback()
                return False
            columns |= {"trouble": trouble, "ended_at": self.clock.utc_now()}
            columns |= {"state": "failed" if summary is None else "ready"}
            if "summary" not in columns:
                columns["summary"] = summary
            for name, value in columns.items():
                setattr(row, name, value)
        return True

    def _leave(self, job: _Job[Order]) -> None:
        with self._lock:
            if self._jobs.get(job.job_id) is job:
                del self._jobs[job.job_id]
