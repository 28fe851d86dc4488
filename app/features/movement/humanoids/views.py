"""Humanoid models as a page sees them."""

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.features.movement.captures.contents import size_of
from app.features.movement.humanoids.schemas import (
    HumanoidListed,
    HumanoidPage,
    HumanoidView,
    PieceView,
)
from app.features.movement.humanoids.service import humanoid_by_hash, parsed_figure
from app.models import CaptureContent, HumanoidRow

_COLUMNS = (
    HumanoidRow.hash.label("content_hash"),
    *(HumanoidRow.file_name, HumanoidRow.stature_m, HumanoidRow.bones_by, HumanoidRow.parts),
    *(HumanoidRow.pieces, HumanoidRow.left_fingers, HumanoidRow.right_fingers),
    *(HumanoidRow.by, HumanoidRow.at, CaptureContent.size.label("size_bytes")),
)


def humanoid_page(db: Session, *, limit: int, offset: int) -> HumanoidPage:
    """A part of the list, the newest first; figures are left out, they are long."""
    rows = (
        select(*_COLUMNS)
        .join(CaptureContent, CaptureContent.hash == HumanoidRow.hash)
        .order_by(HumanoidRow.at.desc(), HumanoidRow.hash)
        .limit(limit)
        .offset(offset)
    )
    total = db.scalars(select(func.count()).select_from(HumanoidRow)).one()
    listed = [dict(row) for row in db.execute(rows).mappings()]
    return HumanoidPage(
        humanoids=[HumanoidListed.model_validate(row) for row in listed], total=total
    )


def humanoid_view(db: Session, content_hash: str) -> HumanoidView:
    """One model in full; raises NotFound."""
    row = humanoid_by_hash(db, content_hash)
    figure = parsed_figure(row.figure)
    return HumanoidView.model_validate(
        {
            "content_hash": row.hash,
            "file_name": row.file_name,
            "size_bytes": size_of(db, row.hash),
            "stature_m": row.stature_m,
            "bones_by": row.bones_by,
            "parts": row.parts,
            "pieces": row.pieces,
            "left_fingers": row.left_fingers,
            "right_fingers": row.right_fingers,
            "by": row.by,
            "at": row.at,
            "present": list(figure.places_m),
            "absent": list(figure.absent),
            "simple": list(figure.without_piece),
            "convex_pieces": [
                PieceView(part=part, corners=len(piece.corners_m), outside_m=piece.outside_m)
                for part, piece in figure.pieces.items()
            ],
            "segments_m": dict(figure.segments_m),
            "notes": list(figure.notes),
        }
    )
