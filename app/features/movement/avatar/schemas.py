"""Request and response models of avatar configurations; each configuration is as in its file."""

from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from app.platform.config_problems import ProblemView
from app.protocol.avatar import AvatarFile

MAX_FILE_CHARACTERS = 262_144
MAX_VERSION = 1_000_000

Origin = Literal["shipped", "tuned", "by_hand", "loaded"]
Made = Literal["tuned", "by_hand", "loaded"]
AvatarKey = Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_-]{0,79}$")]
AvatarTitle = Annotated[
    str,
    StringConstraints(
        strip_whitespace=True, min_length=1, max_length=200, pattern=r"^[^\x00-\x1f\x7f]+$"
    ),
]
Note = Annotated[
    str, StringConstraints(max_length=2_000, pattern=r"^[^\x00-\x08\x0b\x0c\x0e-\x1f\x7f]*$")
]


class NewAvatarVersion(BaseModel):
    """A configuration to append; `based_on` is the version that it was edited from, 0 for none."""

    model_config = ConfigDict(extra="forbid")

    based_on: Annotated[int, Field(ge=0, le=MAX_VERSION)]
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

    `axes` counts its driven axes, `locked_axes` those that cannot move; `sessions` counts the
    sessions of the reader's studies that used any of its versions.
    """

    key: str
    title: str
    newest: AvatarVersionView
    versions: int
    axes: int
    locked_axes: int
    sessions: int


class AvatarVersionDetail(AvatarVersionView):
    """A complete version; `report`: the measurements and settings of its tuning, if it was tuned.

    `sessions` counts the sessions of the reader's studies that used this content.
    """

    key: str
    title: str
    configuration: AvatarFile
    report: dict[str, Any] | None
    sessions: int


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
