"""Response models of humanoid models; lengths are in metres."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, Field

BonesBy = Literal["vrm", "names"]


class HumanoidListed(BaseModel):
    """A humanoid model in a list.

    `content_hash` is the SHA-256 of its file, by which configurations refer to it. `stature_m` is
    its own; an avatar has that of its participant. `bones_by`: whether bones were identified by
    VRM's map or by their names. Counts are of body parts that the model has, and of those with a
    convex piece.
    """

    content_hash: str
    file_name: str
    size_bytes: int
    stature_m: float
    bones_by: BonesBy
    parts: int
    pieces: int
    left_fingers: int
    right_fingers: int
    by: str
    at: datetime


class PieceView(BaseModel):
    """The convex piece of one body part: its corners, and how far skin is outside it at most."""

    part: str
    corners: int
    outside_m: float


class HumanoidView(HumanoidListed):
    """A humanoid model in full.

    `present` and `absent` are the body parts it has and lacks; those in `simple` have too little
    skin for a convex piece and keep capsules and boxes. `segments_m` are its lengths. `notes` are
    sentences on anything unusual in the file.
    """

    present: list[str]
    absent: list[str]
    simple: list[str]
    convex_pieces: list[PieceView]
    segments_m: dict[str, float]
    notes: list[str]


class BindingView(BaseModel):
    """How the nodes of a model's file follow the parts of its body; all in its own size.

    World: x right, y up, facing -z, soles at height 0. The frame of a part has its origin in the
    part's joint and is parallel to the world in the T-pose. `parts` are those that the model has,
    parents first; `parents` are rows of `parts`, -1 for the hips, and `joints_m` their joints in
    the T-pose. `nodes` are the glTF nodes that the parts move: world_from_node is world_from_part
    times `part_from_node`, each 16 numbers, row by row. Nodes below a part keep their local
    transform; nodes above the hips keep their place relative to the hips. For another stature,
    multiply `joints_m` and the first three rows of each matrix by it / `stature_m`.
    """

    stature_m: float
    parts: list[str]
    parents: list[int]
    joints_m: list[Annotated[list[float], Field(min_length=3, max_length=3)]]
    nodes: list[int]
    part_from_node: list[Annotated[list[float], Field(min_length=16, max_length=16)]]


class HumanoidPage(BaseModel):
    """A page of humanoid models, newest first, and the total number of models."""

    humanoids: list[HumanoidListed]
    total: int
