"""Tests of a road's scene that a headset moves: late, paused, cut off, a partner that is gone."""

import json
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import pi
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from app.clock import Clock
from app.features.record.road.participant import Participant
from app.features.record.road.recording import RunPlan
from app.features.record.road.scene import RoadScene
from app.models import RoadChunk, RoadCrossing, RoadRun
from app.platform.context import AppContext
from app.protocol import StudyRoad
from app.wire import FloorPlace

STEP_S, WARM_UP_S, STEPS = 0.02, 1.0, 300
CARS = {
    "name": "cars",
    "kind": "cars",
    "flows": [{"lane": "near", "headway_s": 2, "count": 9, "speed_m_s": 12}],
}
START: FloorPlace = (0.0, -3.3, pi / 2.0, 0.0)


@dataclass
class Kept:
    """What a scene stores, instead of a database: the run's row, its chunks, the crossings."""

    run: RoadRun = field(
        default_factory=lambda: RoadRun(
            id="r", session_id="s", phase_id=1, begins_at_s=0.0, header={}, ended="running"
        )
    )
    added: list[Any] = field(default_factory=list)

    @contextmanager
    def writing(self) -> Iterator[Any]:
        """Give what a scene needs of a transaction."""
        yield SimpleNamespace(get=lambda _, __: self.run, add=self.added.append, flush=lambda: None)

    @property
    def crossings(self) -> list[RoadCrossing]:
        """The crossings that were stored."""
        return [one for one in self.added if isinstance(one, RoadCrossing)]

    @property
    def chunks(self) -> int:
        """How many pieces of the record were stored."""
        return sum(isinstance(one, RoadChunk) for one in self.added)


def _road(*partners: dict[str, Any], **fields: Any) -> StudyRoad:
    tree = {"partners": partners or (CARS,), "warm_up_s": WARM_UP_S, **fields}
    return StudyRoad.model_validate_json(json.dumps(tree))


def _scene(road: StudyRoad, *, is_paced: bool = False) -> tuple[RoadScene, Kept]:
    kept = Kept()
    background = SimpleNamespace(failed=lambda *_: None, recovered=lambda _: None)
    parts = SimpleNamespace(database=kept, background=background, clock=Clock())
    participant = Participant(
        STEP_S,
        round(WARM_UP_S / STEP_S),
        START,
        time_scale=1.0,
        is_paced=is_paced,
        is_current=lambda: True,
    )
    plan = RunPlan("r", "s", 1, 1, 5, 0.0, {"seed": 5})
    return RoadScene(cast("AppContext", parts), plan, road, participant), kept


def _path(steps: int = STEPS) -> list[FloorPlace]:
    """Return a walk over the road at 1.2 m/s."""
    return [(0.0, -3.3 + 1.2 * STEP_S * n, pi / 2.0, 1.2) for n in range(steps)]


def _ended(scene: RoadScene) -> None:
    scene.end(wait=True)
    assert scene.is_over


def test_a_headset_that_is_late_and_waited_for_changes_no_byte() -> None:
    """Places at once, or in pieces with pauses between them, give the same record and crossing."""
    hashes = set()
    for delays in (None, np.random.default_rng(3)):
        scene, kept = _scene(_road())
        scene.start()
        scene.participant.run_clock(is_running=True)
        path, said = _path(), 0
        while said < len(path):
            count = len(path) if delays is None else int(delays.integers(1, 90))
            scene.participant.put(said, path[said : said + count])
            said += count
            time.sleep(0.0 if delays is None else float(delays.uniform(0.0, 0.02)))
        _ended(scene)
        assert (kept.run.ended, kept.run.guesses) == ("complete", 0)
        assert kept.run.steps == round(WARM_UP_S / STEP_S) + STEPS - 1
        hashes.add(kept.run.sha256)
        (crossed,) = kept.crossings
        assert crossed.is_across
        # 0.8 m to the kerb at 1.2 m/s.
        assert crossed.steps_on_s == pytest.approx(0.8 / 1.2, abs=STEP_S)
        assert kept.chunks > 5
    assert len(hashes) == 1


def test_a_late_headset_is_extrapolated_and_each_guess_recorded_but_none_in_a_pause() -> None:
    """While the clock stands nothing is guessed; while it runs, at most `at_most_s` of it."""
    late = {"rule": "extrapolate", "patience_s": 0.01, "at_most_s": 0.1}
    scene, kept = _scene(_road(participant_late=late), is_paced=True)
    scene.start()
    participant, path = scene.participant, _path()
    participant.run_clock(is_running=True)
    participant.put(0, path[:10])
    participant.run_clock(is_running=False)
    until = time.monotonic() + 10.0
    while scene.state.steps < round(WARM_UP_S / STEP_S) + 9 and time.monotonic() < until:
        time.sleep(0.01)
    time.sleep(0.2)
    assert scene.state.guesses == 0
    participant.run_clock(is_running=True)
    participant.put(10, path[10:11])
    while scene.state.guesses < 5 and time.monotonic() < until:
        time.sleep(0.01)
    time.sleep(0.2)
    assert scene.state.guesses == 5
    participant.put(11, path[11:60])
    _ended(scene)
    assert kept.run.guesses == 5
    # At a constant speed the guesses were right.
    assert kept.run.worst_guess_m == pytest.approx(0.0, abs=1e-9)


def test_a_place_that_is_missing_is_refused_and_one_that_came_twice_is_ignored() -> None:
    """After a lost connection places may come again; a gap between them is an error."""
    scene, _ = _scene(_road())
    path = _path()
    scene.participant.put(0, path[:5])
    scene.participant.put(2, path[2:8])
    assert scene.participant.next_step == 8
    with pytest.raises(ValueError, match="step 8 is missing"):
        scene.participant.put(9, path[9:10])


def test_a_partner_that_is_killed_ends_the_scene_and_keeps_what_was_recorded() -> None:
    """The reason is told; the record until then has its hash."""
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = int(probe.getsockname()[1])
    scene, kept = _scene(_road({"name": "bus", "kind": "process", "port": port}))
    told: list[str] = []
    scene.on_end = told.append

    def drive() -> None:
        with _connected(port) as own:
            lines = own.makefile("rw")
            lines.write('{"type": "hello", "protocol": 1, "partner": "bus"}\n')
            lines.flush()
            lines.readline()
            for n in range(80):
                lines.write(
                    f'{{"type": "state", "time_s": {round(n * STEP_S, 6)}, "actors": []}}\n'
                )
                lines.flush()
                lines.readline()

    bus = threading.Thread(target=drive)
    scene.start()
    bus.start()
    scene.participant.run_clock(is_running=True)
    scene.participant.put(0, _path())
    bus.join(20.0)
    scene._thread.join(20.0)
    assert told == ["'bus' has closed its connection."]
    assert kept.run.ended == "partner lost"
    assert 70 < kept.run.steps <= 80
    assert kept.run.sha256 is not None


@contextmanager
def _connected(port: int) -> Iterator[socket.socket]:
    until = time.monotonic() + 20.0
    while True:
        try:
            own = socket.create_connection(("127.0.0.1", port), timeout=10.0)
            break
        except OSError:
            if time.monotonic() > until:
                raise
            time.sleep(0.02)
    with own:
        yield own
