"""Read a glTF or VRM file as a humanoid in the T-pose.

The parser is our own, because a body needs so little of a file (nodes, skins, positions and weights
of vertices), and because an untrusted file must do no harm: every index and size is checked against
the data before it is used.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.adapters.humanoids.accessors import Tables
from app.adapters.humanoids.bone_names import named_bones, vrm_nodes
from app.adapters.humanoids.container import HumanoidFileError, open_container
from app.adapters.humanoids.contents import Contents, check_textures, contents_of
from app.adapters.humanoids.document import Document, read_document
from app.adapters.humanoids.nodes import Tree, rig_of, tree_of
from app.adapters.humanoids.rights import ModelRights, rights_of
from app.adapters.humanoids.skin import skin_at_rest, skin_pieces
from app.science.avatar.body import (
    Binding,
    Humanoid,
    HumanoidError,
    NodeTree,
    RiggedMesh,
    SkinPiece,
    bind,
    humanoid_of,
)
from app.science.rig import RigError

MapSource = Literal["vrm", "names"]


@dataclass(frozen=True)
class Limits:
    """The largest sizes of a file that are accepted; real models stay far below."""

    bytes: int = 256_000_000
    vertices: int = 2_000_000
    values: int = 60_000_000
    """Largest total number of values."""


@dataclass(frozen=True, eq=False)
class ReadHumanoid:
    """A model in the T-pose, and how the nodes of its file follow its parts.

    `bones_by` is how its bones were identified. `rights` are what the file says about its author
    and its use, `contents` what it costs to draw. `arms_turned_deg`: how far its arms were turned
    into the T-pose.
    """

    humanoid: Humanoid
    bones_by: MapSource
    binding: Binding
    rights: ModelRights
    contents: Contents
    arms_turned_deg: float


@dataclass(frozen=True, eq=False)
class ReadSkin:
    """The nodes of a file and all its skin; `posed_nodes` and `posed_vertices` move them."""

    tree: NodeTree
    pieces: tuple[SkinPiece, ...]


def read_humanoid(
    data: bytes, limits: Limits | None = None, *, check_pictures: bool = True
) -> ReadHumanoid:
    """Read a humanoid model from GLB, glTF with embedded buffers, or VRM 0.x and 1.0.

    `check_pictures`: whether pictures that are too large, or damaged, are an error.

    Raises:
        HumanoidFileError: the file cannot be read, with the place; or the model is not a humanoid,
            with the missing parts.
    """
    most = Limits() if limits is None else limits
    document, tables = _opened(data, most)
    contents = contents_of(document, tables)
    if check_pictures:
        check_textures(contents.textures)
    tree = tree_of(document)
    mapped = vrm_nodes(document)
    mesh, node_of_bone = _mesh(document, tree, tables, mapped, most)
    try:
        posed = humanoid_of(mesh)
        nodes = {part: node_of_bone[bone] for part, bone in mesh.bones.items()}
        binding = bind(posed, mesh.bones, nodes, tree.world)
    except (HumanoidError, RigError) as error:
        raise HumanoidFileError(str(error)) from error
    return ReadHumanoid(
        posed.humanoid,
        "names" if mapped is None else "vrm",
        binding,
        _rights(document),
        contents,
        posed.arms_turned_deg,
    )


def read_skin(data: bytes, limits: Limits | None = None) -> ReadSkin:
    """Read the skin of a model, with all its vertices; raises HumanoidFileError."""
    most = Limits() if limits is None else limits
    document, tables = _opened(data, most)
    return ReadSkin(tree_of(document), tuple(skin_pieces(document, tables, most.vertices)))


def _rights(document: Document) -> ModelRights:
    extensions = document.extensions
    if extensions is None:
        return rights_of(document.asset, None, None)
    # A VRM without a `meta` says nothing: the specification's defaults are those of a `meta`.
    return rights_of(
        document.asset,
        None if extensions.vrm0 is None else extensions.vrm0.meta,
        None if extensions.vrm1 is None else extensions.vrm1.meta,
    )


def _opened(data: bytes, most: Limits) -> tuple[Document, Tables]:
    if len(data) > most.bytes:
        raise HumanoidFileError(f"The file has {len(data)} bytes; up to {most.bytes} are read.")
    container = open_container(data)
    document = read_document(container.text)
    if not document.nodes:
        raise HumanoidFileError("The file has no nodes, so there are no bones.", "nodes")
    return document, Tables(document, container.binary, most.values)


def _mesh(
    document: Document,
    tree: Tree,
    tables: Tables,
    mapped: dict[str, int] | None,
    most: Limits,
) -> tuple[RiggedMesh, dict[int, int]]:
    """Return the bones with the skin on them, and bone -> node."""
    skin = skin_at_rest(document, tree, tables, most.vertices)
    rig, bone_of = rig_of(tree, _bone_nodes(document, mapped))
    if mapped is None:
        bones = named_bones(rig)
    else:
        bones = {part: bone_of[node] for part, node in mapped.items()}
    # A mesh that follows no bone, such as a floor below the figure, is not part of the skin.
    owner = np.full(len(tree.names), -1, dtype=np.int64)
    for node in tree.order:
        above = tree.parents[node]
        owner[node] = bone_of.get(node, owner[above] if above >= 0 else -1)
    owners = owner[skin.nodes]
    owned = owners >= 0
    node_of_bone = {bone: node for node, bone in bone_of.items()}
    return RiggedMesh(rig, bones, skin.places_m[owned], owners[owned]), node_of_bone


def _bone_nodes(document: Document, mapped: dict[str, int] | None) -> set[int]:
    """Return the nodes that may be bones: those of skins and VRM's map, or all without either."""
    nodes = set() if mapped is None else set(mapped.values())
    nodes |= {
        joint for skin in document.skins for joint in skin.joints if joint < len(document.nodes)
    }
    return nodes or set(range(len(document.nodes)))
