"""The schema of crossing scenes; metres, seconds, see docs/crossing.md."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from app.science.cosimulation import Driver, Flow, Lane, Lateness, Road, Rule

_Finite = Annotated[float, Field(ge=-10_000.0, le=10_000.0, allow_inf_nan=False)]
_Positive = Annotated[float, Field(gt=0.0, le=10_000.0, allow_inf_nan=False)]
_NotNegative = Annotated[float, Field(ge=0.0, le=10_000.0, allow_inf_nan=False)]
_Step = Annotated[float, Field(ge=0.001, le=1.0, allow_inf_nan=False)]
_Name = Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9-]{0,39}$")]
_Point = tuple[_Finite, _Finite]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class RoadFile(_Strict):
    """The road; see `Road`."""

    half_length_m: Annotated[float, Field(ge=20.0, le=2000.0)] = 120.0
    lane_width_m: Annotated[float, Field(ge=2.0, le=10.0)] = 3.2
    pavement_width_m: Annotated[float, Field(ge=1.0, le=20.0)] = 2.0
    speed_limit_m_s: Annotated[float, Field(gt=0.0, le=60.0)] = 13.9
    crossing_width_m: Annotated[float, Field(ge=1.0, le=20.0)] | None = 4.0

    def road(self) -> Road:
        """Return the road."""
        return Road(**self.model_dump())


class LateFile(_Strict):
    """What is done when a partner's answer is late; see `Lateness`."""

    rule: Rule = "wait"
    patience_s: _NotNegative = 0.02
    at_most_s: _NotNegative = 0.5
    give_up_s: _Positive = 10.0

    def lateness(self) -> Lateness:
        """Return the rule with its times."""
        return Lateness(**self.model_dump())


class FlowFile(_Strict):
    """Cars of one lane; see `Flow`."""

    lane: Lane
    first_s: _NotNegative = 0.0
    headway_s: _Positive
    count: Annotated[int, Field(ge=1, le=500)]
    speed_m_s: Annotated[float, Field(gt=0.0, le=60.0)]
    spread: bool = False
    least_s: _NotNegative = 1.5

    def flow(self) -> Flow:
        """Return the flow."""
        return Flow(**self.model_dump())


class _PartnerFile(_Strict):
    name: _Name
    step_s: _Step | None = Field(default=None, description="The scene's if it is left out.")
    late: LateFile = LateFile()


class WalkerFile(_PartnerFile):
    """A walker of the walking model."""

    kind: Literal["walker"]
    path: Annotated[tuple[_Point, ...], Field(min_length=2, max_length=100)]
    velocity_m_s: Annotated[float, Field(ge=0.1, le=2.0)] = 1.35
    acceleration_m_s2: Annotated[float, Field(ge=0.1, le=2.0)] = 1.0
    angular_per_m: Annotated[float, Field(ge=0.1, le=2.0)] = 1.5
    model: str | None = Field(
        default=None, description="A file of `reembody walk fit`, from which the three are drawn."
    )
    stature_m: Annotated[float, Field(ge=0.5, le=2.6)] | None = None
    leaves_s: _NotNegative = 0.0
    waits_m: Annotated[float, Field(ge=0.1, le=2.0)] = 0.4
    looks_s: _NotNegative = 1.0
    accepts_s: _NotNegative = 4.0


class PathFile(_PartnerFile):
    """A person whose path was recorded: [time_s, x_m, y_m], here or in a table of tracks."""

    kind: Literal["path"]
    points: Annotated[
        tuple[tuple[_NotNegative, _Finite, _Finite], ...], Field(max_length=100_000)
    ] = ()
    file: str | None = Field(default=None, description="A CSV with time_s, x_m, y_m.")


class CarsFile(_PartnerFile):
    """Cars with our own driver."""

    kind: Literal["cars"]
    flows: Annotated[tuple[FlowFile, ...], Field(min_length=1, max_length=20)]
    speed_m_s: Annotated[float, Field(gt=0.0, le=60.0)] = 12.0

    def driver(self) -> Driver:
        """Return the driver of all these cars."""
        return Driver(speed_m_s=self.speed_m_s)


class SumoFile(_PartnerFile):
    """Traffic by SUMO."""

    kind: Literal["sumo"]
    flows: Annotated[tuple[FlowFile, ...], Field(min_length=1, max_length=20)]


class ProcessFile(_PartnerFile):
    """Any process that speaks JSON lines."""

    kind: Literal["process"]
    command: tuple[str, ...] = Field(
        default=(), description="{address}, {folder}, {python} and {reembody} are replaced."
    )
    port: Annotated[int, Field(ge=0, le=65535)] = 0
    connect_s: _Positive = 30.0


PartnerFile = WalkerFile | PathFile | CarsFile | SumoFile | ProcessFile


class CrossingFile(_Strict):
    """The content of a scene file."""

    key: Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9-]{0,63}$")]
    title: Annotated[str, Field(max_length=200)] = ""
    about: Annotated[str, Field(max_length=5000)] = ""
    step_s: _Step = 0.02
    duration_s: Annotated[float, Field(gt=0.0, le=3600.0)]
    road: RoadFile = RoadFile()
    partners: Annotated[
        tuple[Annotated[PartnerFile, Field(discriminator="kind")], ...],
        Field(min_length=1, max_length=20),
    ]
