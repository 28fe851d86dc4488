"""Scenes at a road that persons cross: those of files of their own, and that of a study.

Both have the same road, clock and partners. A study comes from whoever may edit studies, so it
names no commands and no files: its partners are walkers, cars, SUMO, or a process that somebody has
started on the server's machine. Metres, seconds, see docs/crossing.md.
"""

from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from app.protocol.common import refusal
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


class WalkerOfStudy(_PartnerFile):
    """A walker of the walking model, with given steering parameters."""

    kind: Literal["walker"]
    path: Annotated[tuple[_Point, ...], Field(min_length=2, max_length=100)]
    velocity_m_s: Annotated[float, Field(ge=0.1, le=2.0)] = 1.35
    acceleration_m_s2: Annotated[float, Field(ge=0.1, le=2.0)] = 1.0
    angular_per_m: Annotated[float, Field(ge=0.1, le=2.0)] = 1.5
    leaves_s: _NotNegative = 0.0
    waits_m: Annotated[float, Field(ge=0.1, le=2.0)] = 0.4
    looks_s: _NotNegative = 1.0
    accepts_s: _NotNegative = 4.0


class WalkerFile(WalkerOfStudy):
    """A walker whose steering parameters may be drawn from a fitted model."""

    model: str | None = Field(
        default=None, description="A file of `reembody walk fit`, from which the three are drawn."
    )
    stature_m: Annotated[float, Field(ge=0.5, le=2.6)] | None = None


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


class ProcessOfStudy(_PartnerFile):
    """A process that speaks JSON lines; somebody has started it on the server's machine."""

    kind: Literal["process"]
    port: Annotated[int, Field(ge=1024, le=65535)]
    connect_s: _Positive = 30.0


class ProcessFile(_PartnerFile):
    """Any process that speaks JSON lines, which the scene may start itself."""

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


OfStudy = Annotated[
    WalkerOfStudy | CarsFile | SumoFile | ProcessOfStudy, Field(discriminator="kind")
]
PARTICIPANT = "participant"
"""The partner and the actor of a study's scene that the headset moves."""


class StudyRoad(_Strict):
    """The road of a study, and what takes part in it beside the participant.

    The participant's start square lies on the pavement, `starts_behind_kerb_m` from the near kerb,
    and -z of the room leads straight across, over the middle of the crossing if there is one.
    `kerb_height_m`: how far the carriageway lies below the pavement. `warm_up_s`: how long traffic
    runs before the phase's clock starts, so that there are cars at once; partners' times count from
    its beginning. `seed`: with the number of the block and of the attempt it decides the traffic,
    so that everybody meets the same cars. `participant_late`: what is done when the headset's word
    of where the participant is does not arrive in time.
    """

    step_s: _Step = 0.02
    road: RoadFile = RoadFile(lane_width_m=2.5)
    kerb_height_m: Annotated[float, Field(ge=0.0, le=0.3)] = 0.12
    warm_up_s: Annotated[float, Field(ge=0.0, le=120.0)] = 15.0
    seed: Annotated[int, Field(ge=0, le=2**31 - 1)] = 1
    starts_behind_kerb_m: Annotated[float, Field(ge=0.4, le=5.0)] = 0.8
    participant_late: LateFile = LateFile()
    partners: Annotated[tuple[OfStudy, ...], Field(min_length=1, max_length=20)]

    def programs(self) -> tuple[str, ...]:
        """Return what somebody has to start, each with the address to which it connects."""
        return tuple(
            f"{one.name}: 127.0.0.1:{one.port}" for one in self.partners if one.kind == "process"
        )

    @model_validator(mode="after")
    def _names_differ(self) -> Self:
        names = [PARTICIPANT, *(one.name for one in self.partners)]
        for at, name in enumerate(names):
            if name in names[:at]:
                raise refusal(
                    f"Two partners of the road are called {name!r}.",
                    value=name,
                    valid=f"every name once, and none {PARTICIPANT!r}",
                    remedy="Give this partner another name.",
                    at=("partners", at - 1, "name"),
                )
        return self

    @model_validator(mode="after")
    def _ports_differ(self) -> Self:
        taken: dict[int, str] = {}
        for at, one in enumerate(self.partners):
            if one.kind != "process":
                continue
            if one.port in taken:
                raise refusal(
                    f"{taken[one.port]!r} and {one.name!r} are waited for on the same port.",
                    value=one.port,
                    valid="every port once",
                    remedy="Give one of these partners another port.",
                    at=("partners", at, "port"),
                )
            taken[one.port] = one.name
        return self

    @model_validator(mode="after")
    def _steps_fit(self) -> Self:
        for at, one in enumerate(self.partners):
            stride = (one.step_s or self.step_s) / self.step_s
            if stride < 1.0 - 1e-6 or abs(stride - round(stride)) > 1e-6:
                raise refusal(
                    f"The step of {one.name!r} is not a multiple of the road's.",
                    value=one.step_s,
                    valid=f"a multiple of {self.step_s:g} s",
                    remedy="Change one of the two steps.",
                    at=("partners", at, "step_s"),
                )
        return self
