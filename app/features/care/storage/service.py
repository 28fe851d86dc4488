"""Report the use of disk space for a person, and how many more sessions fit on the disk."""

from collections.abc import Sequence

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.care.storage.measuring import Measured, MeasuredSession, StorageMeter
from app.features.care.storage.schemas import (
    DiskView,
    HalfMadeView,
    SessionKind,
    SessionRoom,
    StorageView,
    StudyRoom,
)
from app.features.design.studies import newest_version, protocol_of
from app.models import Study
from app.platform.access import Caller, visible_to
from app.platform.context import AppContext
from app.platform.incomplete_files import incomplete_files

LARGEST = 12
"""How many sessions are listed."""
MEASURED_BY: tuple[SessionKind, ...] = ("people", "test", "simulated")
"""Kinds of sessions to estimate sizes from: the first one with typical sessions is used."""


def storage_view(db: Session, context: AppContext, caller: Caller, *, refresh: bool) -> StorageView:
    """Return all sizes, with only those studies and sessions that the caller may see."""
    measured = context.part(StorageMeter).measured(refresh=refresh)
    disk = _disk(context, measured)
    studies = db.scalars(select(Study).where(visible_to(caller)).order_by(Study.key)).all()
    own = {study.key for study in studies}
    seen = [one for one in measured.sessions if one.room.study_key in own]
    largest = sorted(seen, key=lambda one: one.room.bytes, reverse=True)[:LARGEST]
    return StorageView(
        measured_at=measured.at,
        engine="sqlite" if context.database.is_sqlite else "postgresql",
        method=measured.sizes.method,
        place=str(context.settings.data_dir.resolve()),
        disk=disk,
        parts=sorted(measured.parts, key=lambda part: part.bytes, reverse=True),
        studies=sorted(
            (
                _study(db, study, [one for one in seen if one.room.study_key == study.key], disk)
                for study in studies
            ),
            key=lambda study: study.bytes,
            reverse=True,
        ),
        sessions=[one.room for one in largest],
        sessions_total=len(seen),
        half_made=[
            HalfMadeView(kind=one.kind, place=str(one.path), since=one.since, going_on=one.going_on)
            for one in incomplete_files(context.settings)
            # Files in the scratch folder are in progress and are removed automatically.
            if one.kind != "upload"
            and one.kind != "check"
            and (one.kind != "export" or one.study_key in own)
        ],
    )


def _disk(context: AppContext, measured: Measured) -> DiskView:
    storage = context.storage
    try:
        free = storage.free_bytes(storage.folder)
    except OSError:
        # Without the folder, nothing was ever stored on this machine.
        free = measured.total_bytes
    return DiskView(
        free_bytes=free,
        total_bytes=measured.total_bytes,
        warn_below_bytes=storage.low_disk_bytes,
        is_low=free < storage.low_disk_bytes,
        holds_database=context.database.is_sqlite,
    )


def _study(
    db: Session, study: Study, sessions: Sequence[MeasuredSession], disk: DiskView
) -> StudyRoom:
    rooms = [one.room for one in sessions]
    kind, measured = _typical([one.room for one in sessions if one.is_typical])
    mean = sum(room.bytes for room in measured) / len(measured) if measured else 0.0
    left = max(0, disk.free_bytes - disk.warn_below_bytes)
    return StudyRoom(
        key=study.key,
        title=dict(protocol_of(newest_version(db, study)).title),
        bytes=sum(room.bytes for room in rooms),
        sessions=len(rooms),
        mean_bytes=round(mean) if measured else None,
        measured=len(measured),
        measured_kind=kind,
        room_for=int(left // mean) if mean >= 1 and disk.holds_database else None,
    )


def _typical(typical: Sequence[SessionRoom]) -> tuple[SessionKind | None, list[SessionRoom]]:
    """Return the sessions that predict the size of the next ones, and their kind."""
    for kind in MEASURED_BY:
        found = [room for room in typical if room.kind == kind]
        if found:
            return kind, found
    return None, []
