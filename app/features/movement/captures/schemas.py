"""Request and response models of captures and their verification.

Lengths are in metres unless a name says otherwise. The verification is that of the paper, of one
movement on avatars of several statures: Degen et al. (2022) show that a walk keeps its
characteristics whatever the avatar's dimensions: the toe's path over the ground, its lifts, and
steps that grow with the legs. Its series are thinned for drawing and share `times_s`.
"""

from datetime import datetime
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from app.adapters.captures import WRITERS
from app.plain_titles import PlainTitle
from app.science.anatomy import Notice
from app.science.retargeting import FloorClearance

Kind = Literal["skeleton", "markers", "bodies"]
Up = Literal["x", "y", "z"]
Origin = Literal["file", "format", "guessed", "chosen"]
Shown = Literal["recorded", "skeleton"]
JointSource = Literal["name", "hierarchy", "chosen"]
AVATAR = r"^[0-9]{2,3}(\.[0-9])?cm$"
Avatar = Annotated[str, StringConstraints(pattern=AVATAR)]
"""A stature, such as "165cm" or "172.5cm", from 50 to 260 cm."""
MetresPerUnit = Annotated[float, Field(ge=1e-6, le=1000.0, allow_inf_nan=False)]
Title = PlainTitle
JointName = Annotated[str, StringConstraints(min_length=1, max_length=200)]
MAX_AVATARS = 6
MAX_BODY_JOINTS = 64
Side = Literal["left", "right"]
if TYPE_CHECKING:
    ExportFormat = str
else:
    # The interface lists what the registry holds; no type checker reads a computed Literal.
    ExportFormat = Literal[tuple(one.key for one in WRITERS)]


class ReadingChoice(BaseModel):
    """Conventions that a person gives for a file, where the file has none or wrong ones.

    `metres_per_unit`: the length of the file's unit; null to use the file's or a plausible one.
    `up`: the file's upward axis; null to use the file's or its format's.
    """

    model_config = ConfigDict(extra="forbid")

    metres_per_unit: MetresPerUnit | None = None
    up: Up | None = None


class CaptureChange(BaseModel):
    """Changes of a capture; missing fields stay. A new `reading` parses the file again."""

    model_config = ConfigDict(extra="forbid")

    title: Title | None = None
    reading: ReadingChoice | None = None


class ConventionView(BaseModel):
    """One convention by which the file was parsed, and where it comes from."""

    value: str
    origin: Origin


class ConventionsView(BaseModel):
    """The conventions of the file; parsed data are y up, right-handed and in SI units."""

    length: ConventionView
    axes: ConventionView
    rotations: ConventionView
    rate: ConventionView


class SkeletonView(BaseModel):
    """The skeleton of a capture: its file's own, or one that was fitted to markers or bodies.

    `parents` are indices into `joints`, -1 for the root. `unfitted` are joints that the markers do
    not show; `residual_m` is the distance of the fitted skeleton from the recording (root mean
    square), null for a skeleton of the file; `notes` say what was trimmed, bridged or left out.
    `notices` are empty for captures that were inspected before bodies were checked by anatomy.
    """

    fingerprint: str
    origin: Literal["file", "fitted"]
    joints: list[str]
    parents: list[int]
    unfitted: list[str]
    residual_m: float | None
    notes: list[str]
    notices: list[Notice] = []


class CaptureSummary(BaseModel):
    """The summary of a parsed capture.

    `names` are the joints, markers or rigid bodies of the file. `skeleton` is null if none could be
    fitted; `no_skeleton` then says why. `observed` is the share of values that were seen.
    """

    names: list[str]
    observed: float
    conventions: ConventionsView
    notes: list[str]
    skeleton: SkeletonView | None
    no_skeleton: str | None


class CaptureListed(BaseModel):
    """A capture in a list.

    `format` is a key such as "bvh" or "motive-csv". `tracks` counts its joints, markers or bodies.
    `has_skeleton`: it can be retargeted to avatars. `size_bytes` is that of the file.
    """

    id: str
    title: str
    file_name: str
    companion_name: str | None
    format: str
    kind: Kind
    frames: int
    rate_hz: float
    duration_s: float
    tracks: int
    has_skeleton: bool
    size_bytes: int
    by: str
    at: datetime


class CaptureView(CaptureListed):
    """A capture with its summary; `content_hash` is the SHA-256 of the file."""

    content_hash: str
    reading: ReadingChoice
    summary: CaptureSummary


class CapturePage(BaseModel):
    """A page of captures, newest first, and the total number of captures."""

    captures: list[CaptureListed]
    total: int


class JointMapWish(BaseModel):
    """A joint map to save, body joint -> joint of the skeleton, edited from `version`."""

    model_config = ConfigDict(extra="forbid")

    joint_map: dict[JointName, JointName] = Field(max_length=MAX_BODY_JOINTS)
    version: int = Field(ge=0, le=2**31 - 1)


class JointMapView(BaseModel):
    """A skeleton's joint map: its joint for each body joint, in every capture with this skeleton.

    `version` counts the saved maps, from 0; `chosen` is false while the map is the proposal.
    `sources` says for each mapped body joint whether its name, its place in the hierarchy, or a
    person decided. `usable` is false if too few joints are mapped for retargeting, and `missing`
    says which are needed.
    """

    fingerprint: str
    version: int
    chosen: bool
    by: str | None
    at: datetime | None
    joint_map: dict[str, str]
    proposal: dict[str, str]
    sources: dict[str, JointSource]
    body_joints: list[str]
    rig_joints: list[str]
    rig_parents: list[int]
    unmapped_body_joints: list[str]
    unmapped_rig_joints: list[str]
    usable: bool
    missing: list[str]
    captures: int


class LegAnglesView(BaseModel):
    """Angles of one leg in degrees over time; figure 8 of the paper.

    Forward and bent are positive; 0 is a straight hip, a straight knee, an ankle at right angles.
    """

    side: Side
    hip_deg: list[float]
    knee_deg: list[float]
    ankle_deg: list[float]


class ToePathView(BaseModel):
    """The path of the ball of one foot (the toe joint) in metres; figure 9 of the paper.

    `forward_m` is along the walk, `height_m` above the ground; `start_height_m` in the first frame.
    """

    side: Side
    forward_m: list[float]
    height_m: list[float]
    start_height_m: float


class WalkStrideView(BaseModel):
    """One stride: a lift of a foot, from leaving the ground to its next contact.

    `length_m` is how far the ball moves forward, `height_m` from its lowest to its highest
    position, `contact_height_m` its height above the ground at the contact.
    """

    side: Side
    lift_s: float
    contact_s: float
    length_m: float
    height_m: float
    contact_height_m: float


class WalkerView(BaseModel):
    """The walk of one body, the source or an avatar.

    `leg_length_m` is thigh plus shin, `thigh_share` the thigh's part of it. A stride leads from
    a contact of a foot to the next one of the same foot, a step to the next one of the other.
    Means are null without a complete stride or step. `foot_slide_m_s` is the mean speed of its
    feet over the ground while they are down, null if none is.
    """

    name: str
    leg_length_m: float
    thigh_share: float
    toe_paths: list[ToePathView]
    strides: list[WalkStrideView]
    mean_stride_length_m: float | None
    mean_step_length_m: float | None
    mean_step_height_m: float | None
    foot_slide_m_s: float | None


class AvatarWalkerView(WalkerView):
    """The walk of an avatar, compared with the source.

    `leg_ratio` is its leg length over the source's, `length_ratio` and `height_ratio` the same
    ratios of mean stride lengths and step heights (null without strides). `lifts_agree`: it lifts
    each foot as often as the source. Slides are speeds of its feet while the *source's* are down:
    `slide_m_s` as shown here, `slide_before_m_s` before the feet were locked, null if they are not.
    With locked feet, `lowered_m` is how far the hips came down at most, and `out_of_reach` counts
    frames in which a foot could not be kept in place. `floor` says how deep the feet are under the
    floor, and by how much the body was raised for it; `notices` what the walk shows to be wrong.
    """

    stature_m: float
    leg_ratio: float
    length_ratio: float | None
    height_ratio: float | None
    lifts_agree: bool
    slide_m_s: float | None
    slide_before_m_s: float | None
    lowered_m: float | None
    out_of_reach: int | None
    floor: FloorClearance
    notices: list[Notice]


class VerificationView(BaseModel):
    """The verification of a movement: the source and every avatar.

    `lifts_agree`: every avatar lifts each foot as often as the source.
    `largest_timing_difference_s`: between the same lift or contact of any two bodies; null if the
    lifts do not agree. `unmapped_body_joints` keep their T-pose on every avatar.
    """

    frames: int
    rate_hz: float
    lock_feet: bool
    times_s: list[float]
    leg_angles: list[LegAnglesView]
    source: WalkerView
    avatars: list[AvatarWalkerView]
    lifts_agree: bool
    largest_timing_difference_s: float | None
    unmapped_body_joints: list[str]
