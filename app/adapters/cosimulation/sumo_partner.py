"""Traffic by Eclipse SUMO, in its own process, steered by TraCI.

SUMO drives its cars; persons and cars of other partners are put where they are at each step
(`moveToXY`), and SUMO's cars see them. SUMO itself (EPL-2.0 or GPL-2.0-or-later) is an extra and
is never linked with our code; its client, `traci`, is imported where a scene has traffic of it.

In SUMO a car slows down before a crossing that has priority even if nobody is there, and gives way
to a person on it, but not to one of other partners who waits on the pavement.
"""

import socket
import subprocess
import tempfile
import time
from collections.abc import Sequence
from contextlib import suppress
from importlib.util import find_spec
from math import cos, degrees, radians, sin
from pathlib import Path
from typing import IO, Any

from app.adapters.cosimulation.sumo_net import (
    CAR_LENGTH_M,
    CAR_WIDTH_M,
    FOREIGN_TYPE,
    WAITING_EDGE,
    write_files,
)
from app.science.cosimulation import (
    CosimulationError,
    Departure,
    PartnerLostError,
    Request,
    Road,
    State,
)

_CONNECT_S = 20.0
_ANYWHERE = 2
"""`keepRoute` of moveToXY: put the actor exactly there, on or off a road."""


def sumo_folder() -> Path:
    """Return the folder of SUMO's programs; raise CosimulationError if it is not installed."""
    found = find_spec("sumo"), find_spec("traci")
    if None in found or found[0] is None or found[0].origin is None:
        raise CosimulationError(
            "Traffic by SUMO needs the packages eclipse-sumo and traci, which are not installed:"
            " `reembody crossing install traffic`."
        )
    return Path(found[0].origin).parent / "bin"


def sumo_command(folder: Path, net: Path, routes: Path, step_s: float, seed: int) -> list[str]:
    """Return SUMO's command line without a port, with which it runs alone."""
    return [
        *(str(folder / "sumo"), "--net-file", str(net), "--route-files", str(routes)),
        *("--step-length", f"{step_s:g}", "--seed", str(seed), "--collision.action", "warn"),
        *("--collision.check-junctions", "true", "--xml-validation", "never"),
        *("--xml-validation.net", "never", "--no-step-log", "true", "--no-warnings", "true"),
    ]


class SumoPartner:
    """One run of SUMO, from `start` until `close`."""

    def __init__(
        self, name: str, step_s: float, road: Road, plan: Sequence[Departure], seed: int
    ) -> None:
        self.name, self.step_s = name, step_s
        self._folder = sumo_folder()
        self._road, self._plan, self._seed = road, plan, seed
        self._files = tempfile.TemporaryDirectory(prefix="reembody-sumo-")
        self._process: subprocess.Popen[bytes] | None = None
        self._errors: IO[bytes] | None = None
        self._sumo: Any = None
        self._foreign: dict[str, str] = {}
        self._answer: tuple[State, ...] = ()

    def start(self) -> tuple[State, ...]:
        """Start SUMO; it has no cars before its first step."""
        files = Path(self._files.name)
        net, routes = write_files(files, self._road, self._plan, self._folder / "netconvert")
        command = sumo_command(self._folder, net, routes, self.step_s, self._seed)
        port = _free_port()
        self._errors = (files / "errors.txt").open("w+b")
        self._process = subprocess.Popen(  # noqa: S603 - SUMO's own program with our options
            [*command, "--remote-port", str(port)], stdout=subprocess.DEVNULL, stderr=self._errors
        )
        self._sumo = self._connected(port)
        return ()

    def begin(self, request: Request) -> None:
        """Put everybody else where they are, and let SUMO compute one step."""
        import traci

        try:
            self._put(request.others)
            self._sumo.simulationStep()
            self._answer = self._cars(request.to_s)
        except (traci.TraCIException, traci.FatalTraCIError, OSError) as error:
            raise PartnerLostError(
                f"{self.name!r}: SUMO stopped: {error}. {self._said()}"
            ) from None

    def answer(self, timeout_s: float) -> tuple[State, ...]:
        """Return the cars after the step."""
        del timeout_s
        return self._answer

    def close(self) -> None:
        """End SUMO and remove its files."""
        if self._sumo is not None:
            with suppress(Exception):  # it may have gone already, which is what we want
                self._sumo.close(wait=False)
        if self._process is not None:
            try:
                self._process.wait(2.0)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        if self._errors is not None:
            self._errors.close()
        self._files.cleanup()

    def _connected(self, port: int) -> Any:
        import traci

        until = time.monotonic() + _CONNECT_S
        assert self._process is not None  # noqa: S101 - `start` has just set it
        while time.monotonic() < until and self._process.poll() is None:
            try:
                return traci.connect(port, numRetries=0, host="127.0.0.1", proc=self._process)
            except (traci.FatalTraCIError, traci.TraCIException):
                time.sleep(0.02)
        raise PartnerLostError(f"{self.name!r}: SUMO did not start. {self._said()}")

    def _said(self) -> str:
        assert self._errors is not None  # noqa: S101 - `start` has set it
        self._errors.seek(0)
        return self._errors.read()[-1000:].decode(errors="replace").strip()

    def _put(self, others: Sequence[State]) -> None:
        """Put actors of other partners where they are; add new ones, remove those that left."""
        there = {state.name for state in others}
        for name in [name for name in self._foreign if name not in there]:
            domain = (
                self._sumo.person if self._foreign.pop(name) == "person" else self._sumo.vehicle
            )
            domain.remove(name)
        for state in others:
            new = state.name not in self._foreign
            self._foreign[state.name] = state.kind
            if state.kind == "person":
                self._put_person(state, new=new)
            else:
                self._put_car(state, new=new)

    def _put_person(self, state: State, *, new: bool) -> None:
        persons, angle = self._sumo.person, _degrees_from_north(state.heading_rad)
        if new:
            persons.add(state.name, WAITING_EDGE, pos=1.0)
            persons.appendWaitingStage(state.name, 1e6)
        persons.moveToXY(
            state.name, "", state.x_m, state.y_m, angle=angle, keepRoute=_ANYWHERE
        )  # fmt: skip

    def _put_car(self, state: State, *, new: bool) -> None:
        vehicles, angle = self._sumo.vehicle, _degrees_from_north(state.heading_rad)
        if new:
            lane = "near" if state.y_m < 0.0 else "far"
            vehicles.add(state.name, lane, typeID=FOREIGN_TYPE, departLane="1")
        half_m = state.length_m / 2.0  # SUMO's place of a car is the middle of its front
        x_m = state.x_m + half_m * cos(state.heading_rad)
        y_m = state.y_m + half_m * sin(state.heading_rad)
        vehicles.moveToXY(state.name, "", -1, x_m, y_m, angle=angle, keepRoute=_ANYWHERE)
        vehicles.setSpeed(state.name, state.speed_m_s)

    def _cars(self, time_s: float) -> tuple[State, ...]:
        vehicles, cars = self._sumo.vehicle, []
        for name in vehicles.getIDList():
            if name in self._foreign:
                continue
            (x_m, y_m), heading = vehicles.getPosition(name), _radians(vehicles.getAngle(name))
            half_m, speed = CAR_LENGTH_M / 2.0, vehicles.getSpeed(name)
            middle = x_m - half_m * cos(heading), y_m - half_m * sin(heading)
            size = (CAR_LENGTH_M, CAR_WIDTH_M)
            cars.append(State(name, "car", time_s, *middle, heading, speed, 0.0, *size))
        return tuple(sorted(cars, key=lambda car: car.name))


def _degrees_from_north(heading_rad: float) -> float:
    """Return a heading as SUMO has it: degrees clockwise from y."""
    return (90.0 - degrees(heading_rad)) % 360.0


def _radians(angle_deg: float) -> float:
    """Return SUMO's angle as a heading between -pi and pi, exact along the road."""
    turned = (90.0 - angle_deg) % 360.0
    return radians(turned if turned <= 180.0 else turned - 360.0)


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
