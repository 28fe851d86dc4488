"""Tests of the road's socket on a real server: pages loaded again, refused hellos, a withdrawal."""

import json
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from math import pi
from typing import Any

import pytest
import yaml
from sqlalchemy import func, select
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from app.features.record.companion import ENCODING as OF_COMPANIONS
from app.features.record.lab_trackers.samples import ENCODING as OF_TRACKERS
from app.models import RoadChunk, RoadCrossing, TrackerChunk
from app.resources import study_configs_dir
from tests.features.lab import Json, ok
from tests.features.record.headset.conftest import running_site
from tests.features.record.headset.site import SUBPROTOCOL, Site
from tests.support.datagrams import free_udp_port

START = [0.0, -3.3, pi / 2.0, 0.0]
CARS: Json = {
    "name": "cars",
    "kind": "cars",
    "flows": [{"lane": "near", "headway_s": 6, "count": 9, "speed_m_s": 11}],
}
WITH_CARS, WITH_PROGRAM = "road-cars", "road-program"
PAGES = 8
"""More than a server of two cores has threads for everybody's short work."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    """A server with a road of cars, and one that waits for a program which never comes."""
    program = {"name": "bus", "kind": "process", "port": free_udp_port(), "connect_s": 600}
    with running_site("sqlite", tmp_path_factory.mktemp("road"), {}) as site:
        for key, partner in ((WITH_CARS, CARS), (WITH_PROGRAM, program)):
            ok(site.operator.post("/api/studies", json={"yaml": _study(key, partner)}))
        yield site


def _study(key: str, partner: Json) -> str:
    path = study_configs_dir() / "templates" / "road-crossing.yaml"
    tree: Json = yaml.safe_load(path.read_text(encoding="utf-8"))
    road = {**tree["road"], "warm_up_s": 1, "partners": [partner]}
    return yaml.safe_dump({**tree, "key": key, "road": road}, allow_unicode=True)


@dataclass(frozen=True)
class Crossing:
    """A session whose participant stands at the road; `token` is their headset's."""

    site: Site
    session_id: str
    token: str
    phase_id: int

    @contextmanager
    def page(self, phase_id: int | None = None, run: str | None = None) -> Iterator["Page"]:
        """Load a page of the headset that says hello."""
        url = self.site.server.url.replace("http", "ws") + "/api/vr/road"
        offered: Any = [SUBPROTOCOL, f"bearer.{self.token}"]
        with connect(url, subprotocols=offered, compression=None) as socket:
            page = Page(socket)
            own = self.phase_id if phase_id is None else phase_id
            page.say(type="hello", phase_id=own, active_s=0.0, place=START, run=run)
            yield page


@dataclass(frozen=True)
class Page:
    """A page that is on the road."""

    socket: ClientConnection

    def say(self, **message: Any) -> None:
        """Send a message."""
        self.socket.send(json.dumps(message))

    def stand(self, first_step: int, steps: int) -> None:
        """Say that the participant stands where they stood."""
        self.say(type="places", first_step=first_step, places=[START] * steps)

    def hear(self, kind: str, step: int = 0) -> Json:
        """Return the next message of a kind, of a step at least."""
        while True:
            message: Json = json.loads(self.socket.recv(timeout=120))
            if message["type"] == kind and message.get("step", step) >= step:
                return message

    def refusal(self) -> str:
        """Return the code with which the server closes the socket."""
        code = str(self.hear("error")["code"])
        with pytest.raises(ConnectionClosed):
            self.socket.recv(timeout=120)
        return code


@contextmanager
def _crossing(site: Site, study: str) -> Iterator[Crossing]:
    session_id = str(ok(site.operator.post(f"/api/studies/{study}/sessions", json={}))["id"])
    site.skip_to(session_id, "materialise")
    token = site.token(session_id)
    with site.headset(token, avatars=["physics", "delayed_copy"]) as headset:
        headset.reported(kind="materialised", t_s=1.0)
        while True:
            view = site.view(session_id)
            if view["steps"][view["current"]["index"]]["kind"] == "road_crossing":
                break
            site.command(session_id, "skip", reason="not in this test")
        site.command(session_id, "begin_phase")
        state = headset.hear("state", lambda state: state["phase"] is not None)
        yield Crossing(site, session_id, token, int(state["phase"]["phase_id"]))


def test_a_page_that_is_loaded_again_and_again_shuts_nobody_out(site: Site) -> None:
    """While its road waits for a program, another headset comes onto its road, and older pages go.

    Once the session is aborted, the next one of the study waits for the program in its turn.
    """
    with (
        _crossing(site, WITH_PROGRAM) as waiting,
        _crossing(site, WITH_CARS) as other,
        ExitStack() as pages,
    ):
        opened = [pages.enter_context(waiting.page()) for _ in range(PAGES)]
        with other.page() as page:
            page.hear("welcome")
        opened[-1].hear("welcome")
        assert [one.refusal() for one in opened[:-1]] == ["taken_over"] * (PAGES - 1)
        site.command(waiting.session_id, "abort", reason="nobody starts the program")
        assert opened[-1].hear("ended")["problem"] == ""
    with _crossing(site, WITH_PROGRAM) as following, following.page() as page:
        page.hear("welcome")
        now = ok(site.operator.get(f"/api/sessions/{following.session_id}/road"))["now"]
        assert (now["problem"], len(now["waits_for"])) == ("", 1)


def test_a_hello_that_is_refused_changes_nothing_and_a_newer_page_takes_over(site: Site) -> None:
    """A page of another phase is refused, and the road goes on; one of this phase takes over."""
    with _crossing(site, WITH_CARS) as crossing, crossing.page() as first:
        run = first.hear("welcome")["run"]
        with crossing.page(phase_id=crossing.phase_id + 7) as stale:
            assert stale.refusal() == "conflict"
        first.stand(0, 100)
        first.hear("actors", step=98)
        with crossing.page(run=run) as second:
            assert second.hear("welcome")["run"] == run
            assert first.refusal() == "taken_over"
            second.stand(100, 100)
            second.hear("actors", step=198)
        road = ok(site.operator.get(f"/api/sessions/{crossing.session_id}/road"))
        assert [one["ended"] for one in road["runs"]] == ["running"]


def test_whoever_withdraws_on_the_road_leaves_nothing_more_on_the_disk(site: Site) -> None:
    """The socket closes with the reason, and what came after the withdrawal is not stored.

    An erasure removes the rest, with what trackers and a companion left.
    """
    with _crossing(site, WITH_CARS) as crossing, crossing.page() as page:
        page.hear("welcome")
        page.stand(0, 500)
        page.hear("actors", step=400)
        site.command(crossing.session_id, "withdraw", reason="wants to go")
        count = select(func.count()).where(RoadChunk.session_id == crossing.session_id)
        with site.database.reading() as db:
            before = db.scalar(count)
        page.stand(500, 500)
        page.stand(1000, 500)
        assert page.refusal() == "withdrawn"
        with site.database.reading() as db:
            assert db.scalar(count) == before
        road = ok(site.operator.get(f"/api/sessions/{crossing.session_id}/road"))
        assert [one["ended"] for one in road["runs"]] == ["interrupted"]
    _erase(site, crossing.session_id)
    road = ok(site.operator.get(f"/api/sessions/{crossing.session_id}/road"))
    assert road["runs"] == []
    with site.database.reading() as db:
        for table in (RoadChunk, RoadCrossing, TrackerChunk):
            rows = select(func.count()).where(table.session_id == crossing.session_id)
            assert db.scalar(rows) == 0


def _erase(site: Site, session_id: str) -> None:
    """Erase a participant, of whom there are also poses of trackers and of a companion."""
    none = {"source": "x", "address": "here", "first_s": 0.0, "last_s": 1.0, "sample_count": 1}
    with site.database.writing() as db:
        for number, encoding in enumerate((OF_TRACKERS, OF_COMPANIONS), start=1):
            own = {"session_id": session_id, "number": number, "encoding": encoding, "data": b""}
            at = datetime.now(UTC)
            db.add(TrackerChunk(**none, **own, door="json", first_at=at, trackers=["x"]))
    path = f"/api/studies/{WITH_CARS}/participants"
    people = ok(site.operator.get(path))
    (one,) = (one for one in people if session_id in [own["id"] for own in one["sessions"]])
    body = {"confirm": one["code"], "reason_code": "requested"}
    ok(site.operator.post(f"{path}/{one['id']}/erasure", json=body))
