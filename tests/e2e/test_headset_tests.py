"""Browser test of the headsets' self-tests on the console's equipment page."""

from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.e2e.people import Experimenter
from tests.features.lab import ok
from tests.features.record.headset.site import open_site
from tests.features.record.self_tests.reports import TRACKED, report
from tests.support.server import LiveServer

LOST = {**TRACKED, "tracked": 0.6, "lost": 0.4, "longest_loss_s": 14.2, "pose_rate_hz": 28.0}
INFERRED = {**TRACKED, "tracked": 0.0, "inferred": 1.0}
GOOD = report(started_at="2026-03-01T08:00:00Z")
POOR = report(
    started_at="2026-03-02T09:30:00Z",
    rendering__mean_rate_hz=83.1,
    rendering__late_frames=640,
    physics__real_time_factor=1.3,
    tracking__LeftHand=LOST,
    tracking__LeftLowerLeg=INFERRED,
    tracking__RightLowerLeg=INFERRED,
    page__errors=["WebGL: CONTEXT_LOST_WEBGL"],
)
ON_SCREEN = report(
    started_at="2026-03-03T10:00:00Z",
    device={"user_agent": "Mozilla/5.0 Chrome/147.0", "name": None, "inputs": ["scripted"]},
    rendering__mode="screen",
    rendering__nominal_rate_hz=None,
    rendering__late_frames=None,
    physics=None,
    page__memory_bytes=None,
)


def test_the_self_tests_of_headsets_are_listed_with_every_figure(
    live_server: LiveServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """The list says how to run the first test; then each has its verdicts, limits and figures."""
    page = page_factory()
    experimenter = Experimenter(page, live_server.url)
    experimenter.log_in()
    page.goto(f"{live_server.url}/#/equipment")
    expect(page.get_by_role("heading", name="No headset has been tested yet")).to_be_visible()
    expect(page.get_by_text("Test this headset (2 minutes)")).to_be_visible()
    assert axe(page) == []
    screenshot(page, "headset-tests-empty")

    with open_site(live_server) as site, live_server.client() as headset:
        headers = {"authorization": f"Bearer {site.token(site.join())}"}
        for one in (GOOD, POOR, ON_SCREEN):
            ok(headset.post("/api/vr/self-tests", json=one, headers=headers))
    page.reload()
    section = page.get_by_role("region", name="Headset tests")
    rows = section.get_by_role("row")
    expect(rows).to_have_count(4)
    expect(rows.nth(1)).to_contain_text("not worn")
    expect(rows.nth(1)).to_contain_text("not measured")
    expect(rows.nth(2)).to_contain_text("83.1 / 90 Hz")
    expect(rows.nth(2)).to_contain_text("not good enough")
    expect(rows.nth(3)).to_contain_text("all 15 fine")
    assert axe(page) == []
    screenshot(page, "headset-tests")

    rows.nth(2).get_by_role("button").press("Enter")
    details = page.get_by_role("dialog", name="Headset tests")
    verdicts = details.get_by_role("table", name="Verdicts")
    late = verdicts.get_by_role("row", name="Late frames")
    expect(late).to_contain_text("5.9 %")
    expect(late).to_contain_text("at most 1 %")
    expect(late).to_contain_text("Close other apps")
    expect(verdicts.get_by_role("row", name="Speed of the physics")).to_contain_text("1.3 ×")
    expect(details.get_by_text("CONTEXT_LOST_WEBGL")).to_be_visible()
    expect(details.get_by_role("row", name="Left hand")).to_contain_text("14.20 s")
    assert axe(page) == []
    screenshot(page, "headset-test-details")
    page.keyboard.press("Escape")
    expect(details).to_be_hidden()

    page.emulate_media(color_scheme="dark")
    page.set_viewport_size({"width": 1180, "height": 820})
    rows.nth(1).get_by_role("button").click()
    expect(details.get_by_text("says nothing about the headset")).to_be_visible()
    assert axe(page) == []
    screenshot(page, "headset-test-details-dark")
