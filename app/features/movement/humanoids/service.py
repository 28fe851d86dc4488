"""Query the bodies of the lab: lists, single bodies and figures for avatars."""

from functools import lru_cache
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session, defer

from app.errors import NotFound
from app.features.movement.files import size_of
from app.features.movement.humanoids.checks import attention_of, checks_of, reach_off_m
from app.features.movement.humanoids.licences import asked_terms, confirmations_of, licence_of
from app.features.movement.humanoids.schemas import (
    HumanoidListed,
    HumanoidPage,
    HumanoidView,
    PieceView,
)
from app.models import CaptureContent, HumanoidRow
from app.protocol.humanoid import parse_figure
from app.science.avatar.body import Figure

_COLUMNS = (
    *("file_name", "stature_m", "bones_by", "parts", "pieces", "left_fingers", "right_fingers"),
    *("name", "title", "origin", "triangles", "vertices", "textures", "by", "at"),
)


def humanoid_by_hash(db: Session, content_hash: str, *, lock: bool = False) -> HumanoidRow:
    """Return the body with this hash; raise NotFound if there is none.

    `lock` locks its row, so that concurrent writers wait.
    """
    row = db.get(HumanoidRow, content_hash, with_for_update=lock or None)
    if row is None:
        raise NotFound(
            "there is no such humanoid model",
            value=content_hash,
            remedy="Upload its file, or choose one of those that are listed.",
        )
    return row


def figure_by_hash(db: Session, content_hash: str | None) -> Figure | None:
    """Return the figure with this hash, None for None; raise NotFound if there is none."""
    if content_hash is None:
        return None
    return parsed_figure(humanoid_by_hash(db, content_hash).figure)


def body_by_name(db: Session, name: str) -> HumanoidRow:
    """Return the body with this name; raise NotFound if there is none."""
    row = db.scalar(select(HumanoidRow).where(HumanoidRow.name == name))
    if row is None:
        raise NotFound(
            f"there is no body {name!r}",
            value=name,
            valid=sorted(named_bodies(db)),
            remedy="Use one of these names, or name the body on the page Bodies.",
        )
    return row


def named_bodies(db: Session) -> dict[str, str]:
    """Return the hash of every body that has a name, by its name."""
    rows = db.execute(
        select(HumanoidRow.name, HumanoidRow.hash).where(HumanoidRow.name.is_not(None))
    )
    return {str(name): str(content_hash) for name, content_hash in rows}


def is_known(db: Session, content_hash: str) -> bool:
    """Return whether a model with this hash is stored."""
    found = select(HumanoidRow.hash).where(HumanoidRow.hash == content_hash)
    return db.scalar(found) is not None


@lru_cache(maxsize=16)
def parsed_figure(text: str) -> Figure:
    """Return the figure parsed from its stored text."""
    return parse_figure(text)


def humanoid_page(db: Session, *, limit: int, offset: int) -> HumanoidPage:
    """Return a page of the list, newest first, without figures, which are long."""
    rows = (
        select(HumanoidRow, CaptureContent.size)
        .join(CaptureContent, CaptureContent.hash == HumanoidRow.hash)
        .options(defer(HumanoidRow.figure))
        .order_by(HumanoidRow.at.desc(), HumanoidRow.hash)
        .limit(limit)
        .offset(offset)
    )
    total = db.scalars(select(func.count()).select_from(HumanoidRow)).one()
    listed = [HumanoidListed.model_validate(_listed(row, size)) for row, size in db.execute(rows)]
    return HumanoidPage(humanoids=listed, total=total)


def _listed(row: HumanoidRow, size_bytes: int) -> dict[str, Any]:
    """Return what a list shows of a body."""
    off_m = _reach_off_m(row)
    return {
        "content_hash": row.hash,
        **{name: getattr(row, name) for name in _COLUMNS},
        "licence": licence_of(row),
        "attention": attention_of(row.triangles, off_m, asked_terms(row)),
        "reach_off_m": off_m,
        "size_bytes": size_bytes,
    }


_reaches_m: dict[str, float | None] = {}


def _reach_off_m(row: HumanoidRow) -> float | None:
    """Return the measure of a body's figure, which never changes and is slow to parse."""
    if row.hash not in _reaches_m:
        _reaches_m[row.hash] = reach_off_m(parsed_figure(row.figure))
    return _reaches_m[row.hash]


def humanoid_view(db: Session, content_hash: str) -> HumanoidView:
    """Return one humanoid model in full; raise NotFound if there is none with this hash."""
    row = humanoid_by_hash(db, content_hash)
    figure = parsed_figure(row.figure)
    return HumanoidView.model_validate(
        {
            **_listed(row, size_of(db, row.hash)),
            "asked": list(asked_terms(row)),
            "confirmations": confirmations_of(row),
            "checks": list(checks_of(row, figure)),
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
