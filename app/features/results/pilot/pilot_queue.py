"""Run pilots one after the other, each in a process that can be stopped and resumed.

The process has the lowest priority, and waits from one frame of a simulated person to the next
while anybody is in a session: a pilot must never cost a session a frame. What is finished is kept
in the pilot's folder; a server that starts marks pilots that it finds unfinished as stopped.
"""

import os
import shutil
import threading
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Final, Self

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.results.pilot.folder import PilotFolder
from app.features.results.pilot.order import CannotSimulate, PilotOrder
from app.models import PilotRow, StudySession
from app.platform.context import AppContext
from app.platform.resumable_jobs import ResumableJobs
from app.platform.workers import Worker

THREAD = "pilot-holder"
LOOK_EVERY_S: Final = 1.0
"""How often it is looked whether somebody is in a session."""
LOWEST_PRIORITY: Final = 19


def lowest_priority() -> None:
    """Let everything else on the machine have the processor first; runs in the worker process."""
    if hasattr(os, "nice"):
        os.nice(LOWEST_PRIORITY)


def run_in_process(order: PilotOrder, files: PilotFolder) -> dict[str, Any]:
    """Run a pilot in its process, which alone loads what simulates people."""
    from app.features.results.pilot.worker_tasks import run_pilot

    return run_pilot(order, files)


def new_worker() -> Worker:
    """Create a worker process for one pilot, which can be ended separately."""
    return Worker(lowest_priority)


def is_in_session(db: Session) -> bool:
    """Return whether anybody is in a session now; a simulated participant is nobody."""
    active = select(StudySession.id).where(
        StudySession.status == "active", StudySession.kind != "simulated"
    )
    return db.scalar(active.limit(1)) is not None


@dataclass(eq=False)
class PilotQueue(ResumableJobs[PilotOrder]):
    """The queue of a server's pilots."""

    row: ClassVar[type[Any]] = PilotRow
    running: ClassVar[str] = "simulating"
    queue_name: ClassVar[str] = "pilots"
    broke: ClassVar[str] = (
        "the process that simulated it ended: resume it, and if that fails, too, see the server's "
        "log"
    )
    unstorable: ClassVar[str] = "it could not be stored: see the server's log, then resume it"
    _ending: threading.Event = field(default_factory=threading.Event)
    _holder: threading.Thread | None = None

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the queue of a server, with its files in the data folder."""
        folder = context.settings.data_dir.resolve() / "pilots"
        return cls(folder, context.database, context.clock, context.background)

    def start(self) -> None:
        """Mark pilots of an earlier run as stopped, and remove folders that belong to none."""
        super().start()
        with self.database.reading() as db:
            known = set(db.scalars(select(PilotRow.id)))
        for one in self.folder.glob("*"):
            if one.name not in known:
                shutil.rmtree(one, ignore_errors=True)
        self._holder = self.background.thread(THREAD, self._keep_looking)

    def stop(self) -> None:
        """Stop all pilots; what is finished of them is kept."""
        self._ending.set()
        if self._holder is not None:
            self._holder.join(timeout=10.0)
        super().stop()

    def files(self, pilot_id: str) -> PilotFolder:
        """Return the folder of an unfinished pilot."""
        return PilotFolder(self.folder_of(pilot_id))

    def look(self) -> None:
        """Hold the pilot that runs while anybody is in a session, and let it go afterwards.

        Pilots whose study was deleted with everything in it, as the demo lab's, are ended.
        """
        with self._lock:
            queued = {one: job.started for one, job in self._jobs.items()}
        if not queued:
            return
        with self.database.reading() as db:
            is_held = is_in_session(db)
            known = set(db.scalars(select(PilotRow.id).where(PilotRow.id.in_(queued))))
        for pilot_id, is_started in queued.items():
            files = self.files(pilot_id)
            if pilot_id not in known:
                self.forget(pilot_id)
            elif is_started and not is_held:
                files.let_go()
            elif is_started and files.folder.is_dir():
                files.hold()

    def _keep_looking(self) -> None:
        while not self._ending.wait(LOOK_EVERY_S):
            self.look()
            self.background.recovered(THREAD)

    def _new_worker(self) -> Worker:
        return new_worker()

    def _submit(self, worker: Worker, order: PilotOrder, folder: Path) -> "Future[dict[str, Any]]":
        # Held until `look` has found that nobody is in a session.
        files = PilotFolder(folder)
        files.hold()
        return worker.submit(run_in_process, order, files)

    def _refusal(self, error: Exception) -> str | None:
        return str(error) if isinstance(error, CannotSimulate) else None

    def _keeping(
        self, folder: Path, summary: dict[str, Any]
    ) -> Callable[[Session], dict[str, Any]]:
        del summary
        record = PilotFolder(folder).record()
        return lambda _: {"record": record}
