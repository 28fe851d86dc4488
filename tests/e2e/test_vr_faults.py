"""Browser test of what goes wrong while somebody takes part: device, page, network and server."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect
from sqlalchemy import select

from app.models import ClientReport
from app.simulated_people.body import make_person
from tests.e2e.killing import crash
from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.faults.relay import RelayThread, relayed_in_thread
from tests.features.record.headset.site import Site
from tests.protocol.helpers import SHIPPED, loaded
from tests.support.browser import ContextFactory, PageWatch
from tests.support.vr_rules import derived, stored
from tests.support.vr_visit import QUICK, Json, Visit, WornHeadset, journey_script, ok

STUDY = "headset-faults"
ACTIVE_S = 9.0
FRAME_S = 1.0 / 90.0
SLEEP_S = 3.0
OUTAGE_S, OUTAGE_FRAME_S = 60.0, 1.0 / 15.0
STATUS_MS = 600
"""The page hears what its journal holds at least this often, ms."""
BODY_STREAMS = ("target", "actual")


def short_study() -> str:
    """Return the shipped study with short phases, the first of which meets all faults."""
    text = SHIPPED.replace("key: reembodiment-latency", f"key: {STUDY}", 1)
    text = text.replace("duration_s: 120", "duration_s: 1")
    text = text.replace("duration_s: 60", f"duration_s: {ACTIVE_S:g}")
    return re.sub(r"(preparation_s|freeze_s): 5", r"\1: 0.3", text)


@dataclass
class Wearing:
    """A visit in the hand task, and what a test asks of it."""

    site: Site
    visit: Visit

    @property
    def page(self) -> WornHeadset:
        """The page that is worn now."""
        return self.visit.headset

    @property
    def active_s(self) -> float:
        """The active time of the phase as the page shows it."""
        return float(self.page.tell("reembody.run.activeS(journey.clock.nowMs / 1000)"))

    @property
    def now_s(self) -> float:
        """The time of the newest frame on the page's clock."""
        return float(self.page.tell("journey.clock.nowMs / 1000"))

    def seen(self) -> tuple[str, str | None]:
        """Return the state of the phase and why it is paused, as the cockpit shows them."""
        current = self.visit.view()["current"]
        return current["status"], current["pause_reason"]

    def until_seen(self, status: str, frames: int = 9, rounds: int = 200) -> str | None:
        """Draw until the cockpit shows this state; return why it is paused."""
        for _ in range(rounds):
            self.visit.draw(frames)
            found, reason = self.seen()
            if found == status:
                return reason
        raise AssertionError(f"the phase is {self.seen()}, not {status}")

    def resume(self) -> None:
        """Let the operator resume, and draw until the clock runs."""
        self.order_resume()
        self.until_running()

    def order_resume(self) -> None:
        """Let the operator resume; what follows is up to the headset."""
        while not self.visit.command(self.visit.view(), "resume"):
            pass

    def until_running(self) -> None:
        """Draw until the clock runs, as the cockpit and the page show it."""
        self.until_seen("running")
        assert self.page.tell("reembody.run.clockRuns")

    def phase_reports(self) -> list[Json]:
        """Return the reports of the phase's clock that the server accepted, in their order."""
        chosen = (
            select(ClientReport.payload)
            .where(ClientReport.session_id == self.visit.session_id, ClientReport.type == "phase")
            .order_by(ClientReport.epoch, ClientReport.seq)
        )
        with self.site.database.reading() as db:
            return list(db.scalars(chosen))

    def newest_pause(self) -> Json:
        """Return the report that stopped the clock last; a repeated one changes nothing."""
        reports = self.phase_reports()
        began = max(at for at, one in enumerate(reports) if one["what"] in ("started", "resumed"))
        return next(one for one in reports[began:] if one["what"] == "paused")

    def paused_at(self, cause: str, last_frame_s: float) -> None:
        """Require that the clock was stopped for this cause, at this frame and for good."""
        assert self.until_seen("paused") == cause
        report = self.newest_pause()
        assert (report["what"], report["cause"]) == ("paused", cause)
        assert report["t_s"] == pytest.approx(last_frame_s, abs=1e-9)
        assert self.active_s == report["active_s"]

    def streams(self) -> dict[tuple[str, int], Json]:
        """Return what the receipt says of each stream and epoch."""
        path = f"/api/sessions/{self.visit.session_id}/receipt"
        receipt: Json = ok(self.visit.operator.get(path))
        return {(one["stream"], one["epoch"]): one for one in receipt["streams"]}


def worn(site: Site, context: Any, script: Path, relay: RelayThread) -> Wearing:
    """Return a visit whose participant has just begun the hand task."""
    ok(site.operator.post("/api/studies", json={"yaml": short_study()}))
    fields = {"kind": "simulated", "language": "en", "time_scale": 20.0}
    view = ok(site.operator.post(f"/api/studies/{STUDY}/sessions", json=fields))
    session_id = str(view["id"])
    path = f"/api/sessions/{session_id}/pairings"
    code = str(ok(site.operator.post(path, json={"device": "headset"}))["code"])
    person = make_person(np.random.default_rng(7), None)
    visit = Visit(site.operator, session_id, WornHeadset(context, script, relay.url), person)
    visit.headset.open(code)
    put_on(visit)
    steps = [one["key"] for one in view["steps"]]
    site.skip_to(session_id, next(key for key in steps if "materialise" in key))
    visit.perform(
        lambda now: (
            bool(now["current"])
            and now["current"]["status"] == "running"
            and now["steps"][now["current"]["index"]]["kind"] == "task"
        )
    )
    return Wearing(site, visit)


def put_on(visit: Visit) -> None:
    """Wear the headset and enter VR."""
    visit.headset.wear(visit.person, traits=QUICK)
    visit.headset.enter()
    visit.headset.do("reembody.isRendering = false")


def test_a_phase_outlives_what_happens_to_its_headset_page_network_and_server(
    headset_site: Site,
    new_context: ContextFactory,
    page_factory: Callable[..., Page],
    page_watch: PageWatch,
    tmp_path: Path,
) -> None:
    """Each fault stops the clock at the last frame, and the phase ends complete.

    The device sleeps, is hidden and is recentred; the network is gone for a minute; the page is
    killed and opened again; so is the server. The operator sees each and resumes. Everything
    acknowledged stays stored, and so does everything made by the page that lives to the end.
    """
    page_watch.allow(r"WebSocket connection to .* failed|Failed to load resource")
    context = new_context()
    with relayed_in_thread(headset_site.server.port) as relay:
        script = journey_script(tmp_path)
        wearing = worn(headset_site, context, script, relay)
        visit, page = wearing.visit, wearing.page
        visit.draw(30)

        # Asleep.
        last_s, skipped = wearing.now_s, page.tell("reembody.skippedGaps")
        page.do(f"journey.sleep({SLEEP_S})")
        visit.draw(2)
        woken_s = wearing.now_s
        assert woken_s == pytest.approx(last_s + SLEEP_S + 2 * FRAME_S)
        # The second frame already shows a body of after the sleep, which was not simulated.
        assert page.tell("reembody.computed.timeS") >= woken_s - 1.5 * FRAME_S
        assert page.tell("reembody.skippedGaps") == skipped + 1
        wearing.paused_at("asleep", last_s)
        wearing.resume()

        # Hidden, and then behind the device's own menu.
        cockpit = page_factory((1280, 800))
        Experimenter(cockpit, headset_site.server.url).log_in()
        cockpit.goto(f"{headset_site.server.url}/#/sessions/{visit.session_id}")
        waiting = cockpit.get_by_text("Waiting until the participant looks at the scene again.")
        for visibility in ("hidden", "visible-blurred"):
            visit.draw(20)
            last_s = wearing.now_s
            page.do(f'journey.headset.setVisibility("{visibility}")')
            wearing.paused_at("asleep", last_s)
            # A resumption waits until the scene is seen again, though this device goes on drawing.
            wearing.order_resume()
            visit.draw(60)
            assert (wearing.seen(), visit.view()["current"]["resuming"]) == (
                ("paused", "asleep"),
                True,
            )
            assert wearing.active_s == wearing.newest_pause()["active_s"]
            expect(waiting).to_be_visible(timeout=PATIENCE_MS)
            page.do('journey.headset.setVisibility("visible")')
            wearing.until_running()
            expect(waiting).to_be_hidden(timeout=PATIENCE_MS)
        cockpit.close()

        # VR ends, as by the device's own button, and is entered again.
        visit.draw(20)
        last_s = wearing.now_s
        page.do("void journey.headset.session.end()")
        page.until("journey.headset.session === null")
        wearing.paused_at("asleep", last_s)
        page.enter("Return to VR")
        assert wearing.seen() == ("paused", "asleep")
        wearing.resume()

        # Recentred.
        visit.draw(20)
        last_s = wearing.now_s
        page.do("journey.headset.recentre({positionM: [0.1, 0, 0.2], rotation: [1, 0, 0, 0]})")
        page.do("journey.headset.recentre({positionM: [0, 0, 0], rotation: [1, 0, 0, 0]})")
        wearing.paused_at("recentred", last_s)
        wearing.resume()

        # Without a network for a minute.
        visit.draw(30)
        with relay.outage():
            page.until("!reembody.status.connected")
            last_s = wearing.now_s
            page.step(int(OUTAGE_S / OUTAGE_FRAME_S), OUTAGE_FRAME_S)
            assert not page.tell("reembody.run.clockRuns")
            assert wearing.seen()[0] == "paused"
            assert "disconnected" in {one["code"] for one in visit.view()["alarms"]}
        page.until("reembody.status.connected")
        # The phase is paused already: what the headset has to say about it is in its journal.
        page.until("reembody.status.settled")
        assert wearing.until_seen("paused") == "headset_lost"
        lost = wearing.newest_pause()
        assert lost["cause"] == "disconnected"
        assert lost["t_s"] <= last_s + OUTAGE_FRAME_S + 1e-9
        wearing.resume()

        # The page is killed.
        visit.draw(30)
        acknowledged = wearing.streams()
        visit.draw(9)
        active_s = wearing.active_s
        crash(page.page)
        page.page.close()
        visit.headset = WornHeadset(context, script, relay.url)
        page = visit.headset
        page.open()
        put_on(visit)
        assert wearing.until_seen("paused") == "headset_lost"
        assert 0.0 <= active_s - visit.view()["current"]["active_s"] <= 10 * FRAME_S
        wearing.resume()

        # The server is killed.
        visit.draw(30)
        headset_site.server.kill()
        page.until("!reembody.status.connected")
        visit.draw(30)
        headset_site.server.start()
        page.until("reembody.status.connected")
        assert wearing.until_seen("paused") == "server_restarted"
        wearing.resume()

        # The rest of the phase, and the end.
        visit.perform(lambda now: phase_of(now)["status"] == "done")
        while not visit.command(visit.view(), "abort", reason="The test has seen enough."):
            pass
        # The last frames are sent with the first frame after the end is known.
        page.until("reembody.place === 'over'")
        visit.draw(20)
        page.page.wait_for_timeout(STATUS_MS)
        page.until("reembody.status.journaledMessages === 0")
        recorded, inputs = page.tell("reembody.recorded"), page.tell("journey.rules")

    ended = [one for one in wearing.phase_reports() if one["what"] == "time_up"]
    assert ended[-1]["active_s"] == pytest.approx(ACTIVE_S, abs=1e-9)
    kept = wearing.streams()
    for key, before in acknowledged.items():
        assert kept[key]["stored"] >= before["stored"]
        assert all(first >= before["stored"] for first, _end in kept[key]["gaps"])
    epoch = max(epoch for _stream, epoch in kept)
    for stream in BODY_STREAMS:
        assert kept[stream, epoch]["stored"] == recorded
        assert kept[stream, epoch]["missing"] == 0
    with headset_site.database.reading() as db:
        reported = stored(db, visit.session_id)
    ours = derived(inputs, loaded(short_study()).protocol.tasks)
    assert ours.completions == [one for one in reported.completions if one[0] == epoch]
    assert ours.contacts == [one for one in reported.contacts if one[0] == epoch]


def phase_of(view: Json) -> Json:
    """Return the first phase at the boxes."""
    return next(one for one in view["phases"] if one["kind"] == "task")


RELOADS, RELOADS_ACTIVE_S = "headset-reloads", 20.0
"""The study of a phase long enough for a walk to the last box and back, at every latency."""
STAGES_OF_A_FOOT_TASK = {
    "preparing": "false",  # only the server knows that the operator has started the phase
    "walk_back": "(reembody.run?.state?.walkBackSinceS ?? null) !== null",
    "freezing": "reembody.run?.isFrozen === true",
}
"""How the page itself says that it is in a stage; the server hears of it a little later."""


def test_a_page_is_loaded_again_in_preparation_walk_back_and_freeze(
    headset_site: Site, new_context: ContextFactory, page_watch: PageWatch, tmp_path: Path
) -> None:
    """A foot task whose page is loaded again while its clock stands goes on there, to its end."""
    page_watch.allow(r"WebSocket connection to .* failed")
    site, operator = headset_site, headset_site.operator
    text = short_study().replace(f"key: {STUDY}", f"key: {RELOADS}", 1)
    text = text.replace(f"duration_s: {ACTIVE_S:g}", f"duration_s: {RELOADS_ACTIVE_S:g}")
    ok(operator.post("/api/studies", json={"yaml": text}))
    fields = {"kind": "simulated", "language": "en", "time_scale": 20.0}
    view = ok(operator.post(f"/api/studies/{RELOADS}/sessions", json=fields))
    session_id = str(view["id"])
    path = f"/api/sessions/{session_id}/pairings"
    code = str(ok(operator.post(path, json={"device": "headset"}))["code"])
    worn_page = WornHeadset(new_context(), journey_script(tmp_path), site.server.url)
    visit = Visit(operator, session_id, worn_page, make_person(np.random.default_rng(7), None))
    worn_page.open(code)
    put_on(visit)
    steps = {one["key"]: one for one in view["steps"]}
    site.skip_to(session_id, next(key for key in steps if "materialise" in key))
    foot = next(key for key, one in steps.items() if one.get("limb") == "foot")

    def in_foot_task(now: Json) -> bool:
        return bool(now["current"]) and now["steps"][now["current"]["index"]]["key"] == foot

    visit.perform(lambda now: bool(now["current"]) and _kind(now) == "task")
    while not in_foot_task(now := visit.view()):
        visit.command(now, "skip", reason="not in this test")
    for status, on_page in STAGES_OF_A_FOOT_TASK.items():

        def is_reported(now: Json, here: str = status) -> bool:
            return not in_foot_task(now) or now["current"]["status"] == here

        def is_on_page(now: Json, here: str = on_page) -> bool:
            return is_reported(now) or bool(worn_page.tell(here))

        found = visit.perform(is_on_page)
        if not is_reported(found):
            found = visit.perform_slowly(is_reported)
        assert in_foot_task(found), (status, found["phases"][-1])
        counted_s = found["current"]["active_s"]
        worn_page.page.reload()
        put_on(visit)
        now = visit.view()
        assert in_foot_task(now), status
        assert now["current"]["active_s"] == pytest.approx(counted_s, abs=10 * FRAME_S), status
    found = visit.perform(lambda now: not in_foot_task(now))
    (phase,) = (one for one in found["phases"] if one["limb"] == "foot")
    assert (phase["status"], phase["active_s"]) == (
        "done",
        pytest.approx(RELOADS_ACTIVE_S, abs=1e-9),
    )
    assert phase["completions"] >= 1
    site.command(session_id, "abort", reason="The test has seen enough.")


def _kind(view: Json) -> str:
    """Return the kind of the current step."""
    return str(view["steps"][view["current"]["index"]]["kind"])
