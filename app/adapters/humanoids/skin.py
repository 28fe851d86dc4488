"""Compute the skin at rest in the world: each vertex, and the node that moves it most.

A skinned vertex is the weighted sum of its transformations by its bones,

    v_world = sum_k w_k  world_from_bone_k  bone_from_mesh_k  v,

with the bones in the file's rest pose. A mesh without a skin follows its own node. Only vertices of
triangles count: others are not drawn.

Source: Khronos, glTF 2.0 specification, section 3.7.3.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from app.adapters.humanoids.accessors import IndexArray, Tables
from app.adapters.humanoids.container import HumanoidFileError
from app.adapters.humanoids.document import Document, Primitive, Skin
from app.adapters.humanoids.nodes import Tree
from app.science.rotations import FloatArray

_TRIANGLES = (4, 5, 6)
_FARTHEST = 1e9
_MOST_PRIMITIVES = 20_000
_AT_ONCE = 65_536
"""Vertices transformed together; each needs a matrix meanwhile."""


@dataclass(frozen=True, eq=False)
class SkinnedVertices:
    """The vertices of a skin at rest.

    They have (V, 3) positions in the world, and (V,) the node that moves each vertex most.
    """

    places_m: FloatArray
    nodes: IndexArray


class _Reader:
    def __init__(self, document: Document, tree: Tree, tables: Tables, most: int) -> None:
        self._document, self._tree, self._tables = document, tree, tables
        self._most, self._left = most, most
        self._primitives = 0

    def pieces(self) -> Iterator[SkinnedVertices]:
        """Yield the vertices of every mesh at every node."""
        for number, node in enumerate(self._document.nodes):
            if node.mesh is None:
                continue
            place = f"nodes.{number}"
            if node.mesh >= len(self._document.meshes):
                raise HumanoidFileError(f"There is no mesh {node.mesh}.", place)
            if node.skin is not None and node.skin >= len(self._document.skins):
                raise HumanoidFileError(f"There is no skin {node.skin}.", place)
            for row, primitive in enumerate(self._document.meshes[node.mesh].primitives):
                at = f"meshes.{node.mesh}.primitives.{row}"
                if primitive.mode in _TRIANGLES and "POSITION" in primitive.attributes:
                    yield from self._piece(number, node.skin, primitive, at)

    def _piece(
        self, node: int, skin: int | None, primitive: Primitive, place: str
    ) -> Iterator[SkinnedVertices]:
        self._primitives += 1
        if self._primitives > _MOST_PRIMITIVES:
            raise HumanoidFileError(f"It has more than {_MOST_PRIMITIVES} meshes.", place)
        points = self._tables.floats(primitive.attributes["POSITION"], "VEC3")
        used = self._used(primitive, len(points), place)
        self._left -= len(used)
        if self._left < 0:
            raise HumanoidFileError(
                f"The model has more than {self._most} vertices. Export it with fewer.", place
            )
        if skin is None or "JOINTS_0" not in primitive.attributes:
            world = self._tree.world[node]
            moved = points[used] @ world[:3, :3].T + world[:3, 3]
            yield _finite(SkinnedVertices(moved, np.full(len(used), node)), place)
            return
        bones = self._document.skins[skin]
        matrices = self._bone_matrices(bones, f"skins.{skin}")
        joints, weights = self._influences(primitive, len(points), place)
        if len(joints) and joints.max() >= len(bones.joints):
            raise HumanoidFileError(
                f"A vertex refers to bone {joints.max()} of {len(bones.joints)}.", place
            )
        weighted = used[
            weights[used].sum(axis=1) > 0.0
        ]  # a vertex without any weight has no position
        strongest = np.argmax(weights[weighted], axis=1)
        owners = np.array(bones.joints)[joints[weighted, strongest]]
        moved = _blended(points[weighted], joints[weighted], weights[weighted], matrices)
        yield _finite(SkinnedVertices(moved, owners), place)

    def _used(self, primitive: Primitive, count: int, place: str) -> IndexArray:
        """Return the vertices that belong to any triangle, in ascending order."""
        if primitive.indices is None:
            return np.arange(count)
        used = np.unique(self._tables.whole(primitive.indices, "SCALAR"))
        if used[-1] >= count:
            raise HumanoidFileError(f"A triangle wants vertex {used[-1]} of {count}.", place)
        return used

    def _bone_matrices(self, skin: Skin, place: str) -> FloatArray:
        joints = np.array(skin.joints)
        if joints.max() >= len(self._document.nodes):
            raise HumanoidFileError(f"There is no node {joints.max()}.", place)
        world: FloatArray = self._tree.world[joints]
        if skin.inverseBindMatrices is None:
            return world
        inverse = self._tables.floats(skin.inverseBindMatrices, "MAT4")
        if len(inverse) < len(joints):
            raise HumanoidFileError(
                f"It has {len(inverse)} inverse bind matrices for {len(joints)} bones.", place
            )
        with np.errstate(over="ignore", invalid="ignore"):
            matrices: FloatArray = world @ inverse[: len(joints)].reshape(-1, 4, 4).swapaxes(1, 2)
        return matrices

    def _influences(
        self, primitive: Primitive, count: int, place: str
    ) -> tuple[IndexArray, FloatArray]:
        """Return (N, 4 or 8) bones of the skin, and weights, which add up to 1 or are all 0."""
        joints, weights = [], []
        for more in range(2):
            if f"JOINTS_{more}" not in primitive.attributes:
                continue
            if f"WEIGHTS_{more}" not in primitive.attributes:
                raise HumanoidFileError(f"It has JOINTS_{more} but no WEIGHTS_{more}.", place)
            joints.append(self._tables.whole(primitive.attributes[f"JOINTS_{more}"], "VEC4"))
            weights.append(self._tables.floats(primitive.attributes[f"WEIGHTS_{more}"], "VEC4"))
        if any(len(table) != count for table in (*joints, *weights)):
            raise HumanoidFileError(f"{count} vertices need as many bones and weights.", place)
        shares = np.maximum(np.concatenate(weights, axis=1), 0.0)
        total = shares.sum(axis=1, keepdims=True)
        return np.concatenate(joints, axis=1), shares / np.where(total > 0.0, total, 1.0)


def read_skin(document: Document, tree: Tree, tables: Tables, most: int) -> SkinnedVertices:
    """Read all meshes, with at most `most` vertices; raise HumanoidFileError."""
    pieces = list(_Reader(document, tree, tables, most).pieces())
    if not pieces:
        return SkinnedVertices(np.zeros((0, 3)), np.zeros(0, dtype=np.int64))
    return SkinnedVertices(
        np.concatenate([piece.places_m for piece in pieces]),
        np.concatenate([piece.nodes for piece in pieces]),
    )


def _blended(
    points: FloatArray, joints: IndexArray, weights: FloatArray, matrices: FloatArray
) -> FloatArray:
    moved = np.zeros_like(points)
    with np.errstate(over="ignore", invalid="ignore"):
        for start in range(0, len(points), _AT_ONCE):
            rows = slice(start, start + _AT_ONCE)
            for influence in range(joints.shape[1]):
                bones = matrices[joints[rows, influence]]
                there = np.einsum("nij,nj->ni", bones[:, :3, :3], points[rows]) + bones[:, :3, 3]
                moved[rows] += weights[rows, influence, np.newaxis] * there
    return moved


def _finite(vertices: SkinnedVertices, place: str) -> SkinnedVertices:
    if not (np.abs(vertices.places_m) < _FARTHEST).all():
        raise HumanoidFileError("A vertex lies too far away to be part of a body.", place)
    return vertices
