"""The tree of a file's nodes: the parent of each, and its position in the world.

Source: Khronos, glTF 2.0 specification, section 3.5: matrices are column by column; a node without
one has translation, rotation (x, y, z, w) and scale, applied from right to left.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.adapters.humanoids.container import HumanoidFileError
from app.adapters.humanoids.document import Document, Node
from app.science.avatar.body import NodeTree
from app.science.rig import Rig
from app.science.rotations import (
    FloatArray,
    Vector,
    conjugate,
    multiply,
    normalise,
    q_from_axes,
    rotate,
)

_FARTHEST = 1e9
_ROOT = "(file)"


@dataclass(frozen=True, eq=False)
class Tree(NodeTree):
    """All nodes of a file, with unique names."""

    names: tuple[str, ...]


def tree_of(document: Document) -> Tree:
    """Build the tree; raise HumanoidFileError for a cycle, or a node with two parents."""
    nodes = document.nodes
    parents = [-1] * len(nodes)
    for number, node in enumerate(nodes):
        for child in node.children:
            if child >= len(nodes) or parents[child] >= 0:
                why = "is no node" if child >= len(nodes) else "is also below another node"
                raise HumanoidFileError(
                    f"{child} {why}; valid are nodes 0 to {len(nodes) - 1}, each once.",
                    f"nodes.{number}.children",
                )
            parents[child] = number
    order = [number for number, parent in enumerate(parents) if parent < 0]
    for number in order:  # grows during the iteration
        order.extend(nodes[number].children)
    if len(order) < len(nodes):
        rest = sorted(set(range(len(nodes))) - set(order))
        raise HumanoidFileError("The node is its own descendant.", f"nodes.{rest[0]}")
    local = np.array([_local(node) for node in nodes]).reshape(-1, 4, 4)
    world = _world(local, parents, order)
    return Tree(tuple(parents), tuple(order), local, world, _names(nodes))


def rig_of(tree: Tree, required: set[int]) -> tuple[Rig, dict[int, int]]:
    """Make a rig of the given nodes and all their ancestors.

    Returns:
        The rig, in metres as in the file, and node -> bone.
    """
    included = {above for node in required for above in tree.line_up(node)}
    bones = [node for node in tree.order if node in included]
    tops = [node for node in bones if tree.parents[node] < 0]
    first = 0 if len(tops) == 1 else 1
    bone_of = {node: row + first for row, node in enumerate(bones)}
    parents = [bone_of.get(tree.parents[node], first - 1) for node in bones]
    names = [tree.names[node] for node in bones]
    places = tree.world[bones, :3, 3]
    turns = _turns(tree.world[bones, :3, :3])
    if first:  # several root nodes get a common parent
        parents, names = [-1, *parents], [_ROOT, *names]
        places = np.vstack((np.zeros(3), places))
        turns = np.vstack((np.array((1.0, 0.0, 0.0, 0.0)), turns))
    above = np.array(parents[1:], dtype=np.int64)
    offsets, rotations = places.copy(), turns.copy()
    back = conjugate(turns[above])
    offsets[1:] = rotate(back, places[1:] - places[above])
    rotations[1:] = normalise(multiply(back, turns[1:]))
    return Rig(tuple(names), tuple(parents), offsets, rotations), bone_of


def _names(nodes: list[Node]) -> tuple[str, ...]:
    used: set[str] = {_ROOT}
    names = []
    for number, node in enumerate(nodes):
        name = node.name or f"node {number}"
        if name in used:
            name = f"{name} (node {number})"
        while name in used:
            name += "'"
        used.add(name)
        names.append(name)
    return tuple(names)


def _world(local: FloatArray, parents: list[int], order: list[int]) -> FloatArray:
    world = np.empty_like(local)
    with np.errstate(over="ignore", invalid="ignore"):
        for number in order:
            above = parents[number]
            world[number] = local[number] if above < 0 else world[above] @ local[number]
            if not (np.abs(world[number]) < _FARTHEST).all():
                raise HumanoidFileError(
                    "The node lies too far away to be part of a body.", f"nodes.{number}"
                )
    return world


def _local(node: Node) -> FloatArray:
    if node.matrix is not None:
        return np.array(node.matrix).reshape(4, 4).T
    local = np.eye(4)
    x, y, z, w = node.rotation
    length = (x * x + y * y + z * z + w * w) ** 0.5
    turn = np.array((w, x, y, z)) / length if length > 0.0 else np.array((1.0, 0.0, 0.0, 0.0))
    local[:3, :3] = rotate(turn[np.newaxis], np.eye(3)).T * np.array(node.scale)
    local[:3, 3] = node.translation
    return local


def _turns(matrices: FloatArray) -> FloatArray:
    """Return the rotations (N, 4) nearest to matrices (N, 3, 3) of any scale."""
    lengths = np.linalg.norm(matrices, axis=1, keepdims=True)
    left, _, right = np.linalg.svd(matrices / np.where(lengths > 0.0, lengths, 1.0))
    signs = np.ones((len(matrices), 3))
    signs[:, 2] = np.sign(np.linalg.det(left @ right))
    rotations = (left * signs[:, np.newaxis]) @ right
    return normalise(np.array([q_from_axes(*_columns(matrix)) for matrix in rotations]))


def _columns(matrix: npt.NDArray[np.float64]) -> tuple[Vector, Vector, Vector]:
    (a, b, c), (d, e, f), (g, h, i) = matrix.T.tolist()
    return (a, b, c), (d, e, f), (g, h, i)
