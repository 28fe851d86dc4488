"""Compute mass, centre of mass and inertia of rigid objects and of their combinations.

Plain floats in a fixed order of operations: a body's model must be the same byte for byte.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import fsum

from app.science.avatar.body.shapes import Box, Capsule, Shape
from app.science.rotations import Quaternion, Vector, q_rotate, v_add, v_subtract

Tensor = tuple[float, float, float, float, float, float]
"""A symmetric matrix as xx, yy, zz, xy, xz, yz."""
_UNITS: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_AXES = (0, 1, 2)


@dataclass(frozen=True)
class Inertial:
    """Mass, centre of mass and inertia of a rigid object.

    Attributes:
        mass_kg: mass.
        center_m: centre of mass in some frame.
        inertia_kg_m2: about the centre of mass, along that frame's axes.
    """

    mass_kg: float
    center_m: Vector
    inertia_kg_m2: Tensor

    def moved(self, by: Vector) -> "Inertial":
        """Return the object in a frame whose origin lies at `-by`."""
        return Inertial(self.mass_kg, v_add(self.center_m, by), self.inertia_kg_m2)

    def scaled(self, factor: float) -> "Inertial":
        """Return the object with a mass that is larger by a factor, at the same places."""
        xx, yy, zz, xy, xz, yz = (factor * one for one in self.inertia_kg_m2)
        return Inertial(factor * self.mass_kg, self.center_m, (xx, yy, zz, xy, xz, yz))

    def turned(self, rotation: Quaternion, about: Vector) -> "Inertial":
        """Return the object rotated about a point."""
        center = v_add(about, q_rotate(rotation, v_subtract(self.center_m, about)))
        turn = [q_rotate(rotation, unit) for unit in _UNITS]  # columns of the matrix R
        xx, yy, zz, xy, xz, yz = self.inertia_kg_m2
        rows = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))

        def entry(i: int, j: int) -> float:
            """Return one entry of R I R^T."""
            return fsum(turn[a][i] * rows[a][b] * turn[b][j] for a in _AXES for b in _AXES)

        inertia = (entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2))
        return Inertial(self.mass_kg, center, inertia)

    def about_axis(self, point: Vector, direction: Vector) -> float:
        """Return the moment of inertia about a line, kg m^2; the direction is a unit vector."""
        at_point = _plus(self.inertia_kg_m2, _offset(self.mass_kg, self.center_m, point), 1.0)
        xx, yy, zz, xy, xz, yz = at_point
        x, y, z = direction
        return (
            xx * x * x + yy * y * y + zz * z * z
            + 2.0 * (xy * x * y + xz * x * z + yz * y * z)
        )  # fmt: skip


def combined(objects: Sequence[Inertial]) -> Inertial:
    """Combine several objects, all in one frame, into one rigid object."""
    if len(objects) == 1:
        return objects[0]
    mass = fsum(item.mass_kg for item in objects)
    center = _mean_center(objects, mass)
    inertia: Tensor = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for item in objects:
        inertia = _plus(inertia, item.inertia_kg_m2, 1.0)
        inertia = _plus(inertia, _offset(item.mass_kg, item.center_m, center), 1.0)
    return Inertial(mass, center, inertia)


def remainder(whole: Inertial, pieces: Sequence[Inertial]) -> Inertial:
    """Return the object that is left when some pieces are removed: the inverse of `combined`."""
    mass = whole.mass_kg - fsum(piece.mass_kg for piece in pieces)
    weighted = [
        whole.mass_kg * whole.center_m[axis]
        - fsum(piece.mass_kg * piece.center_m[axis] for piece in pieces)
        for axis in range(3)
    ]
    center = (weighted[0] / mass, weighted[1] / mass, weighted[2] / mass)
    inertia = whole.inertia_kg_m2
    for piece in pieces:
        inertia = _plus(inertia, piece.inertia_kg_m2, -1.0)
        inertia = _plus(inertia, _offset(piece.mass_kg, piece.center_m, whole.center_m), -1.0)
    inertia = _plus(inertia, _offset(mass, center, whole.center_m), -1.0)
    return Inertial(mass, center, inertia)


def of_shape(shape: Shape, mass_kg: float) -> Inertial:
    """Return the inertia of a capsule or box of uniform density."""
    if isinstance(shape, Box):
        x, y, z = (2.0 * half for half in shape.half_size_m)
        twelfth = mass_kg / 12.0
        diagonal = (twelfth * (y * y + z * z), twelfth * (x * x + z * z), twelfth * (x * x + y * y))
        return Inertial(mass_kg, shape.center_m, (*diagonal, 0.0, 0.0, 0.0))
    return Inertial(mass_kg, shape.center_m, _capsule(shape, mass_kg))


def _capsule(shape: Capsule, mass_kg: float) -> Tensor:
    radius, length = shape.radius_m, shape.length_m
    rod = length / (length + 4.0 / 3.0 * radius) * mass_kg
    caps = mass_kg - rod
    along = rod * radius**2 / 2.0 + caps * 0.4 * radius**2
    across = rod * (length**2 / 12.0 + radius**2 / 4.0) + caps * (
        0.4 * radius**2 + length**2 / 4.0 + 0.375 * length * radius
    )
    if length == 0.0:
        return (along, along, along, 0.0, 0.0, 0.0)
    x, y, z = ((b - a) / length for a, b in zip(shape.start_m, shape.end_m, strict=True))
    difference = along - across
    return (
        across + difference * x * x, across + difference * y * y, across + difference * z * z,
        difference * x * y, difference * x * z, difference * y * z,
    )  # fmt: skip


def _mean_center(objects: Sequence[Inertial], mass: float) -> Vector:
    x, y, z = (
        fsum(item.mass_kg * item.center_m[axis] for item in objects) / mass for axis in range(3)
    )
    return (x, y, z)


def _plus(a: Tensor, b: Tensor, factor: float) -> Tensor:
    xx, yy, zz, xy, xz, yz = (p + factor * q for p, q in zip(a, b, strict=True))
    return (xx, yy, zz, xy, xz, yz)


def _offset(mass: float, center: Vector, point: Vector) -> Tensor:
    """Return the inertia of a point mass at `center` about `point` (parallel axis theorem)."""
    x, y, z = (c - p for c, p in zip(center, point, strict=True))
    return (
        mass * (y * y + z * z), mass * (x * x + z * z), mass * (x * x + y * y),
        -mass * x * y, -mass * x * z, -mass * y * z,
    )  # fmt: skip
