"""Co-simulation: one scene, one clock, several partners with fixed steps.

`Conductor` runs partners step by step and returns a `Record`; `crossings` measures how persons
crossed the road in it. Partners here compute in this process: `RecordedPath`, `Walker`, `Cars`.
Others, such as traffic by SUMO or any process that speaks JSON, are in `app.adapters.cosimulation`.
"""

from app.science.cosimulation.cars import Cars, DrivenCar, Driver, Dynamics, PointMass
from app.science.cosimulation.conducting import Clocks, Conductor, Noted, Timing
from app.science.cosimulation.measures import Collision, Crossing, crossings, crossings_of
from app.science.cosimulation.partners import (
    InProcess,
    Lateness,
    Partner,
    PartnerLostError,
    Request,
    Rule,
    SceneOverError,
)
from app.science.cosimulation.persons import RecordedPath, Walker, WalkerPlan
from app.science.cosimulation.record import (
    Guess,
    Record,
    Row,
    header_line,
    step_line,
    steps_of,
    time_of,
)
from app.science.cosimulation.road import (
    Departure,
    Flow,
    Lane,
    Road,
    arrival_s,
    departures,
    heading_of,
)
from app.science.cosimulation.states import ActorKind, CosimulationError, State

__all__ = [
    "ActorKind",
    "Cars",
    "Clocks",
    "Collision",
    "Conductor",
    "CosimulationError",
    "Crossing",
    "Departure",
    "DrivenCar",
    "Driver",
    "Dynamics",
    "Flow",
    "Guess",
    "InProcess",
    "Lane",
    "Lateness",
    "Noted",
    "Partner",
    "PartnerLostError",
    "PointMass",
    "Record",
    "RecordedPath",
    "Request",
    "Road",
    "Row",
    "Rule",
    "SceneOverError",
    "State",
    "Timing",
    "Walker",
    "WalkerPlan",
    "arrival_s",
    "crossings",
    "crossings_of",
    "departures",
    "header_line",
    "heading_of",
    "step_line",
    "steps_of",
    "time_of",
]
