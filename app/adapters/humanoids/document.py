"""The parts of a glTF's JSON that concern bones and skin: typed, and within limits.

Source: Khronos, glTF 2.0 specification, section 5; VRM consortium, VRM 0.0 (`VRM`) and 1.0
(`VRMC_vrm`), humanoid. Everything else in a file is ignored.
"""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from app.adapters.humanoids.container import HumanoidFileError
from app.adapters.humanoids.rights import Asset, Vrm0Meta, Vrm1Meta

MOST_NODES = 5_000
_MOST = 20_000
_MOST_NUMBER = 2**40
Index = Annotated[int, Field(ge=0, lt=_MOST_NUMBER)]
Name = Annotated[str, Field(max_length=1_000)]
Number = Annotated[float, Field(ge=-1e9, le=1e9)]
Three = Annotated[list[Number], Field(min_length=3, max_length=3)]
Four = Annotated[list[Number], Field(min_length=4, max_length=4)]
Sixteen = Annotated[list[Number], Field(min_length=16, max_length=16)]


class _Part(BaseModel):
    model_config = ConfigDict(strict=True, allow_inf_nan=False)


class Node(_Part):
    """A node: a bone, or the position of a mesh."""

    name: Name = ""
    children: Annotated[list[Index], Field(max_length=MOST_NODES)] = []
    mesh: Index | None = None
    skin: Index | None = None
    matrix: Sixteen | None = None
    translation: Three = [0.0, 0.0, 0.0]
    rotation: Four = [0.0, 0.0, 0.0, 1.0]
    scale: Three = [1.0, 1.0, 1.0]


class Buffer(_Part):
    """A block of bytes, embedded in the JSON or in the binary chunk."""

    byteLength: Index  # noqa: N815 - as in the file
    uri: str | None = None


class Meshopt(_Part):
    """The compressed form of a view: `EXT_meshopt_compression` or `KHR_meshopt_compression`."""

    buffer: Index
    byteLength: Index  # noqa: N815
    byteOffset: Index = 0  # noqa: N815
    byteStride: Annotated[int, Field(ge=2, le=256)]  # noqa: N815
    count: Annotated[int, Field(ge=1, lt=_MOST_NUMBER)]
    mode: Literal["ATTRIBUTES", "TRIANGLES", "INDICES"]
    filter: Annotated[str, Field(max_length=20)] = "NONE"


class ViewExtensions(_Part):
    """The extensions of a view; either name may stand for the same compression."""

    ext_meshopt: Meshopt | None = Field(None, alias="EXT_meshopt_compression")
    khr_meshopt: Meshopt | None = Field(None, alias="KHR_meshopt_compression")


class BufferView(_Part):
    """A part of a buffer."""

    buffer: Index
    byteLength: Index  # noqa: N815
    byteOffset: Index = 0  # noqa: N815
    byteStride: Annotated[int, Field(ge=1, le=252)] | None = None  # noqa: N815
    extensions: ViewExtensions | None = None

    @property
    def compressed(self) -> Meshopt | None:
        """Return the compressed form, if the view has one."""
        own = self.extensions
        return None if own is None else own.ext_meshopt or own.khr_meshopt


class Accessor(_Part):
    """A table of numbers in a view."""

    componentType: int  # noqa: N815
    count: Annotated[int, Field(ge=1, lt=_MOST_NUMBER)]
    type: Annotated[str, Field(max_length=10)]
    bufferView: Index | None = None  # noqa: N815
    byteOffset: Index = 0  # noqa: N815
    normalized: bool = False
    sparse: object = None


class Draco(_Part):
    """The compressed form of a primitive, `KHR_draco_mesh_compression`.

    It has the view with the stream, and the number of each attribute in the stream.
    """

    bufferView: Index  # noqa: N815
    attributes: Annotated[dict[Name, Index], Field(max_length=100)]


class PrimitiveExtensions(_Part):
    """The extensions of a primitive."""

    draco: Draco | None = Field(None, alias="KHR_draco_mesh_compression")


class Primitive(_Part):
    """The triangles of a mesh with one material."""

    extensions: PrimitiveExtensions | None = None
    attributes: Annotated[dict[Name, Index], Field(max_length=100)]
    indices: Index | None = None
    mode: Annotated[int, Field(ge=0, le=6)] = 4


class Mesh(_Part):
    """A mesh, which nodes refer to."""

    primitives: Annotated[list[Primitive], Field(max_length=_MOST)]


class Skin(_Part):
    """The bones of a mesh, and the matrices that transform its vertices into their frames."""

    joints: Annotated[list[Index], Field(min_length=1, max_length=MOST_NODES)]
    inverseBindMatrices: Index | None = None  # noqa: N815


class Vrm0Bone(_Part):
    """A bone of VRM 0; its node is -1 if the model lacks the bone."""

    bone: Name
    node: Annotated[int, Field(ge=-1, lt=_MOST_NUMBER)]


class Vrm0Humanoid(_Part):
    """The humanoid of VRM 0, with bones in a list."""

    humanBones: Annotated[list[Vrm0Bone], Field(max_length=200)]  # noqa: N815


class Vrm0(_Part):
    """The glTF extension `VRM` (VRM 0)."""

    humanoid: Vrm0Humanoid | None = None
    meta: Vrm0Meta | None = None


class Vrm1Bone(_Part):
    """A bone of VRM 1.0."""

    node: Index


class Vrm1Humanoid(_Part):
    """The humanoid of VRM 1.0, with bones by name."""

    humanBones: Annotated[dict[Name, Vrm1Bone], Field(max_length=200)]  # noqa: N815


class Vrm1(_Part):
    """The glTF extension `VRMC_vrm` (VRM 1.0)."""

    humanoid: Vrm1Humanoid
    meta: Vrm1Meta | None = None


class Extensions(_Part):
    """The extensions that map a humanoid's bones, of both versions of VRM."""

    vrm0: Vrm0 | None = Field(None, alias="VRM")
    vrm1: Vrm1 | None = Field(None, alias="VRMC_vrm")


class Image(_Part):
    """A texture's image, in a view or embedded in the JSON."""

    bufferView: Index | None = None  # noqa: N815
    uri: str | None = None


class Document(_Part):
    """The JSON of a glTF file."""

    asset: Asset = Asset()
    images: Annotated[list[Image], Field(max_length=_MOST)] = []

    extensionsRequired: Annotated[list[Name], Field(max_length=200)] = []  # noqa: N815
    nodes: Annotated[list[Node], Field(max_length=MOST_NODES)] = []
    meshes: Annotated[list[Mesh], Field(max_length=_MOST)] = []
    skins: Annotated[list[Skin], Field(max_length=_MOST)] = []
    accessors: Annotated[list[Accessor], Field(max_length=200_000)] = []
    bufferViews: Annotated[list[BufferView], Field(max_length=200_000)] = []  # noqa: N815
    buffers: Annotated[list[Buffer], Field(max_length=_MOST)] = []
    extensions: Extensions | None = None


_ADAPTER = TypeAdapter(Document)


def read_document(text: bytes) -> Document:
    """Parse the file's JSON; raise HumanoidFileError with the first problem."""
    try:
        return _ADAPTER.validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False, include_context=False)[0]
        more = f" ({error.error_count() - 1} more)" if error.error_count() > 1 else ""
        place = ".".join(str(step) for step in first["loc"])
        raise HumanoidFileError(f"{first['msg']}{more}.", place) from None
