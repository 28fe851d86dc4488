"""Make a figure: a closed skin around the 52 parts of a person of any proportions.

Trunk, limbs, head, feet and hands are sewn from sections around the bones; where limbs begin the
skin is smoothed; then every point is assigned the parts that move it. The steps are fixed and
involve no choice by size, so the same proportions give the same figure everywhere.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from app.science.avatar.body import Population, Proportions
from app.science.avatar.mannequin.hand import sew_hand
from app.science.avatar.mannequin.limbs import sew_arm, sew_leg
from app.science.avatar.mannequin.patchwork import (
    IndexArray,
    Patchwork,
    Sewn,
    averages,
    neighbours,
)
from app.science.avatar.mannequin.tables import form_of
from app.science.avatar.mannequin.trunk import ARM_COLUMNS, ARM_ROWS, arm_hole, sew_head, sew_trunk
from app.science.avatar.mannequin.weights import weights_of
from app.science.rotations import FloatArray

_ROUNDS: Final = 6


@dataclass(frozen=True, eq=False)
class Mannequin:
    """A skinned figure in the T-pose; frames as in `app.science.avatar.body.parts`.

    Attributes:
        body: the bones it is made around.
        points_m: (V, 3) the skin, soles at height zero; no point occurs twice.
        normals: (V, 3) unit vectors outwards.
        triangles: (T, 3) counter-clockwise seen from outside; the surface is closed.
        tones: (T,) index in `TONES` of what covers each triangle.
        parts: (V, 4) the parts that move each point, as indices in `PART_NAMES`.
        weights: (V, 4) by how much, in descending order; they add up to one.
        mirrored: (V,) the point at the same place of the other side.
    """

    body: Proportions
    points_m: FloatArray
    normals: FloatArray
    triangles: IndexArray
    tones: IndexArray
    parts: IndexArray
    weights: FloatArray
    mirrored: IndexArray


def make_mannequin(body: Proportions, population: Population = "average") -> Mannequin:
    """Make the figure of a person of these proportions, with the forms of a population."""
    form = form_of(population, body.stature_m)
    work = Patchwork()
    grid, crotch = sew_trunk(work, body, form)
    sew_head(work, body, form, grid[-1])
    arm = sew_arm(work, body, form, arm_hole(grid))
    sew_hand(work, body, form, arm[-1])
    leg = sew_leg(work, body, form, grid, crotch)
    mesh = work.mirrored()
    smoothed = _joined(mesh, _where_limbs_begin(mesh, grid, crotch, arm, leg))
    parts, weights = weights_of(mesh, body)
    return Mannequin(
        body,
        smoothed,
        _normals(mesh, smoothed),
        mesh.triangles,
        mesh.tones,
        parts,
        weights,
        mesh.mirrored,
    )


def _where_limbs_begin(
    mesh: Sewn,
    grid: IndexArray,
    crotch: IndexArray,
    arm: list[IndexArray],
    leg: list[IndexArray],
) -> FloatArray:
    """Return how strongly each point is smoothed, (V, 1): most where limbs begin."""
    strength = np.zeros(int(mesh.sewn[-1]) + 1)
    (left, right), (low, high) = ARM_COLUMNS, ARM_ROWS
    strength[grid[low - 2 : high + 3, left - 2 : right + 3]] = 0.25
    strength[grid[low - 1 : high + 2, left - 1 : right + 2]] = 0.5
    strength[grid[1:3]], strength[grid[0]], strength[crotch] = 0.35, 0.6, 0.6
    for rings in (arm, leg):
        for ring, share in zip(rings[:4], (0.6, 0.6, 0.45, 0.2), strict=True):
            strength[ring] = share
    strength = strength[mesh.sewn]
    other = np.arange(mesh.half_count, len(mesh.points_m))
    return np.concatenate((strength, strength[mesh.mirrored[other]]))[:, np.newaxis]


def _joined(mesh: Sewn, strength: FloatArray) -> FloatArray:
    """Return the points after smoothing, which moves each towards the middle of its neighbours."""
    rows, columns = neighbours(mesh.triangles, len(mesh.points_m))
    points = mesh.points_m.copy()
    for _ in range(_ROUNDS):
        points += strength * (averages(rows, columns, points) - points)
        points = mesh.symmetric(points)
    return points


def _normals(mesh: Sewn, points: FloatArray) -> FloatArray:
    """Return the mean of the normals of the triangles around each point, weighted by area."""
    a, b, c = (points[mesh.triangles[:, corner]] for corner in range(3))
    faces = np.cross(b - a, c - a)
    sums = np.zeros_like(points)
    for corner in range(3):
        np.add.at(sums, mesh.triangles[:, corner], faces)
    sums = mesh.symmetric(sums)
    normals: FloatArray = sums / np.linalg.norm(sums, axis=1, keepdims=True)
    return normals
