"""Browser test of desktop mode: from the cockpit to a participant on the same screen."""

from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.e2e.test_first_study import STUDY, short_study
from tests.features.lab import ok
from tests.features.record.headset.site import Site


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
