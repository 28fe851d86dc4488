"""Every page of the console and the tablet, in both sizes and themes, on a real server."""

import os
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter, Participant
from tests.rehearsal.performed import Lengths
from tests.support.browser import ColorScheme, PageWatch
from tests.support.nursery import Wish, nursery
from tests.support.server import LiveServer
from tests.support.traffic import Traffic

LENGTHS = Lengths(15.0, 15.0)
"""Of the phases: pages look alike after a session of any length."""
TABS = ("", "ledger", "sessions", "participants", "dashboard", "export", "protocol")


@pytest.fixture(scope="module")
def played_server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    """A server on which a simulated participant has been through a session."""
    with LiveServer(tmp_path_factory.mktemp("played")) as server:
        LENGTHS.store(server)
        environment = {**os.environ, "REEMBODY_DATA_DIR": str(server.data_dir)}
        said = tmp_path_factory.mktemp("commands") / "said.txt"

        def run(*arguments: str) -> str:
            child = nursery().start(Wish(arguments, environment, said.parent, said))
            assert child.wait(240) == 0, said.read_text()
            return said.read_text()

        token = run("token").strip()
        study = ("--study", LENGTHS.key)
        run("rehearse", "--url", server.url, "--token", token, "--speed", "60", *study)
        yield server


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_every_console_page_is_accessible(
    played_server: LiveServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    scheme: ColorScheme,
) -> None:
    """Nothing serious or critical on any page of the console, and no error in its log."""
    page = page_factory((1280, 800), scheme)
    traffic = Traffic(page)
    page.goto(played_server.url)
    expect(page.get_by_role("heading", name="Sign in")).to_be_visible()
    assert axe(page) == []
    screenshot(page, f"console-login-{scheme}")
    experimenter = Experimenter(page, played_server.url)
    experimenter.log_in()
    assert axe(page) == []
    screenshot(page, f"console-studies-{scheme}")
    for tab in TABS:
        experimenter.open_tab(LENGTHS.key, tab)
        if tab in ("dashboard", "sessions", "ledger"):
            page.get_by_text("Simulated", exact=True).first.click()
        if tab == "dashboard":
            plot = page.locator(".js-plotly-plot").first
            expect(plot).to_be_visible(timeout=PATIENCE_MS)
        traffic.settle()
        assert axe(page) == [], tab
        screenshot(page, f"console-{tab or 'overview'}-{scheme}")
    experimenter.open_tab(LENGTHS.key, "sessions")
    page.get_by_text("Simulated", exact=True).first.click()
    page.get_by_text("SIM-0001").first.click()
    expect(page.get_by_text("Session completed")).to_be_visible(timeout=PATIENCE_MS)
    assert axe(page) == []
    screenshot(page, f"console-session-{scheme}")
    page.get_by_role("link", name="Replay Hand task").first.click()
    expect(page.locator("[data-way=space]")).to_be_visible(timeout=PATIENCE_MS)
    page.keyboard.press("L")
    assert axe(page) == []
    screenshot(page, f"console-replay-{scheme}")


@pytest.mark.parametrize("size", [(1180, 820), (820, 1180)])
def test_the_tablet_is_accessible(
    running_server: LiveServer,
    page_factory: Callable[..., Page],
    page_watch: PageWatch,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    size: tuple[int, int],
) -> None:
    """Pairing, consent, a form: nothing serious, in both orientations, and in German."""
    page_watch.allow(r"status of 401")
    console = Experimenter(page_factory((1280, 800), "dark"), running_server.url)
    tablet = Participant(page_factory(size), running_server.url)
    tablet.page.goto(f"{running_server.url}/tablet")
    expect(tablet.page.get_by_role("heading", name="Connect this tablet")).to_be_visible()
    assert axe(tablet.page) == []
    screenshot(tablet.page, f"tablet-pairing-{size[0]}")
    console.log_in()
    console.open_tab("reembodiment-latency")
    console.create_session()
    tablet.pair(console.code_for("tablet"))
    console.start()
    expect(tablet.page.get_by_role("heading", name="Consent")).to_be_visible(timeout=PATIENCE_MS)
    assert axe(tablet.page) == []
    screenshot(tablet.page, f"tablet-consent-{size[0]}")
    tablet.agree()
    expect(tablet.page.get_by_text("How old are you?")).to_be_visible(timeout=PATIENCE_MS)
    assert axe(tablet.page) == []
    tablet.page.get_by_text("Deutsch").click()
    expect(tablet.page.get_by_text("Wie alt sind Sie?")).to_be_visible()
    screenshot(tablet.page, f"tablet-form-{size[0]}")
    assert axe(console.page) == []
