"""Browser test of desktop mode: from the cockpit to a participant on the same screen."""

import sys
import time
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, PICTURE_HIDDEN, Experimenter
from tests.e2e.test_first_study import STUDY, short_study
from tests.features.lab import ok
from tests.features.record.headset.site import Site
from tests.support.acting_on_screen import act_on_this_screen


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
