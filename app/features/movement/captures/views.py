"""Convert stored captures to response models."""

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.features.movement.captures.schemas import (
    CaptureListed,
    CapturePage,
    CaptureSummary,
    CaptureView,
    ReadingChoice,
)
from app.features.movement.captures.service import capture_by_id
from app.features.movement.files import size_of
from app.models import CaptureContent, CaptureRow

_COLUMNS = (
    *(CaptureRow.id, CaptureRow.title, CaptureRow.file_name, CaptureRow.companion_name),
    *(CaptureRow.format, CaptureRow.kind, CaptureRow.frames, CaptureRow.rate_hz),
    *(CaptureRow.duration_s, CaptureRow.tracks, CaptureRow.by, CaptureRow.at),
    CaptureRow.fingerprint.is_not(None).label("has_skeleton"),
    CaptureContent.size.label("size_bytes"),
)


def capture_page(db: Session, *, limit: int, offset: int) -> CapturePage:
    """Return a page of the list, newest first, without summaries, which may be long."""
    rows = (
        select(*_COLUMNS)
        .join(CaptureContent, CaptureContent.hash == CaptureRow.content_hash)
        .order_by(CaptureRow.at.desc(), CaptureRow.id)
        .limit(limit)
        .offset(offset)
    )
    total = db.scalars(select(func.count()).select_from(CaptureRow)).one()
    listed = [dict(row) for row in db.execute(rows).mappings()]
    return CapturePage(captures=[CaptureListed.model_validate(row) for row in listed], total=total)


def capture_view(db: Session, capture_id: str) -> CaptureView:
    """Return one capture in full; raise NotFound if there is none with this id."""
    row = capture_by_id(db, capture_id)
    return CaptureView(
        id=row.id,
        title=row.title,
        file_name=row.file_name,
        companion_name=row.companion_name,
        format=row.format,
        kind=row.kind,
        frames=row.frames,
        rate_hz=row.rate_hz,
        duration_s=row.duration_s,
        tracks=row.tracks,
        has_skeleton=row.fingerprint is not None,
        size_bytes=size_of(db, row.content_hash),
        by=row.by,
        at=row.at,
        content_hash=row.content_hash,
        reading=ReadingChoice.model_validate(row.reading),
        summary=CaptureSummary.model_validate(row.summary),
    )
