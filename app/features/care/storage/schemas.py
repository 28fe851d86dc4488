"""How full the disk is, as it travels to a page."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

from app.features.care.storage.families import Family

Place = Family | Literal["unused", "log", "database", "backups", "scratch"]
Method = Literal["dbstat", "page_counts", "pg_total_relation_size"]
SessionKind = Literal["people", "simulated", "test", "expert"]


class PartView(BaseModel):
    """Something that takes room; `files`: how many, of a folder."""

    place: Place
    bytes: int
    files: int | None = None


class DiskView(BaseModel):
    """The disk of the data folder; `warn_below_bytes` as the pre-flight has it.

    `holds_database` is false where the database is on a server of its own, whose disk nobody sees
    from here.
    """

    free_bytes: int
    total_bytes: int
    warn_below_bytes: int
    is_low: bool
    holds_database: bool


class StudyRoom(BaseModel):
    """What a study takes.

    `mean_bytes`: of its `measured` completed sessions with movement, of the kind `measured_kind`:
    people's where there are any, since others may be shorter. `room_for`: how many more of these
    fit before the disk warns; None where nothing was measured, or the database is elsewhere.
    """

    key: str
    title: str
    bytes: int
    sessions: int
    mean_bytes: int | None
    measured: int
    measured_kind: SessionKind | None
    room_for: int | None


class SessionRoom(BaseModel):
    """What one session takes."""

    id: str
    study_key: str
    participant_code: str
    kind: SessionKind
    created_at: datetime
    bytes: int


class HalfMadeView(BaseModel):
    """A file or folder that is not whole: of what kind, where, since when.

    `going_on`: a command is making it now; else a crash left it, and the next start of the server
    removes it, unless its disk is not there.
    """

    kind: Literal["backup", "export", "restore", "database"]
    place: str
    since: datetime
    going_on: bool


class StorageView(BaseModel):
    """What takes how much room, measured at `measured_at`, in whole bytes.

    Sizes of studies and sessions are their tables' own sizes, shared out by the length of their
    rows, so they hold indexes and half-full pages. `sessions` are the largest of `sessions_total`.
    `half_made` leaves out what this server itself is making.
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
