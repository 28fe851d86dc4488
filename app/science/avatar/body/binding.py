"""Let the nodes of a model's file follow the parts of its body.

A body moves by its parts, a file's mesh by its nodes. A binding says which node each part moves,
and how it lies in the part's frame: origin in the part's joint, axes parallel to the world in the
T-pose (x right, y up, facing -z). With the parts placed,

    world_from_node = world_from_part  part_from_node.

All other nodes keep their local transform:

- Below a part (hair, twist bones, the ends of fingers) they follow the part above them.
- **Above the hips** (the root of an armature) they keep their place relative to the hips, as do
  their other children: the whole file moves with the hips.

A binding is made in the model's own size. A body of another stature is scaled as a whole, about the
origin on the floor.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.science.avatar.body.humanoid import HumanoidError
from app.science.avatar.body.humanoid_pose import TPosed
from app.science.avatar.body.parts import PARENT_OF
from app.science.rotations import FloatArray, matrices, multiply, rotate

_MOST_UNEVEN = 1e9
"""Greatest ratio of a node's scales in different directions; beyond it its inverse is noise."""


@dataclass(frozen=True, eq=False)
class Binding:
    """The parts of a model in the T-pose, and the nodes of its file that follow them.

    Attributes:
        stature_m: the model's own.
        parts: HumanBodyBones names of the P parts that it has, parents first.
        parents: row of each part's parent, -1 for the hips, which come first.
        joints_m: (P, 3) joints in the T-pose above the floor, the hips over the origin.
        nodes: index of the glTF node that each part moves.
        part_from_node: (P, 4, 4) the node in its part's frame, with the file's scale and unit.
    """

    stature_m: float
    parts: tuple[str, ...]
    parents: tuple[int, ...]
    joints_m: FloatArray
    nodes: tuple[int, ...]
    part_from_node: FloatArray

    def scaled(self, stature_m: float) -> "Binding":
        """Return the binding of the same body at another stature."""
        factor = stature_m / self.stature_m
        scaled = self.part_from_node.copy()
        scaled[:, :3] *= factor
        return replace(
            self, stature_m=stature_m, joints_m=self.joints_m * factor, part_from_node=scaled
        )

    def world_from_parts(self, hips_m: Sequence[float], rotations: FloatArray) -> FloatArray:
        """Place the parts by forward kinematics.

        Args:
            hips_m: the hips in the world.
            rotations: (P, 4) parent_from_part, world_from_part for the hips; identities give the
                T-pose.

        Returns:
            (P, 4, 4) world_from_part.
        """
        places, turns = np.empty((len(self.parts), 3)), np.empty((len(self.parts), 4))
        places[0], turns[0] = hips_m, rotations[0]
        for part, parent in enumerate(self.parents[1:], start=1):
            offset = self.joints_m[part] - self.joints_m[parent]
            places[part] = places[parent] + rotate(turns[parent], offset)
            turns[part] = multiply(turns[parent], rotations[part])
        world = np.tile(np.eye(4), (len(self.parts), 1, 1))
        world[:, :3, :3], world[:, :3, 3] = matrices(turns), places
        return world

    def world_from_nodes(self, hips_m: Sequence[float], rotations: FloatArray) -> FloatArray:
        """Return (P, 4, 4) world_from_node of the nodes of parts; see `world_from_parts`."""
        return self.world_from_parts(hips_m, rotations) @ self.part_from_node


def bind(
    posed: TPosed, bones: Mapping[str, int], nodes: Mapping[str, int], world_from_node: FloatArray
) -> Binding:
    """Bind the nodes of a file to the parts of the body read from it.

    Args:
        posed: the body in the T-pose.
        bones: part -> row of its bone in the rig that was posed.
        nodes: part -> glTF node of that bone.
        world_from_node: (N, 4, 4) all nodes at rest, in the file's world.

    Raises:
        HumanoidError: a node has no extent in some direction, so nothing can be placed by it.
    """
    parts = tuple(posed.humanoid.parts)
    joints = np.array([posed.humanoid.parts[part].place_m for part in parts])
    rows = [nodes[part] for part in parts]
    part_from_node = posed.moves[[bones[part] for part in parts]] @ world_from_node[rows]
    part_from_node[:, :3, 3] -= joints
    for part, matrix in zip(parts, part_from_node, strict=True):
        if not np.linalg.cond(matrix[:3, :3]) < _MOST_UNEVEN:
            raise HumanoidError(
                f"The bone of {part} is scaled to nothing in some direction. Apply the scale of all"
                " bones in the program that made the model, and export it again."
            )
    return Binding(
        stature_m=posed.humanoid.stature_m,
        parts=parts,
        parents=tuple(_parent(part, parts) for part in parts),
        joints_m=joints,
        nodes=tuple(rows),
        part_from_node=part_from_node,
    )


def _parent(part: str, parts: Sequence[str]) -> int:
    above = PARENT_OF[part]
    while above is not None and above not in parts:
        above = PARENT_OF[above]
    return -1 if above is None else parts.index(above)
