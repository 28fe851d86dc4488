"""One export in the server's memory, from the order to the removal of its file."""

from dataclasses import dataclass, field
from datetime import datetime, timedelta
from pathlib import Path

from app.features.results.analysis import Kind
from app.features.results.exports.schemas import ExportState, ExportTrouble, ExportView
from app.features.results.exports.worker_messages import Meter
from app.models import new_id
from app.platform.workers import Worker

KEEP_FOR = timedelta(hours=2)
"""How long a finished file is kept after it was made or last downloaded."""
MIN_ROWS_TO_ESTIMATE = 2_000
"""The file's size is estimated only after this many rows have been written."""
NS_PER_S = 1e9


@dataclass(eq=False)
class Job:
    """An export of one account, its state and its worker process.

    `began_ns`, `ended_ns`: monotonic times of the making, without the wait in the queue.
    `recorded`: whether the copy is on record. `given_up`: whether the export was cancelled.
    """

    owner: str
    study_key: str
    kind: Kind
    session_id: str | None
    movement: bool
    file_name: str
    asked_at: datetime
    folder: Path
    id: str = field(default_factory=new_id)
    state: ExportState = "queued"
    began_ns: int | None = None
    ended_ns: int | None = None
    size_bytes: int = 0
    sha256: str | None = None
    sessions: int = 0
    revealed: frozenset[str] = frozenset()
    made_at: datetime | None = None
    fetched_at: datetime | None = None
    recorded: bool = False
    trouble: ExportTrouble | None = None
    cancelled: bool = False
    worker: Worker = field(default_factory=Worker)

    @property
    def path(self) -> Path:
        """Return the path of the finished file."""
        return self.folder / f"{self.id}.zip"

    @property
    def meter(self) -> Meter:
        """Return the progress file that the worker process writes."""
        return Meter(self.folder / f"{self.id}.progress")

    @property
    def is_open(self) -> bool:
        """Return whether the export is queued or in progress."""
        return self.state in ("queued", "making")

    @property
    def expires_at(self) -> datetime | None:
        """Return when the file is removed unless it is downloaded; None if it is not ready."""
        last = self.fetched_at or self.made_at
        return None if last is None or self.state != "ready" else last + KEEP_FOR

    def is_same_order(self, other: "Job") -> bool:
        """Return whether two jobs are orders of the same file by the same account."""
        return (
            *(self.owner, self.study_key, self.kind),
            *(self.session_id, self.movement),
        ) == (
            *(other.owner, other.study_key, other.kind),
            *(other.session_id, other.movement),
        )

    def remove_files(self) -> None:
        """Remove all files of the export from the disk."""
        for path in (self.path, self.path.with_suffix(".part"), self.meter.path):
            path.unlink(missing_ok=True)

    def view(self, now_ns: int) -> ExportView:
        """Return the progress of the export, with estimates of its size and remaining time."""
        done = self.meter.read()
        elapsed_s = self._elapsed_s(now_ns)
        size = self.size_bytes or done.bytes
        share = done.rows / done.rows_total if done.rows_total else 0.0
        can_estimate = (
            self.state == "making" and done.rows >= MIN_ROWS_TO_ESTIMATE and 0 < share <= 1
        )
        return ExportView(
            id=self.id,
            study_key=self.study_key,
            kind=self.kind,
            session_id=self.session_id,
            movement=self.movement,
            file_name=self.file_name,
            state=self.state,
            asked_at=self.asked_at,
            rows=done.rows,
            # The total is an estimate: frames may be added later, and the two streams may differ.
            rows_total=done.rows if self.state == "ready" else max(done.rows_total, done.rows),
            sessions=done.sessions,
            sessions_total=done.sessions_total,
            bytes=size,
            bytes_expected=round(size / share) if can_estimate else None,
            bytes_per_s=size / elapsed_s if elapsed_s > 0 and size else None,
            elapsed_s=elapsed_s,
            remaining_s=elapsed_s * (1 - share) / share if can_estimate else None,
            sha256=self.sha256,
            fetched_at=self.fetched_at,
            expires_at=self.expires_at,
            trouble=self.trouble,
        )

    def _elapsed_s(self, now_ns: int) -> float:
        if self.began_ns is None:
            return 0.0
        return ((self.ended_ns or now_ns) - self.began_ns) / NS_PER_S
