"""The messages of the socket that brings the study's road to the headset, and the person onto it.

The floor is that of `app.science.cosimulation`: x along the road, y across it, angles
counter-clockwise from x; the near kerb is at y = -lane_width_m. The start square lies
`starts_behind_kerb_m` behind that kerb, so with the room's z

    x_m = x    y_m = -z - lane_width_m - starts_behind_kerb_m

Steps count from 0 at the active time with which a run begins. The client sends where the
participant was at each of them, in order and without a gap; the server sends where all others are
at the newest step that it has computed, and nothing that is older.
"""

from typing import Annotated, Literal

from pydantic import Field, TypeAdapter

from app.wire.messages import Count, Message, Seconds, YesOrNo

Coordinate = Annotated[float, Field(allow_inf_nan=False, ge=-1e4, le=1e4)]
Angle = Annotated[float, Field(allow_inf_nan=False, ge=-7.0, le=7.0)]
Speed = Annotated[float, Field(allow_inf_nan=False, ge=0.0, le=100.0)]
FloorPlace = tuple[Coordinate, Coordinate, Angle, Speed]
"""x and y in metres, heading in rad, speed along it in m/s."""
MAX_PLACES = 512


class RoadHello(Message):
    """The client's first message: which phase, its active time now, and where the person stands.

    `run`: the run to go on with after a lost connection, as the welcome has named it; null for a
    page that knows none, with which the traffic begins anew.
    """

    type: Literal["hello"] = "hello"
    phase_id: Count
    active_s: Seconds
    place: FloorPlace
    run: str | None = None


class RoadPlaces(Message):
    """The client's message: where the participant was at `first_step` and at those after it."""

    type: Literal["places"] = "places"
    first_step: Count
    places: tuple[FloorPlace, ...] = Field(min_length=1, max_length=MAX_PLACES)


class RoadClock(Message):
    """The client's message: whether the phase's clock runs; while it stands, nobody is late."""

    type: Literal["clock"] = "clock"
    running: YesOrNo


class RoadEnd(Message):
    """The client's last message: the phase is over, and so is the scene."""

    type: Literal["end"] = "end"


RoadMessage = Annotated[RoadHello | RoadPlaces | RoadClock | RoadEnd, Field(discriminator="type")]
FROM_ROAD_CLIENT: TypeAdapter[RoadHello | RoadPlaces | RoadClock | RoadEnd] = TypeAdapter(
    RoadMessage
)


class RoadWelcome(Message):
    """The server's answer: the run, the active time at its step 0, and the next step it needs."""

    type: Literal["welcome"] = "welcome"
    run: str
    phase_id: int
    begins_at_s: float
    step_s: float
    next_step: int


class RoadActor(Message):
    """One car or walker: its outline on the floor, where its middle is, and how it moves."""

    name: str
    kind: Literal["person", "car"]
    length_m: float
    width_m: float
    x_m: float
    y_m: float
    heading_rad: float
    speed_m_s: float
    turn_rad_s: float


class RoadActors(Message):
    """The server's message: everybody but the participant at this active time of the phase."""

    type: Literal["actors"] = "actors"
    step: int
    active_s: float
    actors: tuple[RoadActor, ...]


class RoadEnded(Message):
    """The server's message: the scene has ended; `problem` says why if it broke off."""

    type: Literal["ended"] = "ended"
    problem: str = ""


RoadFromServer = Annotated[RoadWelcome | RoadActors | RoadEnded, Field(discriminator="type")]
FROM_ROAD_SERVER: TypeAdapter[RoadWelcome | RoadActors | RoadEnded] = TypeAdapter(RoadFromServer)
