"""Read what the avatar touches and with which force."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from app.science.avatar.body import PARENT_OF
from app.science.rotations import Vector

if TYPE_CHECKING:
    import mujoco


@dataclass(frozen=True)
class Contact:
    """One contact of a body part with the scene or with another part.

    Attributes:
        part: HumanBodyBones name.
        other: geom of the scene, such as `hand/2/left` or `floor`, or another body part.
        force_n: force normal to the surface, zero or more.
        friction_n: force along the surface.
        penetration_m: depth of overlap; below zero the two do not touch yet.
        place_m: position in the world.
    """

    part: str
    other: str
    force_n: float
    friction_n: float
    penetration_m: float
    place_m: Vector


def read_contacts(model: "mujoco.MjModel", data: "mujoco.MjData") -> tuple[Contact, ...]:
    """Return the body's contacts in the last step."""
    import mujoco

    contacts: list[Contact] = []
    force = np.empty(6)
    for row in range(data.ncon):
        contact = data.contact[row]
        first, second = (_name(model, int(geom)) for geom in contact.geom)
        if first not in PARENT_OF:
            first, second = second, first
        if first not in PARENT_OF:
            continue
        mujoco.mj_contactForce(model, data, row, force)
        x, y, z = contact.pos.tolist()
        friction = float(np.hypot(force[1], force[2]))
        contacts.append(
            Contact(first, second, float(force[0]), friction, -float(contact.dist), (x, y, z))
        )
    return tuple(contacts)


def _name(model: "mujoco.MjModel", geom: int) -> str:
    body = model.geom_bodyid[geom]
    return str(model.geom(geom).name if body == 0 else model.body(body).name)
