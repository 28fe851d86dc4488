"""Write the avatar's body for PyBullet: the same links, masses, shapes, hinges and partners.

It is generated from the model that MuJoCo has compiled, so nothing is specified twice. Differences
caused by URDF and Bullet:

- A part with several hinges becomes a chain of links of a gram each, with the part at its end.

- Armature is not a property of a hinge there. It is added to the inertia of the link that the hinge
  moves, about all three axes equally.

- Motors are constraints that Bullet solves together with contacts, not torques. Their gains are set
  to the same natural frequency and damping (`motor_gains`).
"""

import warnings
from collections.abc import Iterator
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from app.science.rotations import FloatArray

_LINK_KG = 1e-3
_HERE = {"xyz": "0 0 0", "rpy": "0 0 0"}
_PLANE = mujoco.mjtGeom.mjGEOM_PLANE
_BOX = mujoco.mjtGeom.mjGEOM_BOX
_SPHERE = mujoco.mjtGeom.mjGEOM_SPHERE
_CAPSULE = mujoco.mjtGeom.mjGEOM_CAPSULE


def urdf_of(model: mujoco.MjModel) -> str:
    """Return the URDF of a body whose root is carried; its joints are named after the axes."""
    robot = Element("robot", name="avatar")
    bodies = range(1, model.nbody)
    for body in bodies:
        hinges = _hinges(model, body)
        for number, hinge in enumerate(hinges[:-1]):
            _add_link(robot, f"{model.body(body).name}/{number}", float(model.dof_armature[hinge]))
        _add_part(robot, model, body, float(model.dof_armature[hinges[-1]]) if hinges else 0.0)
    for body in bodies:
        if model.body_parentid[body] != 0:
            _add_joints(robot, model, body)
    indent(robot)  # Bullet cuts lines longer than a kilobyte in two
    return tostring(robot, encoding="unicode")


def colliding_pairs(model: mujoco.MjModel) -> Iterator[tuple[str, str]]:
    """Return the pairs of body parts that may touch, as MuJoCo determines them."""
    excluded = {
        frozenset((int(signature) >> 16, int(signature) & 0xFFFF))
        for signature in model.exclude_signature
    }
    for first in range(1, model.nbody):
        for second in range(first + 1, model.nbody):
            neighbours = second in (model.body_parentid[first], first) or first in (
                model.body_parentid[second],
            )
            if neighbours or frozenset((first, second)) in excluded:
                continue
            if _may_touch(model, first, second):
                yield model.body(first).name, model.body(second).name


def scene_boxes(model: mujoco.MjModel) -> Iterator[dict[str, list[float]]]:
    """Return the immovable boxes of the scene, each with its centre and half size."""
    for geom in range(model.ngeom):
        if model.geom_bodyid[geom] == 0 and model.geom_type[geom] == _BOX:
            yield {
                "center_m": model.geom_pos[geom].tolist(),
                "half_size_m": model.geom_size[geom].tolist(),
            }


def has_floor(model: mujoco.MjModel) -> bool:
    """Return whether the model has a floor plane."""
    return bool(np.any(model.geom_type == _PLANE))


def motor_gains(model: mujoco.MjModel) -> tuple[FloatArray, FloatArray]:
    """Return the position and speed gains of Bullet's motors, per step.

    A motor of ours changes the speed of a limb of inertia I in a step h by

        h (kp (angle* - angle) + kd (speed* - speed)) / I,   kp = w^2 I,   kd = 2 w I,

    and Bullet's by  g (angle* - angle) / h + d (speed* - speed).  So g = (w h)^2, d = 2 w h, with w
    = 2 kp / kd as for critical damping.
    """
    # MuJoCo's bias: ... - kp angle - kd speed.
    kp, kd = -model.actuator_biasprm[:, 1], -model.actuator_biasprm[:, 2]
    omega_h = 2.0 * kp / kd * model.opt.timestep
    return omega_h**2, 2.0 * omega_h


def _hinges(model: mujoco.MjModel, body: int) -> list[int]:
    first = int(model.body_jntadr[body])
    return [] if first < 0 else list(range(first, first + int(model.body_jntnum[body])))


def _may_touch(model: mujoco.MjModel, first: int, second: int) -> bool:
    one, other = (model.geom_bodyid == body for body in (first, second))
    types, partners = model.geom_contype, model.geom_conaffinity
    return bool(
        np.any(types[one][:, None] & partners[other])
        or np.any(partners[one][:, None] & types[other])
    )


def _add_joints(robot: Element, model: mujoco.MjModel, body: int) -> None:
    name = model.body(body).name
    above = model.body(int(model.body_parentid[body])).name
    hinges = _hinges(model, body)
    links = [f"{name}/{number}" for number in range(len(hinges) - 1)] + [name]
    place = {"xyz": _row(model.body_pos[body]), "rpy": _rpy(model.body_quat[body])}
    if not hinges:
        joint = SubElement(robot, "joint", name=f"{name}/fixed", type="fixed")
        _connect(joint, above, name, place)
    for hinge, link in zip(hinges, links, strict=False):
        joint = SubElement(robot, "joint", name=model.jnt(hinge).name, type="revolute")
        _connect(joint, above, link, place)
        SubElement(joint, "axis", xyz=_row(model.jnt_axis[hinge]))
        low, high = model.jnt_range[hinge].tolist()
        SubElement(
            joint, "limit", lower=repr(low), upper=repr(high), effort="1000", velocity="1000"
        )
        SubElement(joint, "dynamics", damping=repr(float(model.dof_damping[hinge])))
        above, place = link, _HERE


def _connect(joint: Element, above: str, link: str, place: dict[str, str]) -> None:
    SubElement(joint, "parent", link=above)
    SubElement(joint, "child", link=link)
    SubElement(joint, "origin", place)


def _add_link(robot: Element, name: str, armature: float) -> None:
    link = SubElement(robot, "link", name=name)
    _add_inertial(link, _LINK_KG, _HERE, np.full(3, armature))


def _add_part(robot: Element, model: mujoco.MjModel, body: int, armature: float) -> None:
    link = SubElement(robot, "link", name=model.body(body).name)
    place = {"xyz": _row(model.body_ipos[body]), "rpy": _rpy(model.body_iquat[body])}
    _add_inertial(link, float(model.body_mass[body]), place, model.body_inertia[body] + armature)
    for geom in np.flatnonzero(model.geom_bodyid == body).tolist():
        collision = SubElement(link, "collision")
        place = {"xyz": _row(model.geom_pos[geom]), "rpy": _rpy(model.geom_quat[geom])}
        SubElement(collision, "origin", place)
        _add_shape(SubElement(collision, "geometry"), model, geom)


def _add_inertial(
    link: Element, mass_kg: float, place: dict[str, str], inertia: FloatArray
) -> None:
    inertial = SubElement(link, "inertial")
    SubElement(inertial, "origin", place)
    SubElement(inertial, "mass", value=repr(mass_kg))
    xx, yy, zz = (repr(value) for value in inertia.tolist())
    SubElement(inertial, "inertia", ixx=xx, iyy=yy, izz=zz, ixy="0", ixz="0", iyz="0")


def _add_shape(geometry: Element, model: mujoco.MjModel, geom: int) -> None:
    x, y, _ = model.geom_size[geom].tolist()
    kind = model.geom_type[geom]
    if kind == _CAPSULE:
        SubElement(geometry, "capsule", radius=repr(x), length=repr(2.0 * y))
    elif kind == _SPHERE:
        SubElement(geometry, "sphere", radius=repr(x))
    elif kind == _BOX:
        SubElement(geometry, "box", size=_row(2.0 * model.geom_size[geom]))
    else:
        raise ValueError(f"The shape {model.geom(geom).name} of kind {kind} has no counterpart.")


def _row(values: FloatArray) -> str:
    return " ".join(repr(value) for value in np.asarray(values, dtype=np.float64).tolist())


def _rpy(q: FloatArray) -> str:
    with warnings.catch_warnings():
        # At a pitch of 90 degrees any of the equivalent notations is valid.
        warnings.simplefilter("ignore", UserWarning)
        return _row(Rotation.from_quat(q, scalar_first=True).as_euler("xyz"))
