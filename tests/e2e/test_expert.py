"""Browser tests of an expert's session, the equipment's latency and inconsistent heights."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import Experimenter
from tests.e2e.test_stop_rule import session_at
from tests.features.lab import ok
from tests.protocol.options import KEY, with_options
from tests.support.server import ADMIN_PASSWORD, LiveServer


@pytest.fixture
def experimenter(running_server: LiveServer, page_factory: Callable[..., Page]) -> Experimenter:
    """Provide a signed-in experimenter, with the study that has options."""
    with running_server.client() as api:
        ok(api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        if api.get(f"/api/studies/{KEY}").status_code == 404:
            ok(api.post("/api/studies", json={"yaml": with_options()}))
    person = Experimenter(page_factory((1280, 800)), running_server.url)
    person.log_in()
    return person


def test_an_experts_suggestion_reaches_the_study(
    experimenter: Experimenter,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """An expert's suggestion is saved with its step, listed by version and decided only once."""
    page = experimenter.page
    experimenter.open_tab(KEY)
    page.get_by_role("button", name="New session").first.click()
    page.get_by_role("radio", name="Expert").check()
    page.get_by_role("button", name="Create session").click()
    expect(page.get_by_text("never in figures or exports")).to_be_visible()
    experimenter.press("Start session")
    page.get_by_label("What does the expert advise?").fill("Say how long it takes.")
    experimenter.press("Save suggestion")
    expect(page.get_by_text("Say how long it takes.").last).to_be_visible()
    assert axe(page) == []
    screenshot(page, "expert-cockpit")
    experimenter.open_tab(KEY, "suggestions")
    expect(page.get_by_text("Say how long it takes.")).to_be_visible()
    assert axe(page) == []
    screenshot(page, "suggestions")
    experimenter.press("Decline")
    expect(page.get_by_text("Declined")).to_be_visible()
    experimenter.open_tab(KEY, "sessions")
    expect(
        page.get_by_role("row", name="EXPERT-0001").get_by_text("Expert", exact=True)
    ).to_be_visible()


def test_a_measurement_of_the_equipment_is_recorded_and_retired(
    experimenter: Experimenter,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """The newest equipment measurement is marked; a retired one stays listed with its reason."""
    page = experimenter.page
    page.get_by_role("link", name="Equipment").click()
    for delay in ("41.3", "44.8"):
        experimenter.press("Add a measurement")
        dialog = page.get_by_role("dialog")
        dialog.get_by_label("Equipment").fill("Vive Pro 2, desk 3")
        dialog.get_by_label("Motion-to-photon latency").fill(delay)
        dialog.get_by_label("SD").fill("2.7")
        dialog.get_by_label("Measurements").fill("40")
        dialog.get_by_label("Method").fill("High-speed camera at 240 Hz")
        dialog.get_by_role("button", name="Save measurement").click()
        expect(dialog).to_have_count(0)
    expect(page.get_by_role("row", name="44.8 ms")).to_contain_text("Newest")
    page.get_by_role("row", name="44.8 ms").get_by_role("button", name="Retire").click()
    page.get_by_label("What was wrong with it?").fill("Wrong frame rate")
    page.get_by_role("dialog").get_by_role("button", name="Retire").click()
    expect(page.get_by_role("row", name="44.8 ms")).to_contain_text("Wrong frame rate")
    expect(page.get_by_role("row", name="41.3 ms")).to_contain_text("Newest")
    assert axe(page) == []
    screenshot(page, "equipment")


def test_differing_heights_are_questioned(
    experimenter: Experimenter, running_server: LiveServer
) -> None:
    """Heights that differ by more than 10 cm must be confirmed once, then are saved as entered."""
    with running_server.client() as api:
        ok(api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        session = session_at(api, "height")["id"]
    page = experimenter.page
    page.goto(f"{running_server.url}/#/sessions/{session}")
    page.get_by_label("Stated height").fill("172")
    page.get_by_label("Matched height").fill("152")
    experimenter.press("Save heights")
    expect(page.get_by_text("Is that right?")).to_be_visible()
    expect(page.get_by_text("differ by 20 cm")).to_be_visible()
    page.get_by_label("Matched height").fill("160")
    experimenter.press("Save heights")
    expect(page.get_by_text("differ by 12 cm")).to_be_visible()
    experimenter.press("Both are right: save")
    expect(page.get_by_role("heading", name="Entering the body").first).to_be_visible()
