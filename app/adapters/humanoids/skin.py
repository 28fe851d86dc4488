"""Read the skin of a file: the vertices of all its meshes, and the bones that move them.

Only vertices of triangles count: others are not drawn. At rest, each vertex belongs to the node
that moves it most.

Source: Khronos, glTF 2.0 specification, section 3.7.3.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from app.adapters.humanoids.accessors import IndexArray, Tables
from app.adapters.humanoids.container import HumanoidFileError
from app.adapters.humanoids.document import Document, Primitive, Skin
from app.adapters.humanoids.draco import PrimitiveTables
from app.adapters.humanoids.nodes import Tree
from app.science.avatar.body import SkinPiece, posed_vertices
from app.science.rotations import FloatArray

_TRIANGLES = (4, 5, 6)
_FARTHEST = 1e9
_MOST_PRIMITIVES = 20_000


@dataclass(frozen=True, eq=False)
class SkinnedVertices:
    """The vertices of a skin at rest.

    They have (V, 3) positions in the world, and (V,) the node that moves each vertex most.
    """

    places_m: FloatArray
    nodes: IndexArray


class _Reader:
    def __init__(self, document: Document, tables: Tables, most: int) -> None:
        self._document, self._tables = document, tables
        self._most, self._left = most, most
        self._primitives = 0

    def pieces(self) -> Iterator[tuple[SkinPiece, str]]:
        """Yield every primitive of the mesh of every node, and where the file has it."""
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
                    yield self._piece(number, node.skin, row, primitive, at), at

    def _piece(
        self, node: int, skin: int | None, row: int, primitive: Primitive, place: str
    ) -> SkinPiece:
        self._primitives += 1
        if self._primitives > _MOST_PRIMITIVES:
            raise HumanoidFileError(f"It has more than {_MOST_PRIMITIVES} meshes.", place)
        attributes = PrimitiveTables(self._tables, primitive, place)
        points = attributes.floats("POSITION", "VEC3")
        used = _used(attributes.corners(), len(points), place)
        self._left -= len(used)
        if self._left < 0:
            raise HumanoidFileError(
                f"The model has more than {self._most} vertices. Export it with fewer.", place
            )
        if skin is None or "JOINTS_0" not in primitive.attributes:
            own, alone = np.array([node]), np.eye(4)[np.newaxis]
            shape = (len(points), 1)
            joints, weights = np.zeros(shape, dtype=np.int64), np.ones(shape)
            return SkinPiece(node, row, points, used, own, alone, joints, weights)
        bones = self._document.skins[skin]
        matrices = self._inverse_bind(bones, f"skins.{skin}")
        joints, weights = _influences(attributes, primitive, len(points), place)
        if len(joints) and joints.max() >= len(bones.joints):
            raise HumanoidFileError(
                f"A vertex refers to bone {joints.max()} of {len(bones.joints)}.", place
            )
        nodes = np.array(bones.joints)
        return SkinPiece(node, row, points, used, nodes, matrices, joints, weights)

    def _inverse_bind(self, skin: Skin, place: str) -> FloatArray:
        joints = np.array(skin.joints)
        if joints.max() >= len(self._document.nodes):
            raise HumanoidFileError(f"There is no node {joints.max()}.", place)
        if skin.inverseBindMatrices is None:
            return np.tile(np.eye(4), (len(joints), 1, 1))
        inverse = self._tables.floats(skin.inverseBindMatrices, "MAT4")
        if len(inverse) < len(joints):
            raise HumanoidFileError(
                f"It has {len(inverse)} inverse bind matrices for {len(joints)} bones.", place
            )
        return inverse[: len(joints)].reshape(-1, 4, 4).swapaxes(1, 2)


def _used(corners: IndexArray | None, count: int, place: str) -> IndexArray:
    """Return the vertices that belong to any triangle, in ascending order."""
    if corners is None:
        return np.arange(count)
    used = np.unique(corners)
    if len(used) and used[-1] >= count:
        raise HumanoidFileError(
            f"A triangle refers to vertex {used[-1]}, but there are only {count}.", place
        )
    return used


def _influences(
    attributes: PrimitiveTables, primitive: Primitive, count: int, place: str
) -> tuple[IndexArray, FloatArray]:
    """Return (N, 4 or 8) bones of the skin, and weights, which add up to 1 or are all 0."""
    joints, weights = [], []
    for more in range(2):
        if f"JOINTS_{more}" not in primitive.attributes:
            continue
        if f"WEIGHTS_{more}" not in primitive.attributes:
            raise HumanoidFileError(f"It has JOINTS_{more} but no WEIGHTS_{more}.", place)
        joints.append(attributes.whole(f"JOINTS_{more}", "VEC4"))
        weights.append(attributes.floats(f"WEIGHTS_{more}", "VEC4"))
    if any(len(table) != count for table in (*joints, *weights)):
        raise HumanoidFileError(
            f"There are {count} vertices, but not as many rows of bones and weights.", place
        )
    shares = np.maximum(np.concatenate(weights, axis=1), 0.0)
    total = shares.sum(axis=1, keepdims=True)
    return np.concatenate(joints, axis=1), shares / np.where(total > 0.0, total, 1.0)


def skin_pieces(document: Document, tables: Tables, most: int) -> Iterator[SkinPiece]:
    """Yield the skin of every mesh; raise HumanoidFileError if they have over `most` vertices."""
    for piece, _ in _Reader(document, tables, most).pieces():
        yield piece


def skin_at_rest(document: Document, tree: Tree, tables: Tables, most: int) -> SkinnedVertices:
    """Return the vertices of all meshes at rest, at most `most`; raise HumanoidFileError."""
    rows = [
        _at_rest(piece, tree, place) for piece, place in _Reader(document, tables, most).pieces()
    ]
    if not rows:
        return SkinnedVertices(np.zeros((0, 3)), np.zeros(0, dtype=np.int64))
    return SkinnedVertices(
        np.concatenate([piece.places_m for piece in rows]),
        np.concatenate([piece.nodes for piece in rows]),
    )


def _at_rest(piece: SkinPiece, tree: Tree, place: str) -> SkinnedVertices:
    # A vertex without any weight has no certain position.
    weighted = piece.used[piece.weights[piece.used].any(axis=1)]
    places = posed_vertices(piece, tree.world, weighted)
    if not (np.abs(places) < _FARTHEST).all():
        raise HumanoidFileError("A vertex lies too far away to be part of a body.", place)
    strongest = np.argmax(piece.weights[weighted], axis=1)
    return SkinnedVertices(places, piece.bones[piece.joints[weighted, strongest]])
