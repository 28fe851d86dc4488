"""Measure the sizes of database and disk once for all requests, since that may take seconds."""

import shutil
import threading
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Self

from sqlalchemy import select

from app.clock import Clock
from app.database import Database
from app.features.care.storage.families import FAMILY_OF
from app.features.care.storage.schemas import PartView, Place, SessionRoom
from app.features.care.storage.tables import TableSizes, bytes_by_session, table_sizes
from app.models import Participant, Study, StudySession, TelemetryChunk
from app.platform.context import AppContext, Part
from app.platform.folders import backups_of
from app.settings import Settings

CACHED_FOR_NS = 60 * 1_000_000_000
OPTIONAL: tuple[Place, ...] = ("unused", "log", "database", "backups", "scratch")


@dataclass(frozen=True)
class MeasuredSession:
    """A session with its size.

    `is_typical`: the next session may be as large, since this one was completed, is valid by its
    study's rules, and has movement, which is nearly all of a session's size.
    """

    room: SessionRoom
    is_typical: bool


@dataclass(frozen=True)
class Measured:
    """The sizes measured at one moment; `total_bytes` is the size of the data folder's disk."""

    at: datetime
    sizes: TableSizes
    parts: tuple[PartView, ...]
    sessions: tuple[MeasuredSession, ...]
    total_bytes: int


@dataclass(eq=False)
class StorageMeter(Part):
    """The cached measurement of database and disk; thread-safe, one thread measures for all."""

    database: Database
    settings: Settings
    clock: Clock
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _measured: Measured | None = None
    _measured_ns: int = 0

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the storage meter of a server."""
        return cls(context.database, context.settings, context.clock)

    def measured(self, *, refresh: bool = False) -> Measured:
        """Return the sizes, measured at most a minute ago; `refresh` measures again."""
        with self._lock:
            now_ns = self.clock.monotonic_ns()
            cached = self._measured
            if cached is None or refresh or now_ns - self._measured_ns > CACHED_FOR_NS:
                cached = self._measured = self._measure()
                self._measured_ns = self.clock.monotonic_ns()
            return cached

    def _measure(self) -> Measured:
        with self.database.reading() as db:
            sizes = table_sizes(db)
            shares = bytes_by_session(db, sizes.bytes)
            moving = set(db.scalars(select(TelemetryChunk.session_id).distinct()))
            rows = db.execute(
                select(StudySession, Study.key, Participant.code)
                .join(Study, Study.id == StudySession.study_id)
                .join(Participant, Participant.id == StudySession.participant_id)
            )
            sessions = tuple(
                MeasuredSession(
                    SessionRoom(
                        id=session.id,
                        study_key=key,
                        participant_code=code,
                        kind=session.kind,
                        created_at=session.created_at,
                        bytes=round(shares.get(session.id, 0)),
                    ),
                    session.status == "completed"
                    and not session.shortfalls
                    and session.id in moving,
                )
                for session, key, code in rows
            )
        return Measured(
            at=self.clock.utc_now(),
            sizes=sizes,
            parts=tuple(_parts(sizes, self.settings)),
            sessions=sessions,
            total_bytes=shutil.disk_usage(_there(self.settings.data_dir)).total,
        )


def _parts(sizes: TableSizes, settings: Settings) -> Iterator[PartView]:
    families: Counter[Place] = Counter()
    for table, size in sizes.bytes.items():
        families[FAMILY_OF.get(table, "setup")] += size
    if not sizes.bytes:
        families["database"] = sizes.whole_bytes
    families["unused"], families["log"] = sizes.unused_bytes, sizes.log_bytes
    for place, size in families.items():
        if size or place not in OPTIONAL:
            yield PartView(place=place, bytes=size)
    folders: tuple[tuple[Place, Path], ...] = (
        ("backups", backups_of(settings)),
        ("scratch", settings.scratch_dir),
    )
    for place, folder in folders:
        found = list(_file_sizes(folder))
        if found:
            yield PartView(place=place, bytes=sum(found), files=len(found))


def _file_sizes(folder: Path) -> Iterator[int]:
    if folder.is_dir():
        for path in folder.rglob("*"):
            try:
                if path.is_file():
                    yield path.stat().st_size
            except OSError:
                # The file was deleted in the meantime.
                continue


def _there(folder: Path) -> Path:
    """Return the folder or its nearest existing parent; with PostgreSQL it may not exist."""
    folder = folder.resolve()
    return folder if folder.exists() else _there(folder.parent)
