"""Check a body before somebody wears it, by its measures and its licence."""

from collections.abc import Iterator, Sequence

from app.features.movement.humanoids.licences import asked_terms, licence_of, term_of
from app.features.movement.humanoids.schemas import BodyCheck
from app.models import HumanoidRow
from app.science.avatar.body import FINGER_PARTS, FINGERS, SIDES, Figure

TRIANGLE_BUDGET = 20_000
"""The most triangles of a body that a standalone headset can draw twice, once in the mirror.

The limit is that of VRChat's lowest accepted performance rank for standalone headsets; its best
rank ends at 7,500 (creators.vrchat.com, Avatar Performance Ranking System).
"""
OUTSIDE_M = 0.006
"""Skin farther outside its hull than this is reported; smooth trunks reach 5 mm."""
_ABOUT_POSE = ("turned upright", "T-pose")
_ABOUT_LENGTHS = ("unusual", "proportions")


def checks_of(row: HumanoidRow, figure: Figure) -> Iterator[BodyCheck]:
    """Yield the checks of a body in the order in which they are shown."""
    absent = [part for part in figure.absent if part not in FINGER_PARTS]
    yield BodyCheck(key="parts", status="note" if absent else "good", parts=absent)
    yield _fingers(figure)
    yield _sentences("rest_pose", figure.notes, _ABOUT_POSE)
    yield _sentences("proportions", figure.notes, _ABOUT_LENGTHS)
    yield _triangles(row.triangles)
    yield _hulls(figure)
    licence = licence_of(row)
    known = licence is not None and bool(licence.name or licence.authors or licence.copyright)
    yield BodyCheck(key="licence", status="good" if known else "unknown")
    yield _wearing(row)


def _fingers(figure: Figure) -> BodyCheck:
    absent = [part for part in figure.absent if part in FINGER_PARTS]
    count = sum(figure.finger_count(side) for side in SIDES)
    complete = len(SIDES) * len(FINGERS)
    return BodyCheck(
        key="fingers",
        status="note" if absent else "good",
        parts=absent,
        value=float(count),
        limit=float(complete),
    )


def _sentences(key: str, notes: Sequence[str], words: Sequence[str]) -> BodyCheck:
    found = [note for note in notes if any(word in note for word in words)]
    return BodyCheck.model_validate(
        {"key": key, "status": "note" if found else "good", "notes": found}
    )


def _triangles(count: int | None) -> BodyCheck:
    limit = float(TRIANGLE_BUDGET)
    if count is None:
        return BodyCheck(key="triangles", status="unknown", limit=limit)
    status = "good" if count <= TRIANGLE_BUDGET else "warn"
    return BodyCheck.model_validate(
        {"key": "triangles", "status": status, "value": float(count), "limit": limit}
    )


def _hulls(figure: Figure) -> BodyCheck:
    """Check for parts without a hull, and for skin far outside its hull."""
    loose = [part for part, piece in figure.pieces.items() if piece.outside_m > OUTSIDE_M]
    parts = [*figure.without_piece, *loose]
    return BodyCheck(
        key="hulls",
        status="note" if parts else "good",
        parts=parts,
        value=max((piece.outside_m for piece in figure.pieces.values()), default=None),
        limit=OUTSIDE_M,
    )


def _wearing(row: HumanoidRow) -> BodyCheck:
    """Check whether the licence lets participants wear the body."""
    if asked_terms(row):
        return BodyCheck(key="wearing", status="warn")
    if term_of(row) is not None:
        # A restriction that was confirmed to be met is a remark, not an obstacle.
        return BodyCheck(key="wearing", status="note")
    licence = licence_of(row)
    everyone = licence is not None and licence.wearers == "everyone"
    return BodyCheck(key="wearing", status="good" if everyone else "unknown")
