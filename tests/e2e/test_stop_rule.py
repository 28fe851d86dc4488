"""Browser tests of the stop rule: the tablet, the console and the two ways to proceed."""

import uuid
from collections.abc import Callable

import httpx2
import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import Experimenter, Participant
from tests.features.lab import Json, ok
from tests.protocol.options import KEY, with_options
from tests.support.browser import PageWatch
from tests.support.server import ADMIN_PASSWORD, LiveServer

WAIT = "Please wait, the experimenter is coming"
HELD = "Stop: check on the participant"


def session_at(api: httpx2.Client, step_key: str) -> Json:
    """Create a session at a step by skipping the earlier ones."""
    view: Json = ok(api.post(f"/api/studies/{KEY}/sessions", json={}))
    view = command(api, view, "start")
    while view["steps"][view["current"]["index"]]["key"] != step_key:
        view = command(api, view, "skip", reason="not in this test")
    return view


def command(api: httpx2.Client, view: Json, kind: str, **fields: object) -> Json:
    """Send a command based on this view of the session."""
    body = {"command_id": str(uuid.uuid4()), "expected_version": view["version"], "type": kind}
    after: Json = ok(api.post(f"/api/sessions/{view['id']}/commands", json={**body, **fields}))
    return after


@pytest.fixture
def pages(
    running_server: LiveServer, page_factory: Callable[..., Page], page_watch: PageWatch
) -> tuple[Experimenter, Participant, str]:
    """Provide console and tablet of a session in which the sickness scale is due."""
    page_watch.allow(r"status of 401")
    with running_server.client() as api:
        ok(api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        if api.get(f"/api/studies/{KEY}").status_code == 404:
            ok(api.post("/api/studies", json={"yaml": with_options()}))
        session = session_at(api, "block1.fms")["id"]
    experimenter = Experimenter(page_factory((1280, 800)), running_server.url)
    participant = Participant(page_factory((1180, 820)), running_server.url)
    experimenter.log_in()
    experimenter.page.goto(f"{running_server.url}/#/sessions/{session}")
    participant.pair(experimenter.code_for("tablet"))
    participant.page.locator("[data-name]").first.wait_for()
    return experimenter, participant, session


def test_the_session_is_held_until_the_experimenter_decides(
    pages: tuple[Experimenter, Participant, str],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """A met stop rule raises an alarm and blocks the session until the experimenter gives a reason.

    The tablet only asks the participant to wait.
    """
    experimenter, participant, _ = pages
    console, tablet = experimenter.page, participant.page
    participant.fill_in({"sickness": "18"})
    expect(tablet.get_by_role("heading", name=WAIT)).to_be_visible()
    expect(console.get_by_role("heading", name=HELD)).to_be_visible()
    expect(console.get_by_text("is at or above the limit of 15")).to_be_visible()
    assert console.title().startswith("▲ Stop rule met")
    assert axe(console) == []
    assert axe(tablet) == []
    screenshot(console, "stop-rule-console")
    screenshot(tablet, "stop-rule-tablet")
    experimenter.press("Continue with a reason")
    dialog = console.get_by_role("dialog")
    dialog.get_by_text("Recovered after a break, wants to continue").click()
    dialog.get_by_role("button", name="Continue with a reason").click()
    expect(console.get_by_role("heading", name=HELD)).to_have_count(0)
    expect(console.get_by_role("button", name="Begin hand task")).to_be_visible()
    expect(tablet.get_by_role("heading", name=WAIT)).to_have_count(0)


def test_a_held_session_can_be_ended(
    pages: tuple[Experimenter, Participant, str],
) -> None:
    """A session blocked by the stop rule can be ended for it; the tablet thanks the participant."""
    experimenter, participant, _ = pages
    console = experimenter.page
    participant.fill_in({"sickness": "20"})
    experimenter.press("End the session")
    dialog = console.get_by_role("dialog")
    dialog.get_by_text("Stop rule: sickness").click()
    dialog.get_by_role("button").last.click()
    experimenter.sees_step("Session aborted")
    expect(participant.page.get_by_role("heading", name="Thank you")).to_be_visible()


def test_a_warning_stops_nothing(
    pages: tuple[Experimenter, Participant, str],
) -> None:
    """A score between the two limits warns the operator and does not block the session."""
    experimenter, participant, _ = pages
    participant.fill_in({"sickness": "12"})
    console = experimenter.page
    expect(console.get_by_text("Sickness is rising").first).to_be_visible()
    expect(console.get_by_role("button", name="Begin hand task")).to_be_visible()
