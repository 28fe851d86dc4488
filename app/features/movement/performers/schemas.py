"""Request and response models of performers: skeletons that are sent live."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from app.features.movement.live import DoorKey
from app.features.movement.performers.performer import AgreedPose, PerformerName
from app.features.movement.performers.recording import Gap, RecordingState

Named = Annotated[str, StringConstraints(max_length=64)]
PerformerState = Literal["gathering", "unusable", "ready"]
WatchState = Literal["refused", "absent", "silent", "gathering", "unusable", "ready"]


class PerformerWish(BaseModel):
    """Which performer: of two senders of one name, the one that is used."""

    model_config = ConfigDict(extra="forbid")

    door: DoorKey
    source: Annotated[Named, StringConstraints(min_length=1)]
    skeleton: Named

    @property
    def name(self) -> PerformerName:
        """The performer's name."""
        return PerformerName(self.door, self.source, self.skeleton)


class PoseWish(PerformerWish):
    """An agreement with a performer about the pose in which they are now."""

    pose: AgreedPose


class PerformerView(BaseModel):
    """A skeleton that a source sends, or has sent.

    `state`: `gathering` while `missing` bones were not seen, `unusable` if its bones cannot be told
    apart (`problems`), else `ready`. `in_parent`: whether poses come in the parent's frame, null
    before that is known. `is_used`: of several senders of one name this one is used, and `others`
    are the addresses of the rest.
    """

    door: DoorKey
    source: str
    address: str
    skeleton: str
    bones: int
    rate_hz: float | None
    silent_s: float
    is_silent: bool
    state: PerformerState
    missing: list[str]
    problems: list[str]
    in_parent: bool | None
    is_t_pose_shown: bool
    is_used: bool
    others: list[str]


class RecordingView(BaseModel):
    """A recording that is not a capture yet; at most `limit_s` long."""

    id: str
    door: DoorKey
    source: str
    skeleton: str
    by: str
    since: datetime
    state: RecordingState
    duration_s: float
    frames: int
    limit_s: float


class PerformersView(BaseModel):
    """All performers, and the recordings that are going on or wait to be stored."""

    performers: list[PerformerView]
    recordings: list[RecordingView]


class RecordingStored(BaseModel):
    """A recording that is now a capture.

    `gaps` are times in which nothing came: the movement is interpolated there. `held_share` is the
    share of bones whose pose was lost or not sent.
    """

    capture_id: str
    frames: int = Field(ge=1)
    rate_hz: float
    duration_s: float
    gaps: list[Gap]
    held_share: float


class BodySetup(BaseModel):
    """What is needed to draw the body; sent first, and whenever any of it changes.

    Joint j is at `offsets_m[j]` in its parent's frame (-1: the world); `joint_map` is body joint ->
    joint. `stature_m` is null for the skeleton of a capture. `profile_m` are corners of the ground
    (distance from `ground_start_m`, height), empty where it is flat. `scale` is on the performer's
    travel. `unmapped` joints keep their T-pose.
    """

    type: Literal["setup"] = "setup"
    stature_m: float | None
    joint_map: dict[str, str]
    joints: tuple[str, ...]
    parents: tuple[int, ...]
    offsets_m: list[tuple[float, float, float]]
    ground_start_m: tuple[float, float] | None
    uphill: tuple[float, float] | None
    profile_m: list[tuple[float, float]]
    scale: float
    unmapped: list[str]


class BodyState(BaseModel):
    """Why the body moves or does not; sent when it changes.

    `refused`: there is no such body; the socket closes.
    """

    type: Literal["state"] = "state"
    state: WatchState
    address: str | None = None
    others: list[str] = []
    missing: list[str] = []
    problems: list[str] = []
