"""Sew the right hand: a flat tube from wrist to webs, with four fingers on its end, and the thumb.

A ring of the palm has 28 points: 13 on the back of the hand from the index finger's side to the
little finger's, one at the little finger's side, 13 on the palm and one at the index finger's side.
Its end is divided into the rings of four fingers, ten points each; neighbours share the points of
their web.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from app.science.avatar.body import FINGERS, SEGMENTS, Proportions
from app.science.avatar.mannequin.patchwork import IndexArray, Patchwork, Region
from app.science.avatar.mannequin.tables import TABLE_STATURE_MM, Form
from app.science.rotations import FloatArray

_ROWS = (0.0, 0.12, 0.25, 0.38, 0.52, 0.66, 0.78, 0.9, 1.0)
_THUMB_ROWS: Final = (1, 4)
_BACK = 13
_RING = 28
_FINGER_TURNS = np.radians((144.0, 108.0, 72.0, 36.0, 0.0, -36.0, -72.0, -108.0, -144.0, 180.0))
# Half the thickness of the palm and half its breadth from wrist (0) to webs (1), millimetres.
_PALM = (
    (0.0, 21.0, 29.0), (0.12, 19.5, 30.5), (0.25, 17.5, 33.0), (0.38, 16.0, 35.5),
    (0.52, 15.0, 37.0), (0.66, 14.0, 38.0), (0.78, 13.0, 38.3), (0.9, 11.0, 37.8),
    (1.0, 8.3, 37.0),
)  # fmt: skip
# Half the thickness of each finger, millimetres, and how far the web lies beyond the knuckle, as a
# share of the first segment.
_FINGERS = {"Index": (8.7, 0.38), "Middle": (8.5, 0.42), "Ring": (8.0, 0.42), "Little": (7.4, 0.40)}
_THUMB_MM = 10.2
REGIONS: Mapping[str, Region] = {
    "Thumb": "Thumb", "Index": "Index", "Middle": "Middle", "Ring": "Ring", "Little": "Little",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Hand:
    """The points of a sewn hand: the rings of its palm, and those of every finger."""

    palm: list[IndexArray]
    webs: IndexArray
    fingers: dict[str, IndexArray]


def sew_hand(work: Patchwork, body: Proportions, form: Form, wrist: IndexArray) -> Hand:
    """Sew the right hand onto the wrist's ring, which begins at the lower front."""
    work.region, work.tone = "palm", "skin"
    unit = body.stature_m / TABLE_STATURE_MM
    longer = body.segments_m["hand"] / (0.108 * body.stature_m)
    thick = unit * form.hand * longer
    places = {name: np.array(place) for name, place in body.places_m().items()}
    palm = [work.add(row) for row in _palm(body, places, unit, thick)]
    # The wrist's ring runs from the lower front to the back; the palm's from the upper front.
    around = _from_upper_front(wrist)
    work.strip(palm[0], around, closed=True)
    cols = (25, 26, 27, 0, 1)
    for row in range(len(palm) - 1):
        hole = cols[:-1] if _THUMB_ROWS[0] <= row < _THUMB_ROWS[1] else ()
        work.strip(palm[row + 1], palm[row], closed=True, skip=hole)
    webs = _webs(work, palm[-1], unit)
    fingers = {}
    for number, finger in enumerate(FINGERS[1:]):
        work.region = REGIONS[finger]
        base = _base_ring(palm[-1], webs, number)
        fingers[finger] = _sew_finger(work, body, places, finger, thick, base)
    work.region = "Thumb"
    first, last = _THUMB_ROWS
    hole_edge = np.concatenate(
        (
            [palm[first][number] for number in cols[:-1]],
            [palm[row][cols[-1]] for row in range(first, last)],
            [palm[last][number] for number in reversed(cols[1:])],
            [palm[row][cols[0]] for row in range(last, first, -1)],
        )
    )
    fingers["Thumb"] = _sew_thumb(work, body, places, thick, hole_edge)
    return Hand(palm, webs, fingers)


def _palm(
    body: Proportions, places: dict[str, FloatArray], unit: float, thick: float
) -> list[FloatArray]:
    """Return the rings of the palm, each (28, 3)."""
    wrist = places["RightHand"]
    breadth = body.hand_breadth_m / (0.44 * 0.108 * TABLE_STATURE_MM)
    edges = _finger_edges(places, thick)
    web_z = np.concatenate(
        [np.linspace(edges[n], edges[n + 1], 4)[: 3 if n < 3 else 4] for n in range(4)]
    )
    reach = [_web_x(body, places, finger) for finger in FINGERS[1:]]
    at = np.array([2.0, 5.0, 8.0, 11.0]) - 0.5
    web_x = np.interp(np.arange(_BACK), at, reach)
    rings = []
    for share, (_, half_thick, half_breadth) in zip(_ROWS, _PALM, strict=True):
        middle = share * (edges[0] + edges[-1]) / 2.0
        across = np.linspace(-1.0, 1.0, _BACK)
        z = (1.0 - share**2) * (middle + across * half_breadth * breadth * 0.93)
        z = z + share**2 * web_z
        half = np.abs(across)
        x = wrist[0] + share * (web_x - wrist[0])
        y = half_thick * thick * (1.0 - 0.42 * half**3)
        y_low = half_thick * thick * (1.0 - 0.36 * half**4)
        if share == 1.0:
            y = y_low = half_thick * thick * np.tile((0.62, 1.0, 1.0), 5)[:_BACK]
        back = np.stack((x, wrist[1] + y, z), axis=1)
        front = np.stack((x, wrist[1] - y_low, z), axis=1)
        _shape_palm(back, front, places, share, unit, thick)
        end = 0.93 if share < 1.0 else 1.0
        sides = [
            np.array((x[n], wrist[1], z[n] + sign * 0.40 * half_thick * thick * end))
            for n, sign in ((-1, 1.0), (0, -1.0))
        ]
        rings.append(np.concatenate((back, sides[:1], front[::-1], sides[1:])))
    return rings


def _shape_palm(
    back: FloatArray,
    front: FloatArray,
    places: dict[str, FloatArray],
    share: float,
    unit: float,
    thick: float,
) -> None:
    """Raise the knuckles and the balls of thumb and little finger, and hollow the palm."""
    for finger in FINGERS[1:]:
        knuckle = places[f"Right{finger}Proximal"]
        x, z = (back[:, 0] - knuckle[0]) / unit, (back[:, 2] - knuckle[2]) / unit
        back[:, 1] += 2.4 * thick * np.exp(-((x / 9.0) ** 2) - (z / 6.0) ** 2)
    wrist = places["RightHand"]
    for along, across, high, wide in ((30.0, -20.0, 6.0, 17.0), (34.0, 24.0, 4.0, 16.0),
                                      (52.0, 4.0, -2.5, 18.0)):  # fmt: skip
        x = (front[:, 0] - wrist[0]) / unit - along
        z = front[:, 2] / unit - across
        bump = high * thick * np.exp(-((x / (1.3 * wide)) ** 2) - (z / wide) ** 2)
        front[:, 1] -= bump * (1.0 - share**3)


def _finger_edges(places: dict[str, FloatArray], thick: float) -> list[float]:
    """Return the five positions across the palm between which the four fingers lie."""
    middles = [places[f"Right{finger}Proximal"][2] for finger in FINGERS[1:]]
    between = [(a + b) / 2.0 for a, b in pairwise(middles)]
    first = middles[0] - 0.92 * _FINGERS["Index"][0] * thick
    last = middles[-1] + 0.92 * _FINGERS["Little"][0] * thick
    return [float(first), *map(float, between), float(last)]


def _web_x(body: Proportions, places: dict[str, FloatArray], finger: str) -> float:
    knuckle = places[f"Right{finger}Proximal"][0]
    length = body.joints_m[f"Right{finger}Intermediate"][0]
    return float(knuckle + _FINGERS[finger][1] * length)


def _webs(work: Patchwork, end: IndexArray, unit: float) -> IndexArray:
    """Add the point between each two fingers; return five sides, those of the palm included."""
    points = work.points_m()
    inner = []
    for number in (3, 6, 9):
        top, bottom = points[end[number]], points[end[_RING - 2 - number]]
        inner.append((top + bottom) / 2.0 - (2.5 * unit, 0.0, 0.0))
    middle = work.add(np.array(inner))
    return np.array([end[_RING - 1], *middle, end[_BACK]])


def _base_ring(end: IndexArray, webs: IndexArray, number: int) -> IndexArray:
    top = [int(end[3 * number + step]) for step in range(4)]
    bottom = [int(end[_RING - 2 - 3 * number - step]) for step in (3, 2, 1, 0)]
    return np.array([*top, int(webs[number + 1]), *bottom, int(webs[number])])


def _sew_finger(
    work: Patchwork,
    body: Proportions,
    places: dict[str, FloatArray],
    finger: str,
    thick: float,
    base: IndexArray,
) -> IndexArray:
    joints = [
        places[f"Right{finger}{segment}"] for segment in ("Proximal", "Intermediate", "Distal")
    ]
    tip = joints[2] + np.array(body.ends_m[f"Right{finger}Distal"])
    start = _web_x(body, places, finger)
    radius = _FINGERS[finger][0] * thick
    across = np.array((0.0, 0.0, 1.0))
    cosine, sine = np.cos(_FINGER_TURNS), np.sin(_FINGER_TURNS)
    rings = []
    for x, wide, high in _finger_rings(start, joints[1][0], joints[2][0], tip[0], radius):
        centre = np.array((x, joints[0][1], joints[0][2]))
        ring = centre + np.outer(cosine, across) * wide
        ring[:, 1] += sine * high
        rings.append(ring)
    return _sew_rings(work, base, rings, tip)


def _finger_rings(
    start: float, middle: float, end: float, tip: float, radius: float
) -> list[tuple[float, float, float]]:
    """Return the position along the finger, half breadth and half height of each ring."""
    first, second, third = middle - start, end - middle, tip - end
    rows = (
        (start + 0.22 * first, 1.0, 1.0),
        (start + 0.55 * first, 0.97, 0.97),
        (middle - 0.22 * second, 1.0, 1.0),
        (middle - 0.07 * second, 1.03, 1.04),
        (middle + 0.07 * second, 1.03, 1.03),
        (middle + 0.24 * second, 0.98, 0.96),
        (middle + 0.52 * second, 0.93, 0.90),
        (end - 0.20 * third, 0.94, 0.90),
        (end - 0.02 * third, 0.94, 0.91),
        (end + 0.18 * third, 0.91, 0.87),
        (end + 0.48 * third, 0.88, 0.84),
        (end + 0.74 * third, 0.77, 0.70),
        (end + 0.91 * third, 0.52, 0.45),
    )
    return [(x, wide * radius, high * radius) for x, wide, high in rows]


def _sew_thumb(
    work: Patchwork,
    body: Proportions,
    places: dict[str, FloatArray],
    thick: float,
    hole: IndexArray,
) -> IndexArray:
    joints = [places[f"RightThumb{segment}"] for segment in SEGMENTS]
    tip = joints[2] + np.array(body.ends_m["RightThumbDistal"])
    towards = (tip - joints[0]) / np.linalg.norm(tip - joints[0])
    across = np.array((-towards[2], 0.0, towards[0]))  # from the wrist's side to the fingers'
    turns = np.radians(180.0 + 72.0 - 36.0 * np.arange(10) - 20.0)
    at = [float(np.dot(joint - joints[0], towards)) for joint in (*joints, tip)]
    _, knuckle, joint, end = at
    radius = _THUMB_MM * thick
    rows = (
        (knuckle * 0.80, 1.28, 1.30),
        (knuckle * 0.95, 1.12, 1.14),
        (knuckle + 0.10 * (joint - knuckle), 1.06, 1.06),
        (knuckle + 0.45 * (joint - knuckle), 0.97, 0.95),
        (joint - 0.16 * (end - joint), 1.02, 0.96),
        (joint - 0.02 * (end - joint), 1.04, 0.97),
        (joint + 0.16 * (end - joint), 1.02, 0.93),
        (joint + 0.45 * (end - joint), 1.0, 0.86),
        (joint + 0.72 * (end - joint), 0.86, 0.70),
        (joint + 0.91 * (end - joint), 0.56, 0.44),
    )
    rings = []
    for along, wide, high in rows:
        ring = joints[0] + towards * along + np.outer(np.cos(turns), across) * wide * radius
        ring[:, 1] += np.sin(turns) * high * radius
        rings.append(ring)
    return _sew_rings(work, hole, rings, tip)


def _sew_rings(
    work: Patchwork, base: IndexArray, rings: list[FloatArray], tip: FloatArray
) -> IndexArray:
    numbers, below = [], base
    for ring in rings:
        loop = work.add(ring)
        work.strip(loop, below, closed=True)
        numbers.append(loop)
        below = loop
    pole = work.add(tip[np.newaxis])
    work.close(below[::-1], int(pole[0]), closed=True)
    return np.concatenate((*numbers, pole))


def _from_upper_front(wrist: IndexArray) -> IndexArray:
    """Return the wrist's ring in the order of the palm's: from the upper front over the back."""
    # It begins at the lower front and runs under the arm.
    return np.roll(wrist[::-1], -round(len(wrist) / 6.0) + 1)
