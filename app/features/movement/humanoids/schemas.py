"""Request and response models of bodies, which are humanoid models; lengths are in metres."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from app.adapters.humanoids import Permission, Wearers
from app.plain_titles import PlainTitle
from app.protocol import BodyName

BonesBy = Literal["vrm", "names"]
Origin = Literal["shipped", "uploaded"]
BodyTitle = PlainTitle
Use = Literal[
    "commercial", "modification", "redistribution", "violent", "sexual", "political", "antisocial"
]
Term = Literal["only_author", "only_licensed_people"]
"""A term of a licence that somebody has to confirm: only the author, or only people to whom the
author has given permission, may wear the body."""
CheckKey = Literal[
    "parts",
    "fingers",
    "rest_pose",
    "proportions",
    "reach",
    "triangles",
    "hulls",
    "licence",
    "wearing",
]
CheckStatus = Literal["good", "note", "warn", "unknown"]
LengthName = Literal[
    "upper_arm",
    "forearm",
    "hand",
    "thigh",
    "shank",
    "foot",
    "trunk",
    "shoulders",
    "hips",
    "arm",
    "shoulder_height",
]
"""`shoulders` and `hips` are breadths, `arm` is from the shoulder's joint to the wrist."""


class LicenceView(BaseModel):
    """What the file of a body says about its author and terms; texts are empty if it says nothing.

    `name` is the licence's, `url` and `other_url` lead to its terms. `wearers`: who may wear it.
    `permissions`: what its author allows, by kind of use. `credit_needed`: whether its authors must
    be named.
    """

    title: str
    authors: list[str]
    contact: str
    copyright: str
    name: str
    url: str
    other_url: str
    wearers: Wearers
    permissions: dict[Use, Permission]
    credit_needed: bool | None


class ConfirmationView(BaseModel):
    """A term of a body's licence that somebody has confirmed to be met."""

    term: Term
    by: str
    at: datetime


class CheckedLength(BaseModel):
    """A length of a body that a check is about, with those of people of its stature.

    `usual_m`: that of a person of this stature. `low_m` and `high_m`: the range that people of it
    have; null where the check compares with one person only.
    """

    name: LengthName
    length_m: float
    usual_m: float
    low_m: float | None = None
    high_m: float | None = None


class BodyCheck(BaseModel):
    """One thing that was checked about a body.

    `parts`: the body parts that the check is about. `value` and `limit`: what was measured, and
    what it was compared with. `lengths` are those that the result comes from, for a stature of
    `stature_m`. `notes` are sentences about the result.
    """

    key: CheckKey
    status: CheckStatus
    parts: list[str] = []
    value: float | None = None
    limit: float | None = None
    lengths: list[CheckedLength] = []
    stature_m: float | None = None
    notes: list[str] = []


class BodyChange(BaseModel):
    """A change of a body: a name, which can be given only once, a title, or confirmed terms."""

    model_config = ConfigDict(extra="forbid")

    name: BodyName | None = None
    title: BodyTitle | None = None
    confirmed: Annotated[list[Term], Field(max_length=2)] = []


class HumanoidListed(BaseModel):
    """A body in a list.

    `content_hash` is the SHA-256 of its file, by which configurations refer to it, `name` what
    studies call it, null until it is given. `stature_m` is its own; an avatar has that of its
    participant. `bones_by`: whether bones were identified by VRM's map or by their names. Counts
    are of body parts that the model has, and of those with a convex piece; those of triangles,
    vertices and textures are null if an earlier release measured the body. `attention`: the checks
    that ask for attention before somebody wears it; `reach_off_m`: how far its hand is from that of
    a participant who reaches straight ahead, for a stature of 1.7 m.
    """

    content_hash: str
    name: str | None
    title: str | None
    origin: Origin
    file_name: str
    size_bytes: int
    stature_m: float
    bones_by: BonesBy
    parts: int
    pieces: int
    left_fingers: int
    right_fingers: int
    triangles: int | None
    vertices: int | None
    textures: int | None
    licence: LicenceView | None
    attention: list[CheckKey]
    reach_off_m: float | None
    by: str
    at: datetime


class PieceView(BaseModel):
    """The convex piece of one body part: its corners, and how far skin is outside it at most."""

    part: str
    corners: int
    outside_m: float


class HumanoidView(HumanoidListed):
    """A body in full.

    `present` and `absent` are the body parts it has and lacks; those in `simple` have too little
    skin for a convex piece and keep capsules and boxes. `segments_m` are its lengths. `notes` are
    sentences on anything unusual in the file. `asked`: the terms of its licence that must still
    be confirmed before it is worn; `confirmations`: those that have been confirmed.
    """

    present: list[str]
    absent: list[str]
    simple: list[str]
    convex_pieces: list[PieceView]
    segments_m: dict[str, float]
    notes: list[str]
    asked: list[Term]
    confirmations: list[ConfirmationView]
    checks: list[BodyCheck]


class WornBy(BaseModel):
    """A study whose newest version uses a body, in its conditions or in its configuration."""

    key: str
    title: str
    version: int


class ConfigurationUse(BaseModel):
    """A version of an avatar configuration that uses the body."""

    key: str
    title: str
    version: int


class BodyUse(BaseModel):
    """Where a body is used: avatar configurations, and studies that the reader may see."""

    configurations: list[ConfigurationUse]
    studies: list[WornBy]


class BindingView(BaseModel):
    """How the nodes of a model's file follow the parts of its body, all in the model's own size.

    World: x right, y up, facing -z, soles at height 0. The frame of a part has its origin in the
    part's joint and is parallel to the world in the T-pose. `parts` are those that the model has,
    parents first; `parents` are rows of `parts`, -1 for the hips, and `joints_m` their joints in
    the T-pose. `nodes` are the glTF nodes that the parts move: world_from_node is world_from_part
    times `part_from_node`, each 16 numbers, row by row. Nodes below a part keep their local
    transform; nodes above the hips keep their place relative to the hips. For another stature,
    multiply `joints_m` and the first three rows of each matrix by that stature / `stature_m`.
    """

    stature_m: float
    parts: list[str]
    parents: list[int]
    joints_m: list[Annotated[list[float], Field(min_length=3, max_length=3)]]
    nodes: list[int]
    part_from_node: list[Annotated[list[float], Field(min_length=16, max_length=16)]]


class HumanoidPage(BaseModel):
    """A page of bodies, newest first, and the total number of bodies."""

    humanoids: list[HumanoidListed]
    total: int
