"""Humanoid models as pages see them; lengths in metres."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

BonesBy = Literal["vrm", "names"]


class HumanoidListed(BaseModel):
    """A model in the list.

    `content_hash` is the SHA-256 of its file, by which configurations name it. `stature_m` is its
    own; an avatar has its participant's. `bones_by`: whether VRM's map or the bones' names told
    which is which. Counts are of body parts that the model has, and of those with a convex piece.
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
    """The convex piece of one part: its corners, and how far skin is outside of it at most."""

    part: str
    corners: int
    outside_m: float


class HumanoidView(HumanoidListed):
    """A model in full.

    `present` and `absent` are the body parts it has and lacks; `simple` has too little skin for a
    piece, so those keep capsules and boxes. `segments_m` are its lengths. `notes` are sentences on
    what was found odd while reading.
    """

    present: list[str]
    absent: list[str]
    simple: list[str]
    convex_pieces: list[PieceView]
    segments_m: dict[str, float]
    notes: list[str]


class HumanoidPage(BaseModel):
    """Models, the newest first, and how many there are in all."""

    humanoids: list[HumanoidListed]
    total: int
