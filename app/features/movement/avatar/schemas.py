"""Request and response models of avatar configurations; each configuration is as in its file."""

from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StringConstraints

from app.plain_titles import PlainTitle, plain_lines
from app.platform.config_problems import ProblemView
from app.protocol.avatar import AvatarFile
from app.protocol.avatar_editing import Operation
from app.protocol.avatar_joints import JointView

MAX_FILE_CHARACTERS = 262_144
MAX_VERSION = 1_000_000
MAX_OPERATIONS = 200
"""The page sends one edit at a time; so many take a second or two."""

Origin = Literal["shipped", "tuned", "by_hand", "loaded"]
Made = Literal["tuned", "by_hand", "loaded"]
AvatarKey = Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_-]{0,79}$")]
AvatarTitle = PlainTitle
Note = Annotated[str, StringConstraints(max_length=2_000), AfterValidator(plain_lines)]


class NewAvatarVersion(BaseModel):
    """A configuration to append; `based_on` is the version that it was edited from, 0 for none."""

    model_config = ConfigDict(extra="forbid")

    based_on: Annotated[int, Field(strict=True, ge=0, le=MAX_VERSION)]
    origin: Made
    note: Note = ""
    configuration: AvatarFile


class NewAvatar(BaseModel):
    """A configuration to save under a new key; `title` is its display name."""

    model_config = ConfigDict(extra="forbid")

    key: AvatarKey
    title: AvatarTitle
    origin: Made
    note: Note = ""
    configuration: AvatarFile


class BoxToDrop(BaseModel):
    """A box for a model, which hovers out of the body's way until it is dropped."""

    model_config = ConfigDict(extra="forbid")

    edge_m: Annotated[float, Field(strict=True, ge=0.05, le=1, allow_inf_nan=False)] = 0.2
    mass_kg: Annotated[float, Field(strict=True, ge=0.1, le=50, allow_inf_nan=False)] = 2.0


class ModelToTry(BaseModel):
    """A configuration that need not be stored, whose model is to be tried; with `box`, also that.

    The body `box` of such a model has a free joint, and weighs nothing until its `gravcomp` is 0.
    """

    model_config = ConfigDict(extra="forbid")

    configuration: AvatarFile
    stature_m: Annotated[float, Field(strict=True, ge=0.5, le=2.6, allow_inf_nan=False)]
    box: BoxToDrop | None = None


class AvatarText(BaseModel):
    """The text of a configuration file."""

    model_config = ConfigDict(extra="forbid")

    text: Annotated[str, Field(max_length=MAX_FILE_CHARACTERS)]


class AvatarVersionView(BaseModel):
    """One version of an avatar configuration, without its content."""

    number: int
    content_hash: str
    origin: Origin
    note: str
    by: str
    at: datetime


class AvatarSummary(BaseModel):
    """A configuration in a list, in its newest version.

    `content_hashes` are those of all its versions, from version 1 on.
    `axes` counts its driven axes, `locked_axes` those that cannot move; `sessions` counts the
    sessions of the reader's studies that used any of its versions. Both numbers of axes are null
    if the newest version was damaged in the database, so that it cannot be read.
    """

    key: str
    title: str
    newest: AvatarVersionView
    versions: int
    content_hashes: list[str]
    axes: int | None
    locked_axes: int | None
    sessions: int


class AvatarUse(BaseModel):
    """A version of a study that names an avatar's version, or whose sessions used its content.

    `running_sessions` are those of `sessions` that have started and not ended.
    """

    study: str
    title: str
    study_version: int
    is_newest: bool
    sessions: int
    running_sessions: int


class AvatarVersionDetail(AvatarVersionView):
    """A complete version; `report`: the measurements and settings of its tuning, if it was tuned.

    `sessions` counts the sessions of the reader's studies that used this content; `used_by` lists
    these studies and those that will use it. A version is never edited, so what they use stays as
    it is: an edit is saved as a new version, and a study uses it once it names it. `joints`: the
    configuration as the single template has it, one joint per driven part.
    """

    key: str
    title: str
    configuration: AvatarFile
    joints: dict[str, JointView]
    report: dict[str, Any] | None
    sessions: int
    used_by: list[AvatarUse]


class AvatarView(BaseModel):
    """A configuration with all its versions, newest first, and the complete newest version."""

    key: str
    title: str
    by: str
    at: datetime
    newest: AvatarVersionDetail
    versions: list[AvatarVersionView]


class AvatarCheck(BaseModel):
    """Whether a file can be used; `known` lists each (key, version) with the same content."""

    ok: bool
    problems: list[ProblemView] = []
    content_hash: str | None = None
    configuration: AvatarFile | None = None
    known: list[tuple[str, int]] = []


class AvatarEdit(BaseModel):
    """Operations to apply to a configuration, one after the other."""

    model_config = ConfigDict(extra="forbid")

    configuration: AvatarFile
    operations: Annotated[list[Operation], Field(max_length=MAX_OPERATIONS)]


class ValueChangeView(BaseModel):
    """A value that differs between two configurations.

    `path`: its place in the file; `field`: its key, such as kp_nm_per_rad; `part` and `axis`:
    what it belongs to, null for the whole body; `groups`: the body groups of the part but `all`.
    `old` and `new` are null where a configuration does not have the value.
    """

    path: str
    field: str
    part: str | None
    axis: str | None
    groups: list[str]
    unit: str
    old: Any
    new: Any


class LossView(BaseModel):
    """A value that a conversion cannot keep; `operation`: its position, from 0."""

    operation: int
    change: ValueChangeView
    reason: str


class OperationProblemView(BaseModel):
    """Why an operation cannot be made.

    `operation`: its position, from 0; null for the configuration before or after all operations.
    """

    operation: int | None
    path: str
    message: str
    value: Any = None
    valid: Any = None
    remedy: str = ""


class AvatarEdited(BaseModel):
    """The result of operations; nothing is stored.

    If there are `problems`, `configuration` is the one that was given and nothing was changed; but
    one that lacks parts of the body is edited, and the problem names what it lacks before it can be
    saved.
    `changed`: every value that differs from the configuration given; `lost`: what conversions
    cannot keep. `joints`: the result as the single template has it, one joint per driven part;
    `fits_single_template`: whether that loses nothing.
    """

    configuration: AvatarFile
    content_hash: str | None
    changed: list[ValueChangeView]
    lost: list[LossView]
    problems: list[OperationProblemView]
    joints: dict[str, JointView]
    fits_single_template: bool


class GroupDifference(BaseModel):
    """The body parts of a group that differ, and in how many values; for the largest groups only.

    Every part is in one of the groups: trunk, head, and of either side arm, fingers, leg. `parts`
    is empty if the group differs only in how it gives way when it is pushed.
    """

    group: str
    parts: list[str]
    values: int


class AvatarVersionDifference(BaseModel):
    """How a version differs from another one of the same avatar.

    `changed` are the values, first those of the whole body, then by part and axis; `groups` sums
    them up. `old` and `new` tell who saved the two versions, when and with which note.
    """

    key: str
    title: str
    old: AvatarVersionView
    new: AvatarVersionView
    same: bool
    changed: list[ValueChangeView]
    groups: list[GroupDifference]
