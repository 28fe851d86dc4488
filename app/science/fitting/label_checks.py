"""Check by anatomy that markers are where their labels say: left and right, front and back.

A fit cannot notice this by its residual: a mirrored person fits as well as a person. From the
labels follow the pelvis' right (from LASI to RASI) and back (from the front markers to the rear
ones), hence its up = back x right; from the body follow its up (from the knees to the pelvis) and
its front (from heels or ankles to toes). In the median over the frames

- the pelvis' up has to point away from the knees, else hip centres would lie above the pelvis;
- the toes of each foot have to point to the front = up x right;
- the legs, the feet and the shoulders have to be in the order of the pelvis, left to right. Feet
  cross a little where people walk as on a line; exchanged ones lie far on the wrong side.

If only the first two fail, left and right are mirrored, as from left-handed axes: the capture is
mirrored back. Anything else is a wrong label, which cannot be mended without guessing.

Before all that, markers have to move like a body: those of one segment keep their distance.
"""

import numpy as np

from app.science.anatomy import (
    Notice,
    Rule,
    backward_foot_notice,
    distance_notice,
    mirrored_notice,
)
from app.science.fitting.landmarks import Landmarks
from app.science.rotations import FloatArray

_CROSSED = -0.15
"""Cosine of the ankles' left-to-right with the pelvis' below which the feet are exchanged."""
_ANKLES_SEEN = 0.5
"""Share of the frames that must show both ankles: in fewer, one posture may cross the feet."""
_SEGMENTS = (
    ("LASI", "RASI"), ("LKNE", "LANK"), ("RKNE", "RANK"), ("LHEE", "LTOE"), ("RHEE", "RTOE"),
    ("LELB", "LWRA"), ("RELB", "RWRA"),
)  # fmt: skip
"""Landmarks at both ends of one segment."""
_RIGID = (
    *_SEGMENTS, ("LHEE", "LANK"), ("RHEE", "RANK"), ("LANK", "LTOE"), ("RANK", "RTOE"),
    ("LHEE", "LMT5"), ("RHEE", "RMT5"), ("LKNE", "LKNM"), ("RKNE", "RKNM"),
    ("LANK", "LANM"), ("RANK", "RANM"),
)  # fmt: skip
"""Landmarks whose distance hardly changes."""
_FEWEST_SEGMENTS = 3
_MOST_VARYING = 0.5
_NEEDED = ("LASI", "RASI", "LKNE", "RKNE", "LANK", "RANK")


def unlike_a_body(marks: Landmarks) -> Notice | None:
    """Return a refusal if the segments' lengths vary over time as no body's do, else None.

    A length varies by the range of the middle 80 % of its values over their median; what counts is
    the median segment, since a single wrong label makes one or two of them vary.
    """
    varying = []
    for one, other in _SEGMENTS:
        if marks.has(one, other):
            lengths_m = np.linalg.norm(marks[one] - marks[other], axis=-1)
            lengths_m = lengths_m[np.isfinite(lengths_m)]
            if len(lengths_m):
                low, middle, high = np.quantile(lengths_m, (0.1, 0.5, 0.9)).tolist()
                varying.append((high - low) / middle if middle > 0.0 else 0.0)
    if len(varying) < _FEWEST_SEGMENTS or float(np.median(varying)) <= _MOST_VARYING:
        return None
    return _refused(
        "These markers do not move like a body: the distances within its segments change.",
        f"a change by {100.0 * float(np.median(varying)):.0f} % of the length (median of"
        f" {len(varying)} segments)",
        f"at most {100.0 * _MOST_VARYING:.0f} %",
        "Check that the labels belong to these markers all the time, and export again.",
        rule="length",
    )


def exchanged_notice(marks: Landmarks) -> Notice | None:
    """Return a notice if labels are exchanged for part of the time, so that lengths jump."""
    lengths = {
        f"{marks.markers[one]} and {marks.markers[other]}": np.linalg.norm(
            marks[one] - marks[other], axis=-1
        )
        for one, other in _RIGID
        if marks.has(one, other)
    }
    return distance_notice(lengths)


def label_notice(marks: Landmarks) -> Notice | None:
    """Return what is wrong with the labels, None where nothing is or legs are not marked.

    The notice is `mended` for mirrored labels, which the caller has to mirror back, else `refused`.
    """
    back = ("LPSI", "RPSI") if marks.has("LPSI", "RPSI") else ("SACR",)
    if not marks.has(*_NEEDED, *back):
        return None
    right = marks["RASI"] - marks["LASI"]
    front = marks.middle("LASI", "RASI")
    pelvis = marks.middle("LASI", "RASI", *back)
    up = pelvis - marks.middle("LKNE", "RKNE")
    order = {"knees": _cosine(marks["RKNE"] - marks["LKNE"], right)}
    if marks.has("LACR", "RACR"):
        order["shoulders"] = _cosine(marks["RACR"] - marks["LACR"], right)
    between = marks["RANK"] - marks["LANK"]
    seen, ankles = np.isfinite(between).all(axis=-1).mean(), _cosine(between, right)
    if ankles < _CROSSED and seen >= _ANKLES_SEEN:
        order["feet"] = ankles
    for part, cosine in order.items():
        if cosine < 0.0:
            return _refused(
                f"Left and right of the {part} are swapped against the pelvis.",
                f"the left-to-right of the {part} is turned by {_degrees(cosine)} from the pelvis'",
                "less than 90 degrees",
                "Exchange the labels of left and right that are wrong, and export again.",
            )
    tilt = _cosine(np.cross(marks.middle(*back) - front, right), up)
    feet = _toes_forward(marks, np.cross(up, right))
    toes = float(np.mean([*feet.values()])) if feet else 1.0
    backwards = [side for side, cosine in feet.items() if cosine < 0.0]
    if len(backwards) == 1 and tilt >= 0.0:
        (side,) = backwards
        return backward_foot_notice(side, _degrees(feet[side]))
    if tilt >= 0.0 and toes >= 0.0:
        return None
    if tilt < 0.0 and toes < 0.0:
        return mirrored_notice(
            f"the pelvis' up is {_degrees(tilt)} from the line from knees to pelvis",
            "less than 90 degrees",
        )
    if tilt < 0.0:
        return _refused(
            "Front and back of the pelvis are swapped: the hip centres would lie above it.",
            f"the pelvis' up is {_degrees(tilt)} from the line from knees to pelvis",
            "less than 90 degrees",
            "Exchange the labels of the front (ASI) and rear (PSI, SACR) markers.",
        )
    return _refused(
        "The feet point backwards.",
        f"toes point {_degrees(toes)} away from the body's front",
        "less than 90 degrees",
        "Exchange the labels of heels and toes.",
        rule="mirrored",
    )


def _toes_forward(marks: Landmarks, front: FloatArray) -> dict[str, float]:
    """Return the cosine between foot and front by side; none without toes, as no evidence."""
    cosines = {}
    for side in ("left", "right"):
        letter = side[0].upper()
        toe = next((name for name in (f"{letter}TOE", f"{letter}MT5") if marks.has(name)), None)
        if toe is not None:
            heel = f"{letter}HEE" if marks.has(f"{letter}HEE") else f"{letter}ANK"
            cosines[side] = _cosine(marks[toe] - marks[heel], front)
    return cosines


def _cosine(a: FloatArray, b: FloatArray) -> float:
    """Return the median cosine between two vectors over the frames that have both."""
    sizes = np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1)
    cosines = np.einsum("ni,ni->n", a, b) / np.where(sizes > 0.0, sizes, np.nan)
    cosines = cosines[np.isfinite(cosines)]
    return float(np.median(cosines)) if len(cosines) else 1.0


def _refused(what: str, value: str, valid: str, remedy: str, rule: Rule = "pelvis") -> Notice:
    return Notice(rule, "refused", what, value, valid, remedy)


def _degrees(cosine: float) -> str:
    return f"{np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))):.0f} degrees"
