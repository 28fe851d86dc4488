"""What the avatar touches, with which force."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from app.science.avatar.body import PARENT_OF
from app.science.rotations import Vector

if TYPE_CHECKING:
    import mujoco


@dataclass(frozen=True)
class Contact:
    """One touch of a body part.

    Attributes:
        part: HumanBodyBones name.
        other: geom of the scene, such as `hand/2/left` or `floor`, or another body part.
        force_n: force across the surface, zero or more.
        friction_n: force along the surface.
        penetration_m: how deep the two are in each other; below zero they do not touch yet.
        place_m: where, in the world.
    """

    part: str
    other: str
    force_n: float
    friction_n: float
    penetration_m: float
    place_m: Vector


def read_contacts(model: "mujoco.MjModel", data: "mujoco.MjData") -> tuple[Contact, ...]:
    """Return the touches of the last step."""
    import mujoco

    found: list[Contact] = []
    force = np.empty(6)
    for row in range(data.ncon):
        contact = data.contact[row]
        first, second = (_told(model, int(geom)) for geom in contact.geom)
        if first not in PARENT_OF:
            first, second = second, first
        if first not in PARENT_OF:
            continue
        mujoco.mj_contactForce(model, data, row, force)
        x, y, z = contact.pos.tolist()
        along = float(np.hypot(force[1], force[2]))
        found.append(
            Contact(first, second, float(force[0]), along, -float(contact.dist), (x, y, z))
        )
    return tuple(found)


def _told(model: "mujoco.MjModel", geom: int) -> str:
    body = model.geom_bodyid[geom]
    return str(model.geom(geom).name if body == 0 else model.body(body).name)
