"""The messages between a scene and a process that takes part in it (docs/crossing.md).

One JSON object a line, UTF-8, over TCP on this machine. Unknown fields are refused, because a
process with a misspelt field should not appear to work.
"""

from dataclasses import asdict
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from app.science.cosimulation import ActorKind, CosimulationError, Road, State

PROTOCOL: Literal[1] = 1
LONGEST_LINE, MOST_ACTORS = 1_000_000, 1000

FURTHEST = {
    "x_m": 1e6,
    "y_m": 1e6,
    "heading_rad": 1e6,
    "speed_m_s": 1e3,
    "turn_rad_s": 1e3,
}
"""The largest numbers, of either sign, that a process may say: with larger ones it has failed."""
_Finite = Annotated[float, Field(allow_inf_nan=False)]
_Size = Annotated[float, Field(gt=0.0, le=100.0)]
_Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9._-]{1,80}$")]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class Hello(_Strict):
    """The process's first line.

    `token` is what a process that the scene has started finds in REEMBODY_PARTNER_TOKEN.
    """

    type: Literal["hello"] = "hello"
    protocol: Literal[1] = PROTOCOL
    partner: _Name
    token: str = ""


class RoadMessage(_Strict):
    """The road's sizes; see `Road`."""

    half_length_m: float
    lane_width_m: float
    pavement_width_m: float
    speed_limit_m_s: float
    crossing_width_m: float | None

    def road(self) -> Road:
        """Return the road."""
        return Road(**self.model_dump())


class Welcome(_Strict):
    """The scene's answer; the process then says its actors at 0 s."""

    type: Literal["welcome"] = "welcome"
    partner: _Name
    step_s: float
    seed: int
    road: RoadMessage


class ActorMessage(_Strict):
    """One actor: x along the road, y across it, angles counter-clockwise; see `State`."""

    name: _Name
    kind: ActorKind
    x_m: _Finite
    y_m: _Finite
    heading_rad: _Finite
    speed_m_s: _Finite
    turn_rad_s: _Finite = 0.0
    length_m: _Size
    width_m: _Size


class Step(_Strict):
    """Asks the process for one step; `others` are where they are at `from_s`."""

    type: Literal["step"] = "step"
    from_s: float
    to_s: float
    others: tuple[ActorMessage, ...]


class StateMessage(_Strict):
    """The process's actors at `time_s`: at 0 s after the welcome, then at each step's `to_s`."""

    type: Literal["state"] = "state"
    time_s: _Finite
    actors: Annotated[tuple[ActorMessage, ...], Field(max_length=MOST_ACTORS)]

    def states(self) -> tuple[State, ...]:
        """Return the actors; raise CosimulationError for one that is not valid."""
        for actor in self.actors:
            for field, furthest in FURTHEST.items():
                if abs(value := getattr(actor, field)) > furthest:
                    raise CosimulationError(
                        f"{field} of {actor.name!r} is {value:g}; it must be from {-furthest:g} to"
                        f" {furthest:g}."
                    )
        return tuple(State(time_s=self.time_s, **actor.model_dump()) for actor in self.actors)


class End(_Strict):
    """The scene has ended; the process may close the connection."""

    type: Literal["end"] = "end"


ToProcess = Annotated[Welcome | Step | End, Field(discriminator="type")]
TO_PROCESS: TypeAdapter[Welcome | Step | End] = TypeAdapter(ToProcess)


def actor_message(state: State) -> ActorMessage:
    """Return a state as it is sent."""
    values = asdict(state)
    del values["time_s"]
    return ActorMessage(**values)


def road_message(road: Road) -> RoadMessage:
    """Return a road as it is sent."""
    return RoadMessage(**asdict(road))


def line_of(message: BaseModel) -> bytes:
    """Return a message as one line."""
    return message.model_dump_json().encode() + b"\n"
