"""Move a skin with the nodes of its file: linear blend skinning.

Each vertex is the weighted sum of the positions to which its bones would move it,

    v_world = sum_k w_k  world_from_bone_k  bone_from_mesh_k  v,

with the weights adding up to 1. A vertex without any weight follows its first bone, as in three.js.
A mesh without a skin follows its own node, with the weight 1.

Source: Khronos, glTF 2.0 specification, section 3.7.3.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.avatar.body.binding import Binding
from app.science.rotations import FloatArray

_AT_ONCE = 65_536
"""The number of vertices transformed at once; each needs a matrix during that time."""
IndexArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class NodeTree:
    """The nodes of a file.

    Attributes:
        parents: the index of the parent of each of the N nodes, -1 for root nodes.
        order: all nodes, each after its parent.
        local: (N, 4, 4) parent_from_node, at rest.
        world: (N, 4, 4) world_from_node, at rest.
    """

    parents: tuple[int, ...]
    order: tuple[int, ...]
    local: FloatArray
    world: FloatArray

    def line_up(self, node: int) -> list[int]:
        """Return the node and all its ancestors, upwards."""
        line = []
        while node >= 0:
            line.append(node)
            node = self.parents[node]
        return line


@dataclass(frozen=True, eq=False)
class SkinPiece:
    """The triangles of a mesh with one material, as placed by one node.

    Attributes:
        node: index of the glTF node that has the mesh.
        primitive: index of the primitive in that mesh.
        places: (V, 3) vertices in the frame of the mesh.
        used: rows of the vertices that belong to any triangle, in ascending order.
        bones: (B,) index of the glTF node of each bone.
        bone_from_mesh: (B, 4, 4) inverse bind matrices.
        joints: (V, K) rows of `bones`.
        weights: (V, K) non-negative; they add up to 1, or are all 0.
    """

    node: int
    primitive: int
    places: FloatArray
    used: IndexArray
    bones: IndexArray
    bone_from_mesh: FloatArray
    joints: IndexArray
    weights: FloatArray


def posed_nodes(tree: NodeTree, binding: Binding, world_from_bound_node: FloatArray) -> FloatArray:
    """Return world_from_node of all nodes (N, 4, 4) as the binding says.

    Args:
        tree: the nodes at rest.
        binding: which node follows which part.
        world_from_bound_node: (P, 4, 4) of the nodes of parts: `Binding.world_from_nodes`.
    """
    world = np.empty_like(tree.world)
    bound = dict(zip(binding.nodes, world_from_bound_node, strict=True))
    hips = binding.nodes[0]
    above = set(tree.line_up(hips))
    # What the hips' own movement does to everything that lies at or above them in the tree.
    carried = bound[hips] @ np.linalg.inv(tree.world[hips])
    for node in tree.order:
        if node in bound:
            world[node] = bound[node]
        elif node in above or tree.parents[node] < 0:
            world[node] = carried @ tree.world[node]
        else:
            world[node] = world[tree.parents[node]] @ tree.local[node]
    return world


def posed_vertices(
    piece: SkinPiece, world_from_node: FloatArray, rows: IndexArray | None = None
) -> FloatArray:
    """Return vertices in the world by linear blend skinning.

    Args:
        piece: the mesh with its bones.
        world_from_node: (N, 4, 4) all nodes.
        rows: which vertices; all by default.

    Returns:
        (V, 3), or a row for each of `rows`; not finite where the numbers of the file overflow.
    """
    chosen = np.arange(len(piece.places)) if rows is None else rows
    moved = np.zeros((len(chosen), 3))
    with np.errstate(over="ignore", invalid="ignore"):
        matrices = world_from_node[piece.bones] @ piece.bone_from_mesh
        for start in range(0, len(chosen), _AT_ONCE):
            some = chosen[start : start + _AT_ONCE]
            weights = piece.weights[some]
            weights[~weights.any(axis=1), 0] = 1.0
            for influence in range(weights.shape[1]):
                bones = matrices[piece.joints[some, influence]]
                there = np.einsum("nij,nj->ni", bones[:, :3, :3], piece.places[some])
                there += bones[:, :3, 3]
                moved[start : start + _AT_ONCE] += weights[:, influence, np.newaxis] * there
    return moved
