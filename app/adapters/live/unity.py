"""Convert positions and rotations of Unity, whose axes VMC and VRChat use.

Unity has y up and z forward and is left-handed. Mirroring z makes it right-handed: positions become
(x, y, -z). A mirrored rotation turns the other way about the axes that lie in the mirror.
"""

import math

from app.adapters.live.readings import Quaternion, Vector


def position_from_unity(x: float, y: float, z: float) -> Vector:
    """Return a position in our axes."""
    return (x, y, -z)


def rotation_from_unity(x: float, y: float, z: float, w: float) -> Quaternion:
    """Return a rotation, given in Unity's order, as w, x, y, z in our axes."""
    return (w, -x, -y, z)


def rotation_from_unity_degrees(x: float, y: float, z: float) -> Quaternion:
    """Return the rotation of Unity's Euler angles, in degrees, as w, x, y, z in our axes.

    Unity turns about z, then x, then y, each time about the axes of the world (documentation of
    `Quaternion.Euler`): q = q_y q_x q_z.
    """
    (cx, sx), (cy, sy), (cz, sz) = (
        (math.cos(half), math.sin(half)) for half in (math.radians(one) / 2 for one in (x, y, z))
    )
    return rotation_from_unity(
        cy * sx * cz + sy * cx * sz,
        sy * cx * cz - cy * sx * sz,
        cy * cx * sz - sy * sx * cz,
        cy * cx * cz + sy * sx * sz,
    )
