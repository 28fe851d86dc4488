"""Browser test of the headset's self-test: from pairing to the stored report and its verdicts."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import Experimenter
from tests.features.record.headset.site import Site
from tests.protocol.helpers import SHIPPED
from tests.support.browser import ContextFactory, PageWatch
from tests.support.vr_visit import FRAME_RATE_HZ, Json, WornHeadset, journey_script, ok

STUDY = "headset-self-test"
PATIENCE_MS = 20_000
SMOOTH_FRAMES, LOST_FRAMES = 900, 90
SLOW_S = 0.25
"""So long a frame is late, and too long to be simulated: the rest of the test takes little time."""
DURATION_S = 120.0
BATCH_FRAMES = 6


@pytest.fixture
def visit_script(tmp_path: Path) -> Path:
    """Provide the emulated headset and its wearer as one script."""
    return journey_script(tmp_path)


class HeadsetUnderTest:
    """A paired headset, not yet in its session, whose page offers the test."""

    def __init__(self, site: Site, context: Any, script: Path) -> None:
        self.operator = site.operator
        if self.operator.get(f"/api/studies/{STUDY}").status_code == 404:
            text = SHIPPED.replace("key: reembodiment-latency", f"key: {STUDY}", 1)
            ok(self.operator.post("/api/studies", json={"yaml": text}))
        path = f"/api/studies/{STUDY}/sessions"
        self.session_id = str(ok(self.operator.post(path, json={"language": "en"}))["id"])
        path = f"/api/sessions/{self.session_id}/pairings"
        code = ok(self.operator.post(path, json={"device": "headset"}))["code"]
        self.headset = WornHeadset(context, script, site.server.url)
        self.headset.open(str(code))
        self.page: Page = self.headset.page

    def begin(self) -> None:
        """Press the button, and draw until something is measured."""
        button = self.page.get_by_role("button", name="Test this headset (2 minutes)")
        expect(button).to_be_enabled(timeout=PATIENCE_MS)
        button.click()
        self.headset.until("globalThis.reembodyTest !== undefined && journey.headset.session")
        self.headset.do("reembodyTest.isRendering = false")
        self.until("measuring")

    def until(self, kind: str) -> None:
        """Draw frames until the test has come so far."""
        for _ in range(400):
            self.headset.step(3)
            if self.kind == kind:
                return
            self.page.wait_for_timeout(25)
        raise AssertionError(f"never {kind}: {self.page.locator('main').inner_text()}")

    @property
    def kind(self) -> str:
        """How far the test is."""
        return str(self.headset.tell("reembodyTest.progress.kind"))

    def stored(self) -> list[Json]:
        """Return the self-tests that the server lists, newest first."""
        listed: list[Json] = ok(self.operator.get("/api/headset-tests"))
        return listed

    def view(self) -> Json:
        """Return the session, which a test leaves alone."""
        view: Json = ok(self.operator.get(f"/api/sessions/{self.session_id}"))
        return view


def test_a_worn_headset_measures_itself_and_its_report_is_judged(
    headset_site: Site,
    new_context: ContextFactory,
    page_factory: Callable[..., Page],
    visit_script: Path,
    screenshot: Callable[[Page, str], object],
    axe: Callable[[Page], list[str]],
) -> None:
    """The figures are those of what was done to the headset; the session knows nothing of it."""
    tested = HeadsetUnderTest(headset_site, new_context(), visit_script)
    before = tested.view()
    known = {one["id"] for one in tested.stored()}
    tested.begin()
    headset = tested.headset
    assert headset.tell("reembodyTest.panel.screen.title") == "Look around"
    cockpit = page_factory((1280, 800))
    Experimenter(cockpit, headset_site.server.url).log_in()
    cockpit.goto(f"{headset_site.server.url}/#/sessions/{tested.session_id}")
    devices = cockpit.locator("[data-tour=devices]")
    expect(devices).to_contain_text("Self-test", timeout=PATIENCE_MS)
    expect(cockpit.get_by_text("Live", exact=True)).to_be_visible(timeout=PATIENCE_MS)
    headset.step(SMOOTH_FRAMES)
    expect(devices).to_contain_text(
        re.compile(r"Self-test runs, 1 min \d+ s left"), timeout=PATIENCE_MS
    )
    screenshot(cockpit, "cockpit-self-test")
    cockpit.close()
    headset.do("journey.headset.setLost('controller left', true)")
    headset.step(LOST_FRAMES)
    headset.do("journey.headset.setLost('controller left', false)")
    slow = 0
    while tested.kind == "measuring":
        slow += 20
        headset.step(20, SLOW_S)
    tested.until("stored")
    assert tested.page.get_by_role("table").is_visible()

    report = next(one for one in tested.stored() if one["id"] not in known)
    figures, verdicts = report["report"], {one["code"]: one for one in report["verdicts"]}
    assert report["worn"]
    assert figures["duration_s"] == pytest.approx(DURATION_S, abs=SLOW_S)
    assert figures["device"]["name"] == "Quest 3"
    assert set(figures["device"]["inputs"]) == {"controllers", "shins"}
    rendering = figures["rendering"]
    assert rendering["mode"] == "immersive"
    assert rendering["nominal_rate_hz"] == FRAME_RATE_HZ
    assert rendering["interval_p50_s"] == pytest.approx(1 / FRAME_RATE_HZ)
    assert rendering["interval_longest_s"] == pytest.approx(SLOW_S)
    assert 0 <= slow - rendering["late_frames"] < 20
    assert rendering["mean_rate_hz"] == pytest.approx(
        (rendering["frames"] - 1) / figures["duration_s"]
    )
    left, right = figures["tracking"]["LeftHand"], figures["tracking"]["RightHand"]
    assert left["longest_loss_s"] == pytest.approx(LOST_FRAMES / FRAME_RATE_HZ, abs=0.012)
    assert left["lost"] == pytest.approx(left["longest_loss_s"] / figures["duration_s"])
    assert right["tracked"] == pytest.approx(1.0)
    assert figures["tracking"]["LeftLowerLeg"]["tracked"] == pytest.approx(1.0)
    assert figures["tracking"]["Hips"]["inferred"] == pytest.approx(1.0)
    smooth_s = (SMOOTH_FRAMES + LOST_FRAMES) / FRAME_RATE_HZ
    assert smooth_s - 0.1 <= figures["physics"]["simulated_s"] <= smooth_s + 0.2
    assert figures["physics"]["real_time_factor"] > 0
    assert figures["physics"]["where"] == "worker"
    storage = figures["storage"]
    assert storage["acknowledged"] == storage["batches"] > 0
    # Its clock is stepped, so how long a write takes is not known here.
    assert storage["journal_writes"] > 0
    assert storage["journal_write_p95_s"] is not None
    streams = storage["batches"] // -(-rendering["frames"] // BATCH_FRAMES)
    assert streams in (2, 4)
    assert figures["page"]["errors"] == []
    assert verdicts["unacknowledged"]["status"] == "ok"
    assert verdicts["late_frames"]["status"] == "fail"
    assert verdicts["feet_tracked"]["status"] == "ok"
    assert tested.view()["version"] == before["version"]

    # In the headset: what is wrong, and the way out; on the page: every verdict.
    headset.step(3)
    screen = headset.tell("reembodyTest.panel.screen")
    assert screen["title"] == "This needs attention before a study"
    assert "Frame rate" in str(screen["body"])
    tested.page.evaluate("() => journey.press('leave')")
    headset.until("journey.headset.session === null")
    rows = tested.page.locator("[data-verdict]")
    assert rows.count() == len(verdicts)
    for row in rows.all():
        code = row.get_attribute("data-verdict")
        assert code is not None
        assert row.get_attribute("data-status") == verdicts[code]["status"]
    # What looks at the page needs real frames.
    headset.do("journey.clock.uninstall()")
    screenshot(tested.page, "self-test-result")
    assert axe(tested.page) == []
    tested.page.get_by_role("button", name="Back").click()
    expect(tested.page.get_by_role("button", name="Enter VR")).to_be_enabled()


def test_a_report_waits_on_the_headset_while_the_server_is_away(
    headset_site: Site,
    new_context: ContextFactory,
    page_watch: PageWatch,
    visit_script: Path,
    screenshot: Callable[[Page, str], object],
) -> None:
    """Nobody is tracked, so a script moves the body; the report arrives once the server is back.

    Then the session comes to the body, and the headset is there for it.
    """
    page_watch.allow(r"WebSocket connection to .* failed|Failed to load resource|ERR_CONNECTION")
    tested = HeadsetUnderTest(headset_site, new_context(), visit_script)
    known = {one["id"] for one in tested.stored()}
    headset = tested.headset
    for side in ("left", "right"):
        headset.do(f"journey.headset.setConnected('{side}', false)")
    tested.begin()
    headset.step(300)
    assert headset.tell("reembodyTest.progress.isScripted")
    headset.step(80, 0.11)
    headset_site.server.kill()
    # The emulated headset's canvas covers the page, so no mouse reaches it.
    tested.page.get_by_role("button", name="Stop the test").press("Enter")
    tested.until("kept")
    expect(tested.page.get_by_text("One report of a test waits")).to_be_visible()
    screenshot(tested.page, "self-test-kept")
    assert headset.tell("reembodyTest.panel.screen.key") == "selftest kept"
    headset_site.server.start()
    tested.until("stored")
    new = [one for one in tested.stored() if one["id"] not in known]
    assert len(new) == 1
    assert "scripted" in new[0]["report"]["device"]["inputs"]
    assert not new[0]["worn"]
    assert new[0]["report"]["tracking"]["LeftHand"]["lost"] == pytest.approx(1.0)
    verdicts = {one["code"]: one["status"] for one in new[0]["verdicts"]}
    assert verdicts["duration"] == "warn"
    expect(tested.page.get_by_text("One report of a test waits")).to_be_hidden()
    assert headset.tell("localStorage.getItem('reembody.vr.self-tests')") is None

    steps = [one["key"] for one in tested.view()["steps"] if one["kind"] == "materialise"]
    headset_site.skip_to(tested.session_id, steps[0])
    expect(tested.page.get_by_text("because the session goes on")).to_be_visible()
    assert headset.tell("globalThis.reembodyTest === undefined")
    assert headset.tell("journey.headset.session === null")
    expect(tested.page.get_by_role("button", name="Test this headset")).to_be_disabled()
    expect(tested.page.get_by_role("button", name="Enter VR")).to_be_enabled()
