"""Check a body before somebody wears it, by its measures and its licence."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict

from app.features.movement.humanoids.licences import asked_terms, licence_of, term_of
from app.features.movement.humanoids.schemas import (
    BodyCheck,
    CheckedLength,
    CheckKey,
    CheckStatus,
    LengthName,
    Term,
)
from app.models import HumanoidRow
from app.science.avatar.body import FINGER_PARTS, FINGERS, SIDES, Figure
from app.science.rotations import identity
from app.science.skeleton import JOINT_COUNT, JOINT_INDEX, build_skeleton, forward_kinematics

TRIANGLE_BUDGET = 20_000
"""The most triangles of a body that a standalone headset can draw twice, once in the mirror.

The limit is that of VRChat's lowest accepted performance rank for standalone headsets; its best
rank ends at 7,500 (creators.vrchat.com, Avatar Performance Ranking System).
"""
OUTSIDE_M = 0.006
"""Skin farther outside its hull than this is reported; smooth trunks reach 5 mm."""
_ABOUT_POSE = ("turned upright", "T-pose")
_ABOUT_SIZE = ("only the proportions are used",)
HALF_BOX_M = 0.09
"""Half the width of a box of the shipped hand task: a hand farther off misses the box."""
REACH_STATURE_M = 1.7
TELLING_M = 0.01
"""A length that differs by more from a person's is told as a reason for a hand that is off."""


def checks_of(row: HumanoidRow, figure: Figure) -> Iterator[BodyCheck]:
    """Yield the checks of a body in the order in which they are shown."""
    absent = [part for part in figure.absent if part not in FINGER_PARTS]
    yield BodyCheck(key="parts", status="note" if absent else "good", parts=absent)
    yield _fingers(figure)
    yield _sentences("rest_pose", figure.notes, _ABOUT_POSE)
    yield _proportions(figure)
    yield _reach(figure)
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


def _proportions(figure: Figure) -> BodyCheck:
    """Name the lengths that are unusual for the model's stature, with the range of usual ones."""
    lengths = [CheckedLength.model_validate(asdict(one)) for one in figure.unusual_lengths()]
    notes = [note for note in figure.notes if any(word in note for word in _ABOUT_SIZE)]
    return BodyCheck(
        key="proportions",
        status="note" if lengths or notes else "good",
        lengths=lengths,
        stature_m=figure.stature_m,
        notes=notes,
    )


def reach_off_m(figure: Figure) -> float | None:
    """Return how far a body's hand is from that of a participant who reaches straight ahead, m.

    Both are `REACH_STATURE_M` tall, and the body copies the angles of the participant's joints,
    whose lengths are the published ones of the product's skeleton. The larger one of both hands;
    None if the body lacks an arm.
    """
    arms = _arms(figure)
    if arms is None:
        return None
    return round(max(math.dist(_reaching(own), _reaching(body)) for own, body in arms), 4)


_Arm = Sequence[Sequence[float]]
"""Where shoulder, elbow and wrist are in the T-pose, m."""


def _arms(figure: Figure) -> list[tuple[_Arm, _Arm]] | None:
    """Return, left and right, a person's arm and the body's, both `REACH_STATURE_M` tall."""
    own, body = build_skeleton(REACH_STATURE_M), figure.scaled(REACH_STATURE_M).places_m
    standing = forward_kinematics(own, own.offsets_m[0], identity(JOINT_COUNT)).positions_m
    arms: list[tuple[_Arm, _Arm]] = []
    for side in SIDES:
        names = (f"{side}UpperArm", f"{side}LowerArm", f"{side}Hand")
        if any(name not in body for name in names):
            return None
        mine = [standing[JOINT_INDEX[name]].tolist() for name in names]
        arms.append((mine, [body[name] for name in names]))
    return arms


def _reaching(arm: _Arm) -> tuple[float, float, float]:
    """Return where the wrist is when the arm is stretched ahead, along -z, from the shoulder."""
    (x, y, z), _, _ = arm
    return (x, y, z - _length(arm))


def _length(arm: _Arm) -> float:
    shoulder, elbow, wrist = arm
    return math.dist(shoulder, elbow) + math.dist(elbow, wrist)


def _reach_lengths(figure: Figure) -> list[CheckedLength]:
    """Return what differs from a person's, the largest difference first: arm and shoulders."""
    arms = _arms(figure)
    if arms is None:
        return []
    (own_left, left), (own_right, right) = arms
    compared: dict[LengthName, tuple[float, float]] = {
        "arm": (
            (_length(left) + _length(right)) / 2,
            (_length(own_left) + _length(own_right)) / 2,
        ),
        "shoulders": (right[0][0] - left[0][0], own_right[0][0] - own_left[0][0]),
        "shoulder_height": ((left[0][1] + right[0][1]) / 2, (own_left[0][1] + own_right[0][1]) / 2),
    }
    lengths = [CheckedLength(name=name, length_m=a, usual_m=b) for name, (a, b) in compared.items()]
    telling = [one for one in lengths if abs(one.length_m - one.usual_m) > TELLING_M]
    return sorted(telling, key=lambda one: -abs(one.length_m - one.usual_m))


def _reach(figure: Figure) -> BodyCheck:
    off_m = reach_off_m(figure)
    if off_m is None:
        return BodyCheck(key="reach", status="unknown", limit=HALF_BOX_M)
    status: CheckStatus = "warn" if off_m > HALF_BOX_M else "good"
    return BodyCheck(
        key="reach",
        status=status,
        value=off_m,
        limit=HALF_BOX_M,
        lengths=_reach_lengths(figure) if status == "warn" else [],
        stature_m=REACH_STATURE_M,
    )


def attention_of(
    triangles: int | None, off_m: float | None, asked: Sequence[Term]
) -> list[CheckKey]:
    """Return the checks of a body that ask for attention, in the order in which they are shown."""
    found: list[CheckKey] = []
    if off_m is not None and off_m > HALF_BOX_M:
        found.append("reach")
    if triangles is not None and triangles > TRIANGLE_BUDGET:
        found.append("triangles")
    if asked:
        found.append("wearing")
    return found


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
