"""Browser test of desktop mode: from the cockpit to a participant on the same screen."""

import sys
import time
import uuid
from collections.abc import Callable
from http import HTTPStatus

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, PICTURE_HIDDEN, Experimenter
from tests.e2e.test_first_study import STUDY, short_study
from tests.features.lab import Json, ok
from tests.features.record.headset.site import Site
from tests.rehearsal.test_road import short_study as short_road
from tests.support.acting_on_screen import act_on_this_screen, until

TEST_SESSION = {"kind": "test", "language": "en"}


def test_the_study_is_acted_on_this_screen_after_one_click(
    headset_site: Site,
    page_factory: Callable[..., Page],
    screenshot: Callable[[Page, str], object],
) -> None:
    """A click in the cockpit pairs this browser, and mouse and keyboard move the participant."""
    if headset_site.operator.get(f"/api/studies/{STUDY}").status_code == 404:
        ok(headset_site.operator.post("/api/studies", json={"yaml": short_study()}))
    view = ok(headset_site.operator.post(f"/api/studies/{STUDY}/sessions", json={}))
    page = page_factory((1280, 800))
    console = Experimenter(page, headset_site.server.url)
    console.log_in()
    page.goto(f"{headset_site.server.url}/#/sessions/{view['id']}")
    act = page.get_by_role("button", name="Act on this screen")
    expect(act).to_be_visible(timeout=PATIENCE_MS)
    with page.expect_popup() as opened:
        act.click()
    desk = opened.value
    expect(desk.locator("canvas")).to_be_visible(timeout=PATIENCE_MS)
    expect(desk.get_by_text("press both grips")).to_be_visible()
    desk.wait_for_function("globalThis.reembody?.frames > 2", timeout=PATIENCE_MS, polling=100)
    screenshot(desk, "desktop")
    desk.keyboard.press("h")
    expect(desk.get_by_text("press both grips")).to_be_hidden()
    connected = page.locator('[data-check="headset"]').get_by_text("Paired and connected")
    expect(connected).to_be_visible(timeout=PATIENCE_MS)


def test_two_clicks_lead_from_the_first_page_into_a_body(
    headset_site: Site,
    page_factory: Callable[..., Page],
    screenshot: Callable[[Page, str], object],
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Help and one item of it lead into a body that walks by keys, in a test session."""
    page = page_factory((1280, 800))
    page.add_init_script(PICTURE_HIDDEN)
    Experimenter(page, headset_site.server.url).log_in()
    page.get_by_role("button", name="Help", exact=True).click()
    expect(page.get_by_role("menuitem", name="Act on this screen")).to_be_enabled()
    screenshot(page, "act-on-screen-menu")
    page.keyboard.press("Escape")
    acted = act_on_this_screen(page)
    screenshot(acted.desk, "acting-on-screen")
    assert acted.clicks <= 3
    with capsys.disabled():
        sys.stdout.write(f"\n{acted.clicks} clicks, {acted.took_s:.1f} s into the body\n")
    # The console has gone to the session, which says what was left out and is marked as a test.
    session_id = page.url.rpartition("/")[2]
    view = ok(headset_site.operator.get(f"/api/sessions/{session_id}"))
    statuses = {step["kind"]: step["status"] for step in view["steps"]}
    assert (view["kind"], view["status"]) == ("test", "active")
    assert (statuses["consent"], statuses["materialise"]) == ("skipped", "done")
    # One person is participant and experimenter: the page has the experimenter's next button.
    bar = acted.desk.get_by_label("What the experimenter presses")
    expect(bar.get_by_role("button")).to_be_enabled()
    screenshot(acted.desk, "acting-on-screen-next")
    bar.get_by_role("button").click()
    begun = {"status": "ready"}
    until_s = time.monotonic() + PATIENCE_MS / 1000
    while begun["status"] == "ready" and time.monotonic() < until_s:
        acted.desk.wait_for_timeout(200)
        begun = ok(headset_site.operator.get(f"/api/sessions/{session_id}"))["current"]
    # A screen that draws too slowly pauses what has begun.
    assert begun["status"] in ("preparing", "running", "paused")


def test_one_person_alone_crosses_the_road_there_and_back(
    headset_site: Site,
    page_factory: Callable[..., Page],
    screenshot: Callable[[Page, str], object],
) -> None:
    """W leads across the road and S back, without a headset; both crossings are measured.

    On a busy machine pictures come so late that the clock pauses, as in a headset that sleeps; the
    experimenter then resumes.
    """
    yaml = short_road().replace("key: road-short", "key: road-desk", 1)
    yaml = yaml.replace("crossings: 1", "crossings: 2", 1)
    ok(headset_site.operator.post("/api/studies", json={"yaml": yaml}))
    session = ok(headset_site.operator.post("/api/studies/road-desk/sessions", json=TEST_SESSION))
    page = page_factory((1280, 800))
    page.add_init_script(PICTURE_HIDDEN)
    Experimenter(page, headset_site.server.url).log_in()
    page.goto(f"{headset_site.server.url}/#/sessions/{session['id']}")
    with page.expect_popup() as opened:
        page.get_by_role("button", name="Act on this screen").click(timeout=PATIENCE_MS)
    desk = opened.value
    until(desk, "globalThis.reembody?.frames > 2")
    # Software rendering is slower than a screen may be.
    desk.evaluate("reembody.isRendering = false")
    headset_site.skip_to(session["id"], "materialise")
    until(desk, "reembody.place === 'stepping_in'")
    desk.keyboard.down("Space")
    until(desk, "reembody.place === 'acting'")
    desk.keyboard.up("Space")
    view = headset_site.view(session["id"])
    while view["steps"][view["current"]["index"]]["kind"] != "road_crossing":
        view = _skip(headset_site, view)
    headset_site.command(session["id"], "begin_phase")
    until(desk, "reembody.run?.clockRuns === true")
    for crossed in (1, 2):
        _cross(desk, headset_site, session["id"], crossed)
        desk.evaluate("reembody.isRendering = true")
        screenshot(desk, f"desk-road-{crossed}")
        desk.evaluate("reembody.isRendering = false")
    until(desk, "reembody.run === null")
    runs = _ended_runs(headset_site, session["id"])
    assert [one["is_across"] for run in runs for one in run["crossings"]] == [True, True]


def _ended_runs(site: Site, session_id: str) -> list[Json]:
    """Return the runs on the road once the server has stored the end of each."""
    deadline = time.monotonic() + PATIENCE_MS / 1000
    while True:
        runs: list[Json] = ok(site.operator.get(f"/api/sessions/{session_id}/road"))["runs"]
        if all(run["ended"] != "running" for run in runs) or time.monotonic() > deadline:
            return runs
        time.sleep(0.2)


PLACE = """() => ({
    crossed: reembody.run?.completed ?? Infinity,
    isPaused: reembody.run?.isPaused ?? false,
    zM: reembody.computed.remote[2],
})"""
MIDDLE_Z_M = -3.3


def _cross(desk: Page, site: Site, session_id: str, crossed: int) -> None:
    """Hold the key that leads to the other side until so many crossings are done."""
    place = desk.evaluate(PLACE)
    key = "KeyW" if place["zM"] > MIDDLE_Z_M else "KeyS"
    until_s = time.monotonic() + 3 * PATIENCE_MS / 1000
    desk.keyboard.down(key)
    while place["crossed"] < crossed:
        assert time.monotonic() < until_s, place
        if place["isPaused"]:
            desk.keyboard.up(key)
            current = site.view(session_id)["current"]
            if current["status"] == "paused" and not current["resuming"]:
                site.command(session_id, "resume")
        else:
            desk.keyboard.down(key)
        desk.wait_for_timeout(200)
        place = desk.evaluate(PLACE)
    desk.keyboard.up(key)


def _skip(site: Site, view: Json) -> Json:
    """Skip the step of a session; look again if the page has reported something meanwhile."""
    path = f"/api/sessions/{view['id']}/commands"
    body = {"command_id": str(uuid.uuid4()), "type": "skip", "reason": "not in this test"}
    expected: Json = {**body, "expected_version": view["version"]}
    answer = site.operator.post(path, json=expected)
    while answer.status_code == HTTPStatus.CONFLICT and answer.json()["error"]["code"] == "stale":
        expected["expected_version"] = answer.json()["error"]["valid"]
        answer = site.operator.post(path, json=expected)
    skipped: Json = ok(answer)
    return skipped
