"""The messages of the socket that brings a lab's trackers to the headset, newest only.

The headset sends where its own head is; the server answers with where trackers are in the same
world. Nothing on this socket is acknowledged or sent again: only the newest is of use.
"""

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, TypeAdapter, field_validator

from app.wire.messages import Goal, Message, Seconds

Coordinate = Annotated[float, Field(allow_inf_nan=False, ge=-1e4, le=1e4)]
Cosine = Annotated[float, Field(allow_inf_nan=False, ge=-1.1, le=1.1)]
Place = tuple[Coordinate, Coordinate, Coordinate, Cosine, Cosine, Cosine, Cosine]
"""A position x, y, z in metres and a rotation w, x, y, z."""
MAX_HEAD_POSES = 256


class HeadPose(Message):
    """The eyes in the headset's own world at its monotonic time; `tracked`: not guessed."""

    t_s: Seconds
    place: Place
    tracked: bool


class HeadPoses(Message):
    """The client's message: the eyes in the frames since the last message, at rising times."""

    type: Literal["head"] = "head"
    poses: tuple[HeadPose, ...] = Field(min_length=1, max_length=MAX_HEAD_POSES)

    @field_validator("poses")
    @classmethod
    def _rising(cls, value: tuple[HeadPose, ...]) -> tuple[HeadPose, ...]:
        if any(b.t_s <= a.t_s for a, b in pairwise(value)):
            raise ValueError("t_s must rise from pose to pose")
        return value


class TrackersState(Message):
    """The server's message on every change: whether trackers are used, and are aligned.

    `wanted`: trackers were chosen for the session, so the client should send its head's poses.
    `aligned`: they are known in the headset's world; while false, no poses come.
    """

    type: Literal["trackers_state"] = "trackers_state"
    wanted: bool
    aligned: bool


class TrackerPlaces(Message):
    """The server's message: where each tracker is now, in the headset's own world.

    `t_s`: when the newest of them was there, by the headset's clock. `places`: by the goal on whose
    limb it is worn; a tracker that is lost is left out.
    """

    type: Literal["trackers"] = "trackers"
    t_s: float
    places: dict[Goal, Place]


HEAD_POSES: TypeAdapter[HeadPoses] = TypeAdapter(HeadPoses)
