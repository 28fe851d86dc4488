"""Tests that a queue of resumable jobs agrees with its rows, whoever changes them when."""

import threading
from concurrent.futures import Future
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
from sqlalchemy.orm import Session

from app.models import AvatarTuningRow
from app.platform.resumable_jobs import ResumableJobs
from app.platform.workers import Worker
from tests.features.lab import Lab


class Process(Worker):
    """A worker whose task runs until it is ended, or until the test lets it finish."""

    def __init__(self) -> None:
        super().__init__()
        self.task: Future[dict[str, Any]] | None = None
        self.ended = False

    def end(self) -> None:
        """End the task as the end of a real process does."""
        self.ended = True
        if self.task is not None and not self.task.done():
            self.task.cancel()


@dataclass(eq=False)
class Queue(ResumableJobs[str]):
    """A queue of jobs in processes that only wait."""

    row: ClassVar[type[Any]] = AvatarTuningRow
    running: ClassVar[str] = "tuning"
    queue_name: ClassVar[str] = "test"
    broke: ClassVar[str] = "broke"
    unstorable: ClassVar[str] = "unstorable"

    processes: list[Process] = field(default_factory=list)
    began: threading.Semaphore = field(default_factory=lambda: threading.Semaphore(0))

    def alive(self) -> list[Process]:
        """Return the processes that nobody has ended."""
        return [one for one in self.processes if not one.ended]

    def _new_worker(self) -> Worker:
        self.processes.append(Process())
        return self.processes[-1]

    def _submit(self, worker: Worker, order: str, folder: Path) -> "Future[dict[str, Any]]":
        assert order == folder.name
        assert folder.is_dir()
        assert isinstance(worker, Process)
        worker.task = Future()
        self.began.release()
        return worker.task

    def _refusal(self, error: Exception) -> str | None:
        return str(error)


def order_of(db: Session, job_id: str) -> str:
    """Return the order of a job."""
    return job_id


@pytest.fixture
def queue(fresh_lab: Lab, tmp_path: Path) -> Queue:
    """Return a queue with one job, whose row says that it is stopped."""
    context = fresh_lab.context
    with fresh_lab.database.writing() as db:
        row = AvatarTuningRow(
            id="job",
            content_hash="0" * 64,
            canonical_json="{}",
            stature_m=1.75,
            options={},
            state="stopped",
            by="account:admin",
            at=context.clock.utc_now(),
        )
        db.add(row)
    return Queue(tmp_path, context.database, context.clock, context.background)


def commit(queue: Queue, state: str) -> None:
    """Commit a state of the job, without telling the queue."""
    with queue.database.writing() as db:
        row = db.get(AvatarTuningRow, "job")
        assert row is not None
        row.state = state


def state_of(queue: Queue) -> str:
    """Return the committed state of the job."""
    with queue.database.reading() as db:
        row = db.get(AvatarTuningRow, "job")
        assert row is not None
        return row.state


def test_a_late_resume_or_stop_follows_the_last_commit(queue: Queue) -> None:
    """The row that is committed last decides, not the request that reaches the queue last."""
    commit(queue, "tuning")
    commit(queue, "stopped")
    queue.follow("job", order_of)  # by the resume, which is late
    assert (queue.place_of("job"), queue.processes) == (None, [])
    commit(queue, "tuning")
    queue.follow("job", order_of)
    queue.follow("job", order_of)  # by a stop that came before
    assert queue.place_of("job") is not None
    assert len(queue.alive()) == len(queue.processes) == 1
    commit(queue, "stopped")
    queue.follow("job", order_of)
    assert (queue.place_of("job"), queue.alive()) == (None, [])
    queue.stop()


def test_a_result_that_comes_during_a_resume_is_kept(queue: Queue) -> None:
    """A job that ends after being stopped and resumed is ready, and does not run again."""
    commit(queue, "tuning")
    queue.follow("job", order_of)
    assert queue.began.acquire(timeout=30.0)
    commit(queue, "stopped")
    commit(queue, "tuning")
    task = queue.processes[0].task
    assert task is not None
    task.set_result({"report": {}})
    queue._maker.submit(lambda: None).result()
    queue.follow("job", order_of)
    assert (state_of(queue), queue.place_of("job"), queue.alive()) == ("ready", None, [])
    assert not queue.folder_of("job").exists()
    queue.stop()


@pytest.mark.one_engine
def test_many_stops_and_resumes_at_once_leave_one_job_or_none(queue: Queue) -> None:
    """After many simultaneous stops and resumes, a process runs only if its row says so."""

    def press(seed: int) -> None:
        rng = np.random.default_rng(seed)
        for resumes in rng.random(12) < 0.5:
            commit(queue, "tuning" if resumes else "stopped")
            queue.follow("job", order_of)

    people = [threading.Thread(target=press, args=(seed,)) for seed in range(6)]
    for one in people:
        one.start()
    for one in people:
        one.join()
    runs = state_of(queue) == "tuning"
    assert (queue.place_of("job") is not None, len(queue.alive())) == (runs, int(runs))
    commit(queue, "tuning")
    queue.follow("job", order_of)
    assert len(queue.alive()) == 1
    queue.forget("job")
    assert (queue.place_of("job"), queue.alive()) == (None, [])
    assert not queue.folder_of("job").exists()
    queue.stop()
