"""Browser tests of a road whose traffic is missing, or breaks off while somebody crosses."""

import hashlib
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, ViewportSize, expect

from tests.adapters.cosimulation import protocol_partner
from tests.e2e.people import PATIENCE_MS, PICTURE_HIDDEN, Experimenter
from tests.features.record.headset.site import Site
from tests.rehearsal.test_road import short_study
from tests.support.browser import ContextFactory, in_both_schemes
from tests.support.vr_visit import QUICK, Visit, begun, journey_script, ok

Json = dict[str, Any]
Shot = Callable[[Page, str], object]
PARTNER = "drone"
SIZES: tuple[ViewportSize, ...] = (
    {"width": 1280, "height": 800},
    {"width": 1180, "height": 820},
)


def _study(key: str, partner: str) -> str:
    """Return the short study with another key, and with one more partner on its road."""
    text = short_study().replace("key: road-short", f"key: {key}", 1)
    return text.replace("  partners:\n", f"  partners:\n    - {{{partner}}}\n", 1)


@contextmanager
def _partner(port: int) -> Iterator[subprocess.Popen[bytes]]:
    """Run a partner that connects as soon as the scene waits for it."""
    command = [sys.executable, protocol_partner.__file__, f"127.0.0.1:{port}", PARTNER, "0", "none"]
    process = subprocess.Popen(command)
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def _is_on_road(*statuses: str) -> Callable[[Json], bool]:
    """Return whether a view is in a phase on the road with one of these statuses."""

    def is_so(view: Json) -> bool:
        current = view["current"]
        if current is None or view["steps"][current["index"]]["kind"] != "road_crossing":
            return False
        return current["status"] in statuses

    return is_so


def _road(visit: Visit) -> Json:
    road: Json = ok(visit.operator.get(f"/api/sessions/{visit.session_id}/road"))
    return road


def _pictured(page: Page, panel: Locator, screenshot: Shot, name: str) -> None:
    for size in SIZES:
        page.set_viewport_size(size)
        for scheme in in_both_schemes(page):
            panel.scroll_into_view_if_needed()
            screenshot(page, f"road-{name}-{size['width']}-{scheme}")


def test_a_partner_that_is_killed_is_seen_and_the_phase_can_be_done_again(
    headset_site: Site,
    new_context: ContextFactory,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Shot,
    tmp_path: Path,
) -> None:
    """The page says what broke off and what to do, the clock stands, and the record stays.

    The phase is done again and completes; before that the page says which program it waits for.
    """
    server, operator = headset_site.server, headset_site.operator
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = int(free.getsockname()[1])
    study = _study("road-partner", f"name: {PARTNER}, kind: process, port: {port}")
    ok(operator.post("/api/studies", json={"yaml": study}))
    visit, tablet = begun(
        operator,
        new_context(),
        journey_script(tmp_path),
        server.url,
        "road-partner",
        time_scale=10.0,
        traits=QUICK,
    )
    page = page_factory((1280, 800))
    page.add_init_script(PICTURE_HIDDEN)
    Experimenter(page, server.url).log_in()
    page.goto(f"{server.url}/#/sessions/{visit.session_id}")
    panel = page.get_by_role("region", name="Road")
    with tablet:
        expect(panel).to_contain_text("No crossings yet", timeout=PATIENCE_MS)
        visit.perform(until=_is_on_road("preparing"))
        visit.draw(90)
        expect(panel).to_contain_text(f"{PARTNER}: 127.0.0.1:{port}", timeout=PATIENCE_MS)
        _pictured(page, panel, screenshot, "waits")
        with _partner(port) as process:
            visit.perform(until=_is_on_road("running"))
            visit.draw(90)
            process.send_signal(signal.SIGKILL)
            paused = visit.perform(until=_is_on_road("paused"))
        expect(panel.get_by_role("alert")).to_contain_text("The traffic has broken off")
        expect(panel.get_by_role("alert")).to_contain_text(f"'{PARTNER}' has closed its connection")
        step = page.locator("[data-tour=step]")
        expect(step).to_contain_text("Paused: the traffic on the road broke off")
        assert axe(page) == []
        _pictured(page, panel, screenshot, "broken")
        assert paused["current"]["active_s"] > 0.5
        visit.draw(90)
        stands = visit.view()
        assert stands["current"]["active_s"] == paused["current"]["active_s"]
        (lost,) = _road(visit)["runs"]
        record = operator.get(f"/api/sessions/{visit.session_id}/road/{lost['id']}").content
        assert lost["ended"] == "partner lost"
        assert hashlib.sha256(record).hexdigest() == lost["sha256"]
        assert len(record.splitlines()) > lost["steps"] > 15.0 / 0.02
        assert visit.command(stands, "redo", reason="The other program was killed")
        with _partner(port):
            visit.perform(until=_is_on_road("running"))
            expect(panel).to_contain_text("cars on the road", timeout=PATIENCE_MS)
            expect(panel.get_by_role("alert")).to_have_count(0)
            _pictured(page, panel, screenshot, "runs")
            done = visit.perform(
                until=lambda view: any(_has_crossed(one) for one in view["phases"])
            )
            _wait_until_complete(visit)
        view = visit.view()
        visit.command(view, "abort", reason="seen enough")
    crossed = [one for one in done["phases"] if one["kind"] == "road_crossing"]
    assert [(one["status"], one["completions"] or 0) for one in crossed] == [
        ("voided", 0),
        ("done", 1),
    ]
    assert [run["ended"] for run in _road(visit)["runs"]] == ["partner lost", "complete"]
    crossing = panel.get_by_role("listitem", name="Crossing 1")
    expect(crossing).to_contain_text("Gap accepted", timeout=PATIENCE_MS)
    _pictured(page, panel, screenshot, "crossed")


def _wait_until_complete(visit: Visit) -> None:
    """Wait until the server has ended the traffic, before the other program ends."""
    for _ in range(200):
        if _road(visit)["runs"][-1]["ended"] != "running":
            return
        time.sleep(0.1)
    raise AssertionError("the traffic still runs, long after its phase was done")


def _has_crossed(phase: Json) -> bool:
    return bool(phase["kind"] == "road_crossing" and phase["status"] == "done")


def test_traffic_that_is_not_installed_is_said_before_the_start(
    headset_site: Site, page_factory: Callable[..., Page], screenshot: Shot
) -> None:
    """A study with traffic by SUMO says without it which command adds it, in the pre-flight."""
    if find_spec("sumo") is not None:
        pytest.skip("SUMO is installed here; the page is about what is missing without it")
    flows = "flows: [{lane: near, headway_s: 6, count: 5, speed_m_s: 11}]"
    study = _study("road-sumo", f"name: sumo, kind: sumo, {flows}")
    ok(headset_site.operator.post("/api/studies", json={"yaml": study}))
    session = ok(headset_site.operator.post("/api/studies/road-sumo/sessions", json={}))
    page = page_factory((1280, 800))
    Experimenter(page, headset_site.server.url).log_in()
    page.goto(f"{headset_site.server.url}/#/sessions/{session['id']}")
    check = page.locator('[data-check="road"]')
    expect(check).to_contain_text("SUMO is not installed", timeout=PATIENCE_MS)
    expect(check).to_contain_text("crossing install traffic")
    _pictured(page, check, screenshot, "missing")
