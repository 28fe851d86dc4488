"""Response models of humanoid models; lengths are in metres."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

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


class HumanoidPage(BaseModel):
    """A page of humanoid models, newest first, and the total number of models."""

    humanoids: list[HumanoidListed]
    total: int
