"""Browser test of a study's pilots: start, watch, stop, resume, read, delete."""

import re
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS
from tests.features.results.pilot.pilots import KEY, short_study
from tests.support.browser import ContextFactory
from tests.support.server import ADMIN_PASSWORD, LiveServer

_POWER = "reembodiment-latency"


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    """Provide one server for the tests of this file."""
    with LiveServer(tmp_path_factory.mktemp("pilot")) as server:
        yield server


def test_a_pilot_is_started_read_and_deleted(
    server: LiveServer,
    new_context: ContextFactory,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """A cohort is stopped and resumed and changes the length of a visit; a power run is read.

    Everything is marked as simulated, and what is deleted is gone.
    """
    context = new_context((1280, 800), "light")
    with server.client() as admin:
        admin.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD})
        admin.post("/api/studies", json={"yaml": short_study()}).raise_for_status()
        context.add_cookies(
            [
                {"name": cookie.name, "value": cookie.value or "", "url": server.url}
                for cookie in admin.cookies.jar
            ]
        )
    page = context.new_page()
    page.goto(f"{server.url}/#/studies/{KEY}/pilot")
    expect(page.get_by_role("heading", name="No pilot yet")).to_be_visible()
    assert axe(page) == []
    power = page.get_by_role("form", name="Power of the test")
    assumptions = page.get_by_label("Assumptions (YAML)")
    expect(assumptions).to_be_hidden()
    expect(power.get_by_text("What is assumed of people’s answers is missing")).to_be_visible()
    expect(power.get_by_role("button", name="Start")).to_be_disabled()
    power.get_by_role("button", name="Insert an example").click()
    expect(assumptions).to_contain_text("latency_200")
    expect(power.get_by_role("button", name="Start")).to_be_enabled()
    assert axe(page) == []
    screenshot(page, "pilot-example")
    cohort = page.get_by_role("form", name="Simulated people")
    cohort.get_by_label("Also simulate the power").uncheck()
    cohort.get_by_label("People").fill("2")
    cohort.get_by_role("button", name="Start").click()
    shown = page.get_by_role("region", name="The pilot that is shown")
    shown.get_by_role("button", name="Stop").click()
    expect(shown.get_by_text(re.compile("^Stopped"))).to_be_visible(timeout=PATIENCE_MS)
    shown.get_by_role("button", name="Resume").click()
    expect(shown.get_by_text("Length of a visit")).to_be_visible(timeout=4 * PATIENCE_MS)
    expect(shown.get_by_text("SIMULATED").first).to_be_visible()
    expect(shown.get_by_text("5th percentile of women to 95th of men")).to_be_visible()
    expect(shown.get_by_text("Phase too short: procedure.block.phases[0]")).to_be_visible()
    assert axe(page) == []
    screenshot(page, "pilot-cohort")
    page.goto(f"{server.url}/#/studies/{KEY}/overview")
    expect(page.get_by_text("as a pilot of this version says (simulated)")).to_be_visible()
    page.goto(f"{server.url}/#/studies/{KEY}/pilot")
    shown.get_by_role("button", name="Delete").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete").click()
    expect(page.get_by_role("heading", name="No pilot yet")).to_be_visible()

    page.goto(f"{server.url}/#/studies/{_POWER}/pilot")
    power = page.get_by_role("form", name="Power of the test")
    power.get_by_label("Numbers of participants").fill("6, many")
    expect(power.get_by_role("button", name="Start")).to_be_disabled()
    power.get_by_label("Numbers of participants").fill("6, 12")
    power.get_by_label("Data sets each").fill("100")
    power.get_by_role("button", name="Start").click()
    curve = shown.get_by_role("region", name="Power by number of participants").first
    expect(curve.locator(".main-svg").first).to_be_visible(timeout=4 * PATIENCE_MS)
    expect(shown.get_by_text("Clopper-Pearson intervals of 95 %. All of it")).to_be_visible()
    expect(shown.get_by_text("Page’s trend test: score “").first).to_be_visible()
    expect(shown.get_by_text("page_trend")).to_have_count(0)
    expect(shown.get_by_text("answering.effects.latency_350")).to_be_visible()
    assert axe(page) == []
    page.emulate_media(color_scheme="dark")
    assert axe(page) == []
    screenshot(page, "pilot-power")
