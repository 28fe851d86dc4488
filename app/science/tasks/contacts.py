"""Detect which body parts touch which surfaces: capsules against axis-aligned blocks.

A body part is a capsule: all points within `radius` of a segment. It touches a block when the exact
distance between segment and block is at most its radius. World frame, metres.

Two cheap tests come first, because a body is usually far from all surfaces: whether the part's
bounding box meets the one box around *all* surfaces, and then whether it meets *this* surface.

A contact that flickers at its edge would be counted many times. So a contact that has begun may
continue until the part is `release_margin_m` further away than where it began (hysteresis).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from app.science.tasks.surfaces import TaskLayout

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

# Limits the pair table of the batched form to a few megabytes.
_FRAMES_AT_ONCE = 256


@dataclass(frozen=True)
class SurfaceArrays:
    """A layout's surfaces as arrays. `low_m`, `high_m`: (S, 3) corners, world frame."""

    keys: tuple[str, ...]
    low_m: Floats
    high_m: Floats

    @classmethod
    def of(cls, layout: TaskLayout) -> "SurfaceArrays":
        """Return the corners of every surface of a layout, in the layout's order."""
        center = np.array([surface.center_m for surface in layout.surfaces])
        half = np.array([surface.half_size_m for surface in layout.surfaces])
        keys = tuple(surface.key for surface in layout.surfaces)
        return cls(keys, center - half, center + half)

    @cached_property
    def bounds_m(self) -> tuple[Floats, Floats]:
        """The lower and upper corner, (3,) each, of the box around all surfaces."""
        return self.low_m.min(axis=0), self.high_m.max(axis=0)

    @cached_property
    def with_bounds_m(self) -> tuple[Floats, Floats]:
        """The corners of every surface and, last, of the box around all of them, (S + 1, 3)."""
        low_m, high_m = self.bounds_m
        return np.vstack((self.low_m, low_m)), np.vstack((self.high_m, high_m))


def touching(arrays: SurfaceArrays, segments_m: Floats, radii_m: Floats) -> Bools:
    """Return which parts touch which surfaces in one frame: bool (S, P).

    `segments_m`: (P, 2, 3) start and end of each part; `radii_m`: (P,). World frame, metres.
    Raises ValueError if the shapes do not fit.
    """
    return touching_and_near(arrays, segments_m, radii_m, 0.0)[0]


def touching_and_near(
    arrays: SurfaceArrays, segments_m: Floats, radii_m: Floats, release_margin_m: float
) -> tuple[Bools, Bools]:
    """Return the contacts of one frame, and the pairs that are near enough to continue a contact.

    Both results are bool (S, P). Arguments as in `touching`; `release_margin_m` >= 0. Raises
    ValueError if the shapes do not fit.
    """
    from app.science.tasks.contacts_kernels import contacts_of_frame  # loads the compiler

    n_parts = _check(segments_m, radii_m, release_margin_m, 3)
    is_touching = np.zeros((len(arrays.keys), n_parts), dtype=np.bool_)
    is_near = is_touching.copy()
    low_m, high_m = arrays.with_bounds_m
    contacts_of_frame(low_m, high_m, segments_m, radii_m, release_margin_m, is_touching, is_near)
    return is_touching, is_near


def touching_frames(
    arrays: SurfaceArrays, segments_m: Floats, radii_m: Floats, release_margin_m: float = 0.0
) -> tuple[Bools, Bools]:
    """Return the results of `touching_and_near` for N frames: two arrays, bool (N, S, P).

    `segments_m`: (N, P, 2, 3); `radii_m`: (P,). Raises ValueError if the shapes do not fit.
    """
    n_parts = _check(segments_m, radii_m, release_margin_m, 4)
    shape = (len(segments_m), len(arrays.keys), n_parts)
    is_touching, is_near = np.zeros(shape, dtype=np.bool_), np.zeros(shape, dtype=np.bool_)
    for first in range(0, len(segments_m), _FRAMES_AT_ONCE):
        chunk = segments_m[first : first + _FRAMES_AT_ONCE]
        radii = np.tile(radii_m, len(chunk))
        pairs = _near_pairs(arrays, chunk.reshape(-1, 2, 3), radii, release_margin_m)
        if pairs is None:
            continue
        surface, item, distance_m = pairs
        frame, part = first + item // n_parts, item % n_parts
        is_touching[frame, surface, part] = distance_m <= radii[item]
        is_near[frame, surface, part] = distance_m <= radii[item] + release_margin_m
    return is_touching, is_near


def segment_box_distance_m(start: Floats, end: Floats, low: Floats, high: Floats) -> Floats:
    """Return the exact distances between K segments and K axis-aligned boxes: (K, 3) x 4 -> (K,).

    Along the segment p(t) = start + t (end - start) the squared distance is convex and piecewise
    quadratic: its pieces meet where p crosses a face plane. So half its derivative,

        s(t) = (p - clip(p)) . (end - start),

    increases monotonically and is linear between these crossings: the last one with s <= 0 and the
    first one with s >= 0 enclose the minimum, which linear interpolation between them gives
    exactly.
    """
    along = end - start
    t = np.zeros((len(start), 8))
    t[:, 7] = 1.0
    moving = along != 0.0
    with np.errstate(
        over="ignore"
    ):  # a nearly parallel plane is crossed "at infinity", clipped below
        np.divide(low - start, along, out=t[:, 1:4], where=moving)
        np.divide(high - start, along, out=t[:, 4:7], where=moving)
    np.clip(t, 0.0, 1.0, out=t)
    point = start[:, None] + t[:, :, None] * along[:, None]
    point -= np.clip(point, low[:, None], high[:, None])
    slope = np.einsum("kti,ki->kt", point, along)
    falling, rising = slope <= 0.0, slope >= 0.0
    t_low, t_high = np.where(falling, t, 0.0).max(1), np.where(rising, t, 1.0).min(1)
    s_low, s_high = np.where(falling, slope, -np.inf).max(1), np.where(rising, slope, np.inf).min(1)
    enclosed = np.isfinite(s_low) & np.isfinite(s_high) & (s_high > s_low)
    share = np.divide(-s_low, s_high - s_low, out=np.zeros_like(s_low), where=enclosed)
    # If the distance only increases, the minimum is at 0; if it only decreases, at 1. t_low is
    # the minimum in both cases.
    best = t_low + share * (t_high - t_low)
    nearest = start + best[:, None] * along
    nearest -= np.clip(nearest, low, high)
    distance: Floats = np.sqrt(np.einsum("ki,ki->k", nearest, nearest))
    return distance


def _near_pairs(
    arrays: SurfaceArrays, segments_m: Floats, radii_m: Floats, margin_m: float
) -> tuple[NDArray[np.intp], NDArray[np.intp], Floats] | None:
    """Return surface index, item index and distance of pairs whose bounding boxes meet, or None."""
    start, end = segments_m[:, 0], segments_m[:, 1]
    reach = (radii_m + margin_m)[:, None]
    low, high = np.minimum(start, end) - reach, np.maximum(start, end) + reach
    all_low, all_high = arrays.bounds_m
    items = np.flatnonzero(((low <= all_high) & (high >= all_low)).all(axis=1))
    if not len(items):
        return None
    low, high = low[items], high[items]
    meet = (arrays.low_m[:, None] <= high) & (arrays.high_m[:, None] >= low)
    surface, near_item = np.nonzero(meet.all(axis=2))
    if not len(surface):
        return None
    item = items[near_item]
    distance_m = segment_box_distance_m(
        start[item], end[item], arrays.low_m[surface], arrays.high_m[surface]
    )
    return surface, item, distance_m


def _check(segments_m: Floats, radii_m: Floats, margin_m: float, n_dim: int) -> int:
    """Return the number of parts; raise ValueError if the shapes do not fit."""
    if segments_m.ndim != n_dim or segments_m.shape[-2:] != (2, 3):
        expected = "(P, 2, 3)" if n_dim == 3 else "(N, P, 2, 3)"
        raise ValueError(f"Expected segments of shape {expected}, got {segments_m.shape}.")
    n_parts: int = segments_m.shape[-3]
    if radii_m.shape != (n_parts,):
        raise ValueError(f"Expected one radius per part: ({n_parts},), got {radii_m.shape}.")
    if not margin_m >= 0.0:
        raise ValueError(f"release_margin_m is {margin_m}. Give 0 (no hysteresis) or more metres.")
    return n_parts
