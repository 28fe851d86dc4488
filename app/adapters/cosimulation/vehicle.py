"""The example of a partner in its own process: a car with a driver, as a point mass or an FMU.

The driver is ours and says an acceleration; a functional mock-up unit (FMI 2, co-simulation) says
what the car makes of it. Such a unit is native code, which is why it runs in this process, not in
the one that keeps the record.
"""

import os
import shutil
import socket
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from app.adapters.cosimulation.lines import Lines
from app.adapters.cosimulation.messages import (
    TO_PROCESS,
    End,
    Hello,
    StateMessage,
    Step,
    Welcome,
    actor_message,
    line_of,
)
from app.adapters.cosimulation.process_partner import TOKEN_VARIABLE
from app.science.cosimulation import (
    CosimulationError,
    Departure,
    DrivenCar,
    Driver,
    Dynamics,
    Lane,
    PointMass,
    State,
)

INPUT, DRIVEN, SPEED = "a_cmd", "x", "v"
"""Variables of the FMU: commanded acceleration, m/s^2; distance driven, m; speed, m/s."""


@dataclass(frozen=True)
class VehicleOrder:
    """What the vehicle is: its name, where it connects, how it drives; an FMU if there is one."""

    name: str
    host: str
    port: int
    lane: Lane
    speed_m_s: float
    fmu: Path | None = None


class FmuDynamics:
    """A car's movement along its lane, computed by an FMU 2 for co-simulation.

    Raises:
        CosimulationError: FMPy is not installed, or the file is no such unit.
    """

    def __init__(self, file: Path, speed_m_s: float) -> None:
        # Imported here because it is optional.
        try:
            import fmpy
            from fmpy.fmi2 import FMU2Slave
        except ImportError:
            raise CosimulationError(
                f"{file} needs the package FMPy, which is not installed: `reembody crossing install"
                " fmu`."
            ) from None
        try:
            description = fmpy.read_model_description(str(file))
        except Exception as error:  # noqa: BLE001 - FMPy raises what its parts raise
            raise CosimulationError(f"{file} cannot be read as an FMU: {error}.") from None
        numbers = {one.name: one.valueReference for one in description.modelVariables}
        if missing := [name for name in (INPUT, DRIVEN, SPEED) if name not in numbers]:
            raise CosimulationError(
                f"{file} has no variable {missing[0]!r}; {INPUT}, {DRIVEN} and {SPEED} are needed."
            )
        if description.coSimulation is None or not description.fmiVersion.startswith("2."):
            raise CosimulationError(f"{file} is no FMU for co-simulation of FMI 2.")
        self._numbers, self._time_s = numbers, 0.0
        self._folder = fmpy.extract(str(file))
        self._unit: Any = FMU2Slave(
            guid=description.guid,
            unzipDirectory=self._folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="vehicle",
        )
        self._unit.instantiate()
        self._unit.setupExperiment(startTime=0.0)
        self._unit.setReal([numbers[SPEED]], [speed_m_s])
        self._unit.enterInitializationMode()
        self._unit.exitInitializationMode()

    def step(self, acceleration_m_s2: float, dt_s: float) -> tuple[float, float]:
        """Advance the unit by a step."""
        self._unit.setReal([self._numbers[INPUT]], [acceleration_m_s2])
        self._unit.doStep(self._time_s, dt_s)
        self._time_s += dt_s
        driven_m, speed_m_s = self._unit.getReal([self._numbers[DRIVEN], self._numbers[SPEED]])
        return float(driven_m), float(speed_m_s)

    def close(self) -> None:
        """End the unit and remove its unpacked files."""
        self._unit.terminate()
        self._unit.freeInstance()
        shutil.rmtree(self._folder, ignore_errors=True)


def drive(order: VehicleOrder) -> None:
    """Take part in a scene until it ends.

    Raises:
        CosimulationError: the FMU cannot be used, or the scene said something that is not valid.
        OSError: there is no scene at the address, or it has gone.
    """
    fmu = None if order.fmu is None else FmuDynamics(order.fmu, order.speed_m_s)
    lines = Lines(socket.create_connection((order.host, order.port), timeout=10.0))
    try:
        token = os.environ.get(TOKEN_VARIABLE, "")
        lines.send(line_of(Hello(partner=order.name, token=token)))
        _take_part(lines, order, fmu or PointMass(order.speed_m_s))
    finally:
        lines.close()
        if fmu is not None:
            fmu.close()


def _take_part(lines: Lines, order: VehicleOrder, dynamics: Dynamics) -> None:
    car: DrivenCar | None = None
    while line := lines.receive(None):
        try:
            message = TO_PROCESS.validate_json(line)
        except ValidationError as error:
            raise CosimulationError(
                f"The scene said something that is not valid: {error}"
            ) from None
        if isinstance(message, End):
            return
        if isinstance(message, Welcome):
            entering = Departure(order.name, order.lane, 0.0, order.speed_m_s)
            driver = Driver(speed_m_s=order.speed_m_s)
            car = DrivenCar(entering, message.road.road(), driver, dynamics)
        elif car is None:
            raise CosimulationError("The scene asked for a step before its welcome.")
        else:
            car.advance(_others(message), message.from_s, message.to_s)
        lines.send(_said(car))


def _others(step: Step) -> list[State]:
    return [State(time_s=step.from_s, **one.model_dump()) for one in step.others]


def _said(car: DrivenCar) -> bytes:
    actors = () if car.has_left else (actor_message(car.state),)
    return line_of(StateMessage(time_s=car.state.time_s, actors=actors))
