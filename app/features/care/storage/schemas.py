"""Response models of the use of disk space."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

from app.features.care.storage.families import Family

Place = Family | Literal["unused", "log", "database", "backups", "scratch"]
Method = Literal["dbstat", "page_counts", "pg_total_relation_size"]
SessionKind = Literal["people", "simulated", "test", "expert"]


class PartView(BaseModel):
    """The size of one part of the stored data; `files`: number of files, for a folder."""

    place: Place
    bytes: int
    files: int | None = None


class DiskView(BaseModel):
    """The disk of the data folder; `warn_below_bytes` is the threshold of the pre-flight check.

    `holds_database` is false if the database is on a database server, whose disk cannot be measured
    from here.
    """

    free_bytes: int
    total_bytes: int
    warn_below_bytes: int
    is_low: bool
    holds_database: bool


class StudyRoom(BaseModel):
    """The disk space used by a study.

    `mean_bytes`: of its `measured` completed sessions with movement, of the kind `measured_kind`:
    people's if there are any, since others may be shorter. `room_for`: how many more of these
    fit before the disk warning; None if there are none, or the database is elsewhere. `title`: by
    language.
    """

    key: str
    title: dict[str, str]
    bytes: int
    sessions: int
    mean_bytes: int | None
    measured: int
    measured_kind: SessionKind | None
    room_for: int | None


class SessionRoom(BaseModel):
    """The disk space used by one session."""

    id: str
    study_key: str
    participant_code: str
    kind: SessionKind
    created_at: datetime
    bytes: int


class HalfMadeView(BaseModel):
    """An unfinished file or folder: its kind, place and start time.

    `going_on`: a command is writing it now; otherwise a crash left it, and the next start of the
    server removes it, unless its disk is not connected.
    """

    kind: Literal["backup", "export", "restore", "database"]
    place: str
    since: datetime
    going_on: bool


class StorageView(BaseModel):
    """The use of disk space, measured at `measured_at`, in bytes.

    Sizes of studies and sessions are shares of their tables' sizes by the length of their rows, so
    they include indexes and half-full pages. `sessions` are the largest of `sessions_total`.
    `half_made` leaves out what this server itself is writing.
    """

    measured_at: datetime
    engine: Literal["sqlite", "postgresql"]
    method: Method
    place: str
    disk: DiskView
    parts: list[PartView]
    studies: list[StudyRoom]
    sessions: list[SessionRoom]
    sessions_total: int
    half_made: list[HalfMadeView]
