"""Sew a closed mesh from loops of points: strips between loops, holes, and poles.

One half of the body is sewn, the side of positive x; points of the seam have x = 0. The other half
is its mirror image, so left and right are equal to the last bit. Which points are connected depends
on counts only, never on where they are: bodies of all proportions have the same triangles.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray

IndexArray = npt.NDArray[np.int64]
Tone = Literal["skin", "shirt", "trousers"]
TONES: tuple[Tone, ...] = ("skin", "shirt", "trousers")
Region = Literal[
    "trunk", "head", "arm", "leg", "foot", "palm", "Thumb", "Index", "Middle", "Ring", "Little"
]


@dataclass(frozen=True, eq=False)
class Sewn:
    """A closed, mirrored mesh.

    Attributes:
        points_m: (V, 3) places; the first `half_count` are the half that was sewn.
        triangles: (T, 3) counter-clockwise seen from outside.
        mirrored: (V,) the point on the other side; itself on the seam.
        half_count: the number of points of the half with x >= 0.
        tones: (T,) index in `TONES` of each triangle.
        regions: the region of each point of that half.
        sewn: the number that each point of that half had while it was sewn.
    """

    points_m: FloatArray
    triangles: IndexArray
    mirrored: IndexArray
    half_count: int
    tones: IndexArray
    regions: npt.NDArray[np.str_]
    sewn: IndexArray

    def symmetric(self, values: FloatArray) -> FloatArray:
        """Return the mesh's places with those of the sewn half repeated on the other side."""
        half = values[: self.half_count].copy()
        seam = self.mirrored[: self.half_count] == np.arange(self.half_count)
        half[seam, 0] = 0.0
        other = np.arange(self.half_count, len(values))
        return np.concatenate((half, half[self.mirrored[other]] * (-1.0, 1.0, 1.0)))


class Patchwork:
    """The half of a mesh while it is sewn.

    Attributes:
        region: the region of the points that are added from now on.
        tone: the tone of the triangles that are sewn from now on.
    """

    def __init__(self) -> None:
        self.region: Region = "trunk"
        self.tone: Tone = "skin"
        self._points: list[FloatArray] = []
        self._triangles: list[tuple[int, int, int]] = []
        self._count = 0
        self._tones: list[int] = []
        self._regions: list[Region] = []

    def add(self, points: FloatArray) -> IndexArray:
        """Add (N, 3) points; return their numbers."""
        self._points.append(np.asarray(points, dtype=np.float64))
        first, self._count = self._count, self._count + len(points)
        self._regions += [self.region] * len(points)
        return np.arange(first, self._count)

    def points_m(self) -> FloatArray:
        """Return all points so far, (V, 3)."""
        return np.concatenate(self._points)

    def strip(
        self,
        first: Sequence[int] | IndexArray,
        second: Sequence[int] | IndexArray,
        *,
        closed: bool,
        skip: Sequence[int] = (),
    ) -> None:
        """Connect two loops that run the same way, of equal or different numbers of points.

        Seen from outside with the second loop above the first, the loops run to the right. `skip`
        are the edges of loops of equal length at which a hole stays open.
        """
        low = [int(number) for number in first] + ([int(first[0])] if closed else [])
        high = [int(number) for number in second] + ([int(second[0])] if closed else [])
        steps_low, steps_high = len(low) - 1, len(high) - 1
        at_low = at_high = 0
        while at_low < steps_low or at_high < steps_high:
            hole = steps_low == steps_high and at_low in skip
            # Advance the loop that is behind; both are compared at the middle of their next step.
            low_first = (2 * at_low + 1) * steps_high <= (2 * at_high + 1) * steps_low
            if at_high == steps_high or (at_low < steps_low and low_first):
                triangle = (low[at_low], low[at_low + 1], high[at_high])
                at_low += 1
            else:
                hole = steps_low == steps_high and at_high in skip
                triangle = (low[at_low], high[at_high + 1], high[at_high])
                at_high += 1
            if not hole:
                self._sew(triangle)

    def close(self, loop: IndexArray, pole: int, *, closed: bool) -> None:
        """Close the opening above a loop by triangles to one point."""
        around = [int(number) for number in loop] + ([int(loop[0])] if closed else [])
        for start, end in pairwise(around):
            self._sew((start, end, pole))

    def _sew(self, triangle: tuple[int, int, int]) -> None:
        self._triangles.append(triangle)
        self._tones.append(TONES.index(self.tone))

    def mirrored(self) -> Sewn:
        """Return the whole mesh: this half and its mirror image, joined along the seam."""
        half = np.array(self._triangles, dtype=np.int64)
        sewn, numbers = np.unique(half, return_inverse=True)  # points inside holes are left out
        half = numbers.reshape(half.shape)
        points = self.points_m()[sewn]
        on_seam = points[:, 0] == 0.0
        other = np.arange(len(points))
        other[~on_seam] = len(points) + np.arange(int((~on_seam).sum()))
        return Sewn(
            np.concatenate((points, points[~on_seam] * (-1.0, 1.0, 1.0))),
            np.concatenate((half[:, ::-1], other[half])),
            np.concatenate((other, np.flatnonzero(~on_seam))),
            len(points),
            np.tile(np.array(self._tones), 2),
            np.array(self._regions)[sewn],
            sewn,
        )


def neighbours(triangles: IndexArray, count: int) -> tuple[IndexArray, IndexArray]:
    """Return every pair of connected points, both ways, as rows and columns in ascending order."""
    pairs = np.concatenate([triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
    both = np.unique(np.concatenate((pairs, pairs[:, ::-1])) @ np.array((count, 1)))
    return both // count, both % count


def averages(rows: IndexArray, columns: IndexArray, values: FloatArray) -> FloatArray:
    """Return the mean of each point's neighbours, (V, width)."""
    starts = np.searchsorted(rows, np.arange(len(values)))
    sums: FloatArray = np.add.reduceat(values[columns], starts, axis=0)
    return sums / np.bincount(rows, minlength=len(values))[:, np.newaxis]
