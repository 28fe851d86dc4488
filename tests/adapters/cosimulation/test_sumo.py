"""Tests of traffic by SUMO: it stops for persons, and is SUMO's own where nobody interferes.

They need the extra (`reembody crossing install traffic`) and are skipped without it.
"""

import subprocess
import time
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from app.adapters.cosimulation import SumoPartner
from app.adapters.cosimulation.sumo_net import write_files
from app.adapters.cosimulation.sumo_partner import sumo_command, sumo_folder
from app.science.cosimulation import (
    Cars,
    Clocks,
    Conductor,
    Departure,
    Driver,
    Lateness,
    Partner,
    Record,
    RecordedPath,
    Road,
    crossings,
)

pytest.importorskip("traci", reason="SUMO is an extra: reembody crossing install traffic")
STEP_S, SEED, ROAD = 0.05, 7, Road()
TRAFFIC = (
    Departure("a", "near", 0.0, 12.0),
    Departure("b", "far", 1.0, 12.0),
    Departure("c", "near", 3.0, 12.0),
)


def _path(x_m: float, *places: tuple[float, float]) -> RecordedPath:
    times = np.array([time_s for time_s, _ in places])
    return RecordedPath("p", STEP_S, times, np.array([[x_m, y_m] for _, y_m in places]))


def _run(person: Partner, seconds: float, *more: Partner) -> Record:
    sumo = SumoPartner("traffic", STEP_S, ROAD, TRAFFIC, SEED)
    together = [(one, Lateness()) for one in (person, sumo, *more)]
    try:
        conductor = Conductor(together, STEP_S, Clocks(time.perf_counter))
        record, _ = conductor.run(round(seconds / STEP_S), {})
    finally:
        sumo.close()
    assert not record.lost
    return record


@pytest.mark.parametrize("x_m", [0.0, -30.0])
def test_sumo_s_cars_stop_for_a_person_on_the_crossing_and_off_it(x_m: float) -> None:
    """A person who stays in the lane stops the cars of that lane, with the same bytes twice."""
    record = _run(_path(x_m, (3.0, -4.2), (5.5, -1.6)), 20.0)
    ends = {row.state.name: row.state for row in record.steps[-1]}
    free_m = x_m - 0.25 - (ends["a"].x_m + 2.25)
    assert ends["a"].speed_m_s < 0.05
    assert 1.0 < free_m < 4.0
    assert ends["c"].speed_m_s < 0.05
    assert ends["c"].x_m < ends["a"].x_m - 4.5
    assert crossings(record, ROAD)[0].collision is None
    if x_m == 0.0:
        again = _run(_path(x_m, (3.0, -4.2), (5.5, -1.6)), 20.0)
        assert again.content == record.content


def test_where_nobody_interferes_it_is_sumo_alone(tmp_path: Path) -> None:
    """With a person on the pavement every place and speed equals that of SUMO without us."""
    record = _run(_path(0.0, (0.0, -5.0), (10.0, -5.2)), 15.0)
    net, routes = write_files(tmp_path, ROAD, TRAFFIC, sumo_folder() / "netconvert")
    output = tmp_path / "alone.xml"
    alone = [*sumo_command(sumo_folder(), net, routes, STEP_S, SEED), "--end", "15"]
    options = ["--fcd-output", str(output), "--precision", "12"]
    subprocess.run([*alone, *options], check=True, stdout=subprocess.DEVNULL)
    theirs_by_step = ET.fromstring(output.read_text()).iter("timestep")  # noqa: S314 - SUMO's own
    compared = 0
    for step, rows in zip(theirs_by_step, record.steps[1:], strict=True):
        ours = {row.state.name: row.state for row in rows if row.state.kind == "car"}
        theirs = {one.get("id", ""): one for one in step.iter("vehicle")}
        assert ours.keys() == theirs.keys()
        for name, car in ours.items():
            facing = 1.0 if car.y_m < 0.0 else -1.0
            assert car.x_m + 2.25 * facing == pytest.approx(
                float(theirs[name].get("x", "")), abs=1e-9
            )
            assert car.speed_m_s == pytest.approx(float(theirs[name].get("speed", "")), abs=1e-9)
            compared += 1
    assert compared > 500


def test_sumo_s_cars_follow_a_car_of_another_partner() -> None:
    """A slow car of ours in the near lane holds up SUMO's behind it, and is not counted as its."""
    slow = Cars("ours", STEP_S, ROAD, [Departure("slow", "near", 0.0, 3.0)], Driver(speed_m_s=3.0))
    sumo_later = (Departure("late", "near", 6.0, 12.0),)
    sumo = SumoPartner("traffic", STEP_S, ROAD, sumo_later, SEED)
    try:
        conductor = Conductor(
            [(slow, Lateness()), (sumo, Lateness())], STEP_S, Clocks(time.perf_counter)
        )
        record, _ = conductor.run(round(25.0 / STEP_S), {})
    finally:
        sumo.close()
    assert not record.lost
    ends = {row.state.name: (row.partner, row.state) for row in record.steps[-1]}
    assert {name: partner for name, (partner, _) in ends.items()} == {
        "slow": "ours", "late": "traffic"}  # fmt: skip
    assert ends["late"][1].speed_m_s == pytest.approx(3.0, abs=0.5)
    assert 0.5 < ends["slow"][1].x_m - ends["late"][1].x_m - 4.5 < 8.0
