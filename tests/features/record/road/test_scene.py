"""Tests of a road's scene that a headset moves: late, paused, cut off, a partner that is gone."""

import hashlib
import json
import socket
import threading
import time
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import pi
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from pydantic import ValidationError

from app.clock import Clock
from app.errors import Withdrawn
from app.features.record.road import participant as participant_module
from app.features.record.road.participant import Participant
from app.features.record.road.recording import RunPlan, store_lines
from app.features.record.road.scene import STEPS_IN_CHUNK, RoadScene
from app.features.record.sessions import refusal
from app.models import RoadChunk, RoadCrossing, RoadRun
from app.platform.context import AppContext
from app.protocol import StudyRoad
from app.science.cosimulation import header_line
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
        yield SimpleNamespace(
            get=lambda _, __: self.run,
            get_one=lambda _, __: self.run,
            add=self.added.append,
            add_all=self.added.extend,
            flush=lambda: None,
            scalars=lambda _: [one.data for one in self.added if isinstance(one, RoadChunk)],
        )

    @property
    def record(self) -> bytes:
        """The bytes of the record as they were stored."""
        chunks = [one for one in self.added if isinstance(one, RoadChunk)]
        return b"".join(zlib.decompress(one.data) for one in chunks)

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


def _scene(
    road: StudyRoad,
    *,
    is_paced: bool = False,
    is_current: Callable[[], bool] = lambda: True,
    require: Callable[[object], None] = lambda _: None,
) -> tuple[RoadScene, Kept]:
    kept = Kept()
    background = SimpleNamespace(failed=lambda *_: None, recovered=lambda _: None)
    parts = SimpleNamespace(database=kept, background=background, clock=Clock())
    participant = Participant(
        STEP_S,
        round(WARM_UP_S / STEP_S),
        START,
        time_scale=1.0,
        is_paced=is_paced,
        is_current=is_current,
    )
    plan = RunPlan("r", "s", 1, 1, 5, 0.0, {"seed": 5})
    with kept.writing() as db:
        store_lines(db, "r", "s", 0, [header_line(plan.header, STEP_S)])
    return RoadScene(cast("AppContext", parts), plan, road, participant, require), kept


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
    port = _free_port()
    scene, kept = _scene(_road({"name": "bus", "kind": "process", "port": port}))
    told: list[str] = []
    scene.on_end = told.append
    _driven(scene, port, lambda n: [] if n < 80 else None)
    assert told == ["'bus' has closed its connection."]
    assert kept.run.ended == "partner lost"
    assert 70 < kept.run.steps <= 80
    assert kept.run.sha256 == hashlib.sha256(kept.record).hexdigest()


@pytest.mark.parametrize(
    ("field", "value", "reason"),
    [
        (
            "x_m",
            1e308,
            "'bus' said something that is not valid: x_m of 'bus' is 1e+308; it must be",
        ),
        ("speed_m_s", -2e3, "'bus' said something that is not valid: speed_m_s of 'bus' is -2000"),
        ("name", "participant", "'participant' and 'bus' both have an actor 'participant'."),
    ],
)
def test_a_partner_that_says_what_cannot_be_is_lost_and_what_it_said_before_is_measured(
    field: str, value: object, reason: str
) -> None:
    """Absurd numbers, or the name of somebody else's actor: the crossing before it is stored."""
    port = _free_port()
    scene, kept = _scene(_road({"name": "bus", "kind": "process", "port": port}))
    outline = {"length_m": 4.5, "width_m": 1.8}
    car = {"name": "bus", "kind": "car", "x_m": -90.0, "y_m": -1.2, "heading_rad": 0.0, **outline}
    _driven(
        scene, port, lambda n: [{**car, "speed_m_s": 0.0, **({field: value} if n > 320 else {})}]
    )
    assert reason in kept.run.reason
    assert (kept.run.ended, kept.run.steps) == ("partner lost", 320)
    assert [one.is_across for one in kept.crossings] == [True]
    assert kept.run.sha256 == hashlib.sha256(kept.record).hexdigest()


def test_a_scene_that_fails_is_ended_with_what_was_recorded(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An error that nobody foresaw leaves no run that goes on for ever."""
    scene, kept = _scene(_road())
    answer = scene.participant.answer

    def fails(timeout_s: float) -> object:
        if scene.state.steps == 320:
            raise RuntimeError("out of cheese")
        return answer(timeout_s)

    monkeypatch.setattr(scene.participant, "answer", fails)
    scene.participant.put(0, _path())
    scene.start()
    scene._thread.join(20.0)
    assert (kept.run.ended, kept.run.steps) == ("interrupted", 320)
    assert kept.run.reason == scene.problem == "The scene has failed: out of cheese"
    assert [one.is_across for one in kept.crossings] == [True]
    assert kept.run.sha256 == hashlib.sha256(kept.record).hexdigest()


@pytest.mark.parametrize("why", ["ended", "not current"])
def test_a_scene_that_ends_waits_no_longer_for_a_partner_that_is_not_there(
    why: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Somebody ends it, or its phase was ended: its port is free for the next scene."""
    monkeypatch.setattr(participant_module, "LOOK_S", 0.01)
    port, over = _free_port(), threading.Event()
    absent = {"name": "bus", "kind": "process", "port": port, "connect_s": 600.0}
    scene, kept = _scene(_road(absent), is_current=lambda: not over.is_set())
    scene.start()
    until = time.monotonic() + 20.0
    while not _is_taken(port) and time.monotonic() < until:
        time.sleep(0.01)
    other, second = _scene(_road(absent))
    other.start()
    other._thread.join(20.0)
    assert second.run.reason.startswith(f"'bus' cannot be waited for at 127.0.0.1:{port}: Address")
    assert "give this partner another port" in second.run.reason
    if why == "ended":
        scene.end(wait=False)
    over.set()
    scene._thread.join(20.0)
    assert scene.is_over
    assert (kept.run.ended, kept.run.steps) == ("complete", 0)
    assert not _is_taken(port)


def test_a_phase_that_has_ended_takes_no_more_places(monkeypatch: pytest.MonkeyPatch) -> None:
    """A scene with much to do asks, too: whoever goes on sending cannot keep it going."""
    monkeypatch.setattr(participant_module, "LOOK_S", 0.01)
    over = threading.Event()
    scene, kept = _scene(_road(), is_current=lambda: not over.is_set())
    scene.start()
    until = time.monotonic() + 20.0
    while not scene.is_over and time.monotonic() < until:
        said, steps = scene.participant.next_step, scene.state.steps
        if said < steps + 200:
            scene.participant.put(said, _path(50))
        if steps > 200:
            over.set()
    assert scene.is_over
    assert kept.run.ended == "complete"


def test_nothing_is_stored_once_somebody_has_withdrawn() -> None:
    """What waits is discarded, however much it is; the run ends, with the reason for the socket."""
    asked: list[object] = []

    def require(db: object) -> None:
        asked.append(db)
        if len(asked) > 2:
            raise refusal()

    scene, kept = _scene(_road(), require=require)
    scene.participant.put(0, _path(3000))
    scene.start()
    scene._thread.join(20.0)
    assert scene.is_over
    assert kept.chunks == 1 + 2
    assert (kept.run.ended, kept.run.steps) == ("interrupted", 2 * STEPS_IN_CHUNK - 1)
    assert isinstance(scene.refusal, Withdrawn)
    assert kept.run.sha256 == hashlib.sha256(kept.record).hexdigest()


def test_two_partners_of_a_study_cannot_be_waited_for_on_one_port() -> None:
    """The study is refused when it is checked, not when somebody stands on the road."""
    bus = {"name": "bus", "kind": "process", "port": 18000}
    with pytest.raises(ValidationError, match="'bus' and 'tram' are waited for on the same port"):
        _road(bus, {**bus, "name": "tram"})
    assert len(_road(bus, {**bus, "name": "tram", "port": 18001}).partners) == 2


def _driven(scene: RoadScene, port: int, said: Callable[[int], list[Any] | None]) -> None:
    """Run a scene with a bus that says these actors at each step, until it has nothing to say."""

    def drive() -> None:
        with _connected(port) as own:
            lines = own.makefile("rw")
            lines.write('{"type": "hello", "protocol": 1, "partner": "bus"}\n')
            lines.flush()
            for n, line in enumerate(lines):
                actors = said(n)
                if actors is None or "end" in json.loads(line)["type"]:
                    return
                state = {"type": "state", "time_s": round(n * STEP_S, 6), "actors": actors}
                lines.write(json.dumps(state) + "\n")
                lines.flush()

    bus = threading.Thread(target=drive)
    scene.start()
    bus.start()
    scene.participant.run_clock(is_running=True)
    scene.participant.put(0, _path())
    bus.join(20.0)
    scene._thread.join(20.0)
    assert scene.is_over


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as probe:
        return int(probe.getsockname()[1])


def _is_taken(port: int) -> bool:
    try:
        with socket.create_server(("127.0.0.1", port)):
            return False
    except OSError:
        return True


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
