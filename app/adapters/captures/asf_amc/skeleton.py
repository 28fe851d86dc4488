"""The skeleton of an Acclaim pair, as defined by the ASF.

A bone has a direction and a length in the world of the zero pose, an `axis` C in which its movement
is given, and its rotational degrees of freedom (`dof`). With M the rotation that an AMC row gives,
the bone rotates in its parent by C M C^-1. All frames are aligned with the world in the zero pose,
so that pose is the rest pose of this rig, and its rotations are the identity.

A joint of our rig is where a bone begins, and has that bone's name: "ltibia" is the left knee and
"lfemur" the left hip. The BVH conversions of the CMU captures place their joints (LeftLeg,
LeftUpLeg) in the same way, so positions can be compared name by name.
"""

from dataclasses import dataclass, field

import numpy as np

from app.adapters.captures.capture import CaptureError
from app.science.rig import Rig
from app.science.rotations import FloatArray, from_euler, identity

Vector = tuple[float, float, float]
ROOT_CHANNELS = ("TX", "TY", "TZ", "RX", "RY", "RZ")
_INCH_M = 0.0254


@dataclass
class Bone:
    """One bone of an ASF.

    Its vector is in the file's unit, its axis angles are in radians; channels are names such as
    ("RX", "RZ").
    """

    name: str = ""
    direction: Vector | None = None
    length: float | None = None
    axis: FloatArray = field(default_factory=lambda: identity(1)[0])
    channels: tuple[str, ...] = ()


@dataclass
class Acclaim:
    """The content of an ASF file: the bones in file order, and their parents.

    `parents` are given by bone name; the root is named "root".
    """

    length_unit: float = 1.0
    degrees: bool = True
    root: Bone = field(default_factory=lambda: Bone("root", channels=ROOT_CHANNELS))
    position: Vector = (0.0, 0.0, 0.0)
    bones: dict[str, Bone] = field(default_factory=dict)
    parents: dict[str, str] = field(default_factory=dict)

    @property
    def metres_per_unit(self) -> float:
        """The length of a unit: one inch divided by the number after `length`.

        In the CMU files this is 0.056444 m.
        """
        return _INCH_M / self.length_unit

    def rig(self, metres_per_unit: float) -> Rig:
        """Return the skeleton in metres, joints in the order of the hierarchy."""
        order = self.order()
        index = {name: joint for joint, name in enumerate(order)}
        vectors = {name: self._vector(name) * metres_per_unit for name in order}
        offsets = [np.array(self.position) * metres_per_unit]
        offsets += [vectors[self.parents[name]] for name in order[1:]]
        with_children = set(self.parents.values())
        ends = tuple(
            (index[name], (float(x), float(y), float(z)))
            for name in order
            if name not in with_children
            for x, y, z in (vectors[name],)
        )
        return Rig(
            names=order,
            parents=(-1, *(index[self.parents[name]] for name in order[1:])),
            offsets_m=np.array(offsets),
            rest_rotations=identity(len(order)),
            ends=ends,
        )

    def order(self) -> tuple[str, ...]:
        """Return the names of the root and the bones, every bone after its parent."""
        children: dict[str, list[str]] = {}
        for child, parent in self.parents.items():
            children.setdefault(parent, []).append(child)
        out, waiting = [], ["root"]
        while waiting:
            name = waiting.pop()
            out.append(name)
            waiting += reversed(children.get(name, []))
        return tuple(out)

    def _vector(self, name: str) -> FloatArray:
        bone = self.bones.get(name)
        if bone is None or bone.direction is None or bone.length is None:
            return np.zeros(3)  # the root has no length
        return np.array(bone.direction) * bone.length


def turn(order: str, angles: FloatArray, *, degrees: bool, line: int) -> FloatArray:
    """Return rotations (..., 4) about the fixed axes `order`, first letter first.

    For example, "XYZ" is Rz Ry Rx.
    """
    if not np.isfinite(angles).all():
        raise CaptureError("an angle is not finite.", line=line)
    radians = np.radians(angles) if degrees else angles
    return from_euler(order[::-1], radians[..., ::-1])
