"""Sew the trunk with its neck, and the head: level sections from the legs up to the crown.

A section is a superellipse whose front, side and back may lie at different heights. Columns run
from the middle of the front (0) over the side to the middle of the back; a block of columns and
rows at the shoulder stays open for the arm.
"""

from typing import Final

import numpy as np

from app.science.avatar.body import Proportions
from app.science.avatar.mannequin.patchwork import IndexArray, Patchwork
from app.science.avatar.mannequin.tables import TABLE_STATURE_MM, Form
from app.science.rotations import FloatArray

COLUMNS: Final = 16
ARM_COLUMNS, ARM_ROWS = (5, 11), (12, 15)
"""The block of the trunk's grid where the arm begins: first and last column and row."""
CROTCH_POINTS: Final = 3
NECK_ROW: Final = 18
WAIST_ROW: Final = 4
"""The rows of the trunk at the collar, and where the shirt ends."""
_HEAD_DEG = (0, 4, 8.5, 13.5, 19, 26, 34, 43, 53, 63, 73, 82, 89, 96, 103, 110, 119, 131, 145, 162,
             180)  # fmt: skip
# Standard heights of the joints, as fractions of the stature, to which the tables belong.
_LANDMARKS = (
    "LeftUpperLeg",
    "Hips",
    "Spine",
    "Chest",
    "UpperChest",
    "LeftShoulder",
    "Neck",
    "Head",
)
_STANDARD = (0.0, 0.530, 0.545, 0.585, 0.655, 0.725, 0.810, 0.835, 0.875, 1.0)


class Heights:
    """Convert heights of the tables to those of a person whose joints lie elsewhere."""

    def __init__(self, body: Proportions) -> None:
        places = body.places_m()
        top = places["Head"][1] + body.ends_m["Head"][1]
        self._actual = np.array((0.0, *(places[name][1] for name in _LANDMARKS), top))
        self._standard = np.array(_STANDARD) * body.stature_m

    def __call__(self, heights: FloatArray) -> FloatArray:
        """Return the person's heights that correspond to these heights of the tables."""
        moved: FloatArray = np.interp(heights, self._standard, self._actual)
        return moved


def sew_trunk(work: Patchwork, body: Proportions, form: Form) -> tuple[IndexArray, IndexArray]:
    """Sew the trunk; return its grid (rows, columns) and the crotch's points, back to front."""
    unit = body.stature_m / TABLE_STATURE_MM
    heights = Heights(body)
    turns = np.radians(np.linspace(0.0, 180.0, COLUMNS + 1))
    rows = [_section(row, turns, unit) for row in form.trunk]
    points = np.array(rows)
    points[..., 0] *= _breadths(body, points[..., 1])
    points[..., 1] = heights(points[..., 1].ravel()).reshape(points.shape[:2])
    _shape_chest(points, form, unit, heights)
    grid = np.array([work.add(row) for row in points])
    for low in range(len(grid) - 1):
        work.tone = "trousers" if low < WAIST_ROW else "shirt" if low < NECK_ROW else "skin"
        hole = range(*ARM_COLUMNS) if ARM_ROWS[0] <= low < ARM_ROWS[1] else ()
        work.strip(grid[low], grid[low + 1], closed=False, skip=hole)
    front, back = points[0, 0], points[0, -1]
    share = np.linspace(1.0, 0.0, CROTCH_POINTS + 2)[1:-1, np.newaxis]
    crotch = front + share * (back - front)
    crotch[:, 1] -= unit * 22.0 * np.sin(np.pi * share[:, 0])
    crotch[:, 0] = 0.0
    return grid, work.add(crotch)


def arm_hole(grid: IndexArray) -> IndexArray:
    """Return the edge of the hole for the arm, from its lower front corner along the bottom."""
    (left, right), (low, high) = ARM_COLUMNS, ARM_ROWS
    return np.concatenate(
        (
            grid[low, left:right],
            grid[low:high, right],
            grid[high, right:left:-1],
            grid[high:low:-1, left],
        )
    )


def sew_head(work: Patchwork, body: Proportions, form: Form, neck: IndexArray) -> IndexArray:
    """Sew the head onto the neck's loop; return the numbers of its points."""
    from scipy.interpolate import PchipInterpolator

    work.region, work.tone = "head", "skin"
    unit = body.stature_m / TABLE_STATURE_MM
    turns = np.radians(np.array(_HEAD_DEG))
    table = np.concatenate((form.head, np.zeros((len(form.head), 2))), axis=1)
    control = np.arange(len(table), dtype=np.float64)
    steps = np.concatenate(
        (
            (0.0, 1.0, 2.0, 2.5, 3.0, 3.4, 3.7),
            np.arange(4.0, 5.01, 0.33),
            np.arange(5.4, 9.01, 0.45),
            np.arange(10.0, 15.0),
        )
    )
    sections = PchipInterpolator(control, table, axis=0)(steps)
    points = np.array([_section(row, turns, unit) for row in sections])
    _shape_face(points, form, unit)
    places = body.places_m()
    stretched = body.ends_m["Head"][1] / (0.125 * body.stature_m)
    points[..., 1] = Heights(body)(points[..., 1].ravel()).reshape(points.shape[:2])
    above = np.clip((points[..., 1] - places["Head"][1]) / (20.0 * unit) + 1.0, 0.0, 1.0)
    points[..., 0] *= 1.0 + above * (stretched - 1.0)
    points[..., 2] *= 1.0 + above * (stretched - 1.0)
    below, numbers = neck, []
    for row in points:
        loop = work.add(row)
        work.strip(below, loop, closed=False)
        numbers.append(loop)
        below = loop
    top = np.array([[0.0, places["Head"][1] + body.ends_m["Head"][1], 0.0]])
    pole = work.add(top)
    half = work.add(0.5 * points[-1][::2] + 0.5 * top + (0.0, 0.25, 0.0) * (top - points[-1][::2]))
    work.strip(below, half, closed=False)
    work.close(half, int(pole[0]), closed=False)
    return np.concatenate((*numbers, half, pole))


def _section(row: FloatArray, turns: FloatArray, unit: float) -> FloatArray:
    """Return the points of one section, (N, 3), at angles from the front over the side."""
    front, side, back, half, before, behind, square, dent_front, dent_back = row
    sine, cosine = np.sin(turns), np.cos(turns)
    ahead = cosine > 0.0
    x = half * np.abs(sine) ** (2.0 / square)
    depth = np.where(ahead, before, behind) * np.abs(cosine) ** (2.0 / square)
    dent = np.where(ahead, dent_front, dent_back) * np.exp(-((x / (42.0 * unit)) ** 2))
    y = side + np.where(ahead, front - side, back - side) * cosine**2
    z = np.where(ahead, -1.0, 1.0) * depth * (1.0 - dent)
    x[np.abs(sine) < 1e-9] = 0.0
    return np.stack((x, y, z), axis=1)


def _breadths(body: Proportions, heights: FloatArray) -> FloatArray:
    """Return the factors on the breadth: that of the hips below, of the shoulders above."""
    hips = body.segments_m["hips"] / (0.100 * body.stature_m)
    shoulders = body.segments_m["shoulders"] / (0.258 * body.stature_m)
    share = np.clip((heights / body.stature_m - 0.56) / (0.74 - 0.56), 0.0, 1.0)
    factors: FloatArray = hips + share * (shoulders - hips)
    return factors


def _shape_chest(points: FloatArray, form: Form, unit: float, heights: Heights) -> None:
    for height, apart, out, wide, high in (
        (1262.0, 78.0, form.bust_m, 46.0, 46.0),
        (1300.0, 84.0, form.chest_m, 62.0, 42.0),
    ):
        middle = float(heights(np.array((height * unit,)))[0])
        x, y = points[..., 0] - apart * unit, points[..., 1] - middle
        bump = out * np.exp(-((x / (wide * unit)) ** 2) - (y / (high * unit)) ** 2)
        points[..., 2] -= np.where(points[..., 2] < 0.0, bump, 0.0)


# The face: middle of each form (x, y), how far it stands out, its width and its height.
_FACE = (
    (0.0, 1529.0, 5.0, 21.0, 12.0),  # chin
    (0.0, 1545.5, -2.5, 26.0, 5.5),  # below the lip
    (0.0, 1554.0, 4.5, 23.0, 5.0),  # lower lip
    (0.0, 1563.5, 4.5, 24.0, 5.0),  # upper lip
    (31.0, 1627.0, -8.5, 15.0, 11.0),  # eye sockets
    (31.0, 1626.0, 3.5, 9.0, 7.0),  # eyes
    (46.0, 1596.0, 3.5, 19.0, 16.0),  # cheek bones
    (0.0, 1634.0, -2.0, 12.0, 10.0),  # root of the nose
)


def _shape_face(points: FloatArray, form: Form, unit: float) -> None:
    """Make brow, nose, lips, chin and ears stand out, and set the eyes deep."""
    front = points[..., 2] < 0.0
    x, y = points[..., 0] / unit, points[..., 1] / unit
    out = np.zeros_like(x)
    for middle_x, middle_y, high, wide, tall in _FACE:
        out += high * np.exp(-(((x - middle_x) / wide) ** 2) - ((y - middle_y) / tall) ** 2)
    out += form.brow_m / unit * np.exp(-((x / 46.0) ** 4) - ((y - 1648.0) / 10.0) ** 2)
    # The nose becomes wider and higher from its root to its tip.
    down = np.clip((1640.0 - y) / (1640.0 - 1584.0), 0.0, 1.0)
    tip = np.where(y < 1584.0, np.exp(-(((1584.0 - y) / 6.5) ** 2)), 1.0)
    out += (3.0 + 19.0 * down**1.3) * tip * (down > 0.0) * np.exp(-((x / (7.0 + 5.0 * down)) ** 2))
    points[..., 2] -= np.where(front, out, 0.0) * unit
    # An ear: a shell behind the jaw, highest at its rear edge.
    z = points[..., 2] / unit
    reach = np.exp(-(((z - 13.0) / 14.0) ** 4) - ((y - 1622.0 + 0.1 * z) / 30.0) ** 4)
    shell = reach * np.clip((z + 2.0) / 18.0, 0.0, 1.0) * (x > 40.0)
    points[..., 0] += 20.0 * shell * unit
    points[..., 2] += 8.0 * shell * unit
