"""Browser tests of every page of the console and the tablet, in all sizes and themes."""

from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Page, expect
from sqlalchemy import select

from app.database import open_database
from app.models import Phase
from tests.e2e.people import PATIENCE_MS, Experimenter, Participant
from tests.features.builders import STUDY, SessionSpec, build_session
from tests.features.latency_builders import HISTORY_S, measured, store_movement
from tests.support.browser import PageWatch, in_both_schemes
from tests.support.server import LiveServer
from tests.support.traffic import Traffic

TABS = ("", "ledger", "sessions", "participants", "dashboard", "export", "protocol")
REPLAYED_S = 3.0
BELOW_THE_WINDOW_PX = (
    "document.documentElement.scrollHeight - document.documentElement.clientHeight"
)


@pytest.fixture(scope="module")
def played_server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    """Provide a server with a simulated participant's session that has one phase of movement."""
    with LiveServer(tmp_path_factory.mktemp("played")) as server:
        database = open_database(f"sqlite:///{server.data_dir / 'reembody.sqlite'}")
        with database.writing() as db:
            session = build_session(db, SessionSpec("SIM-0001", kind="simulated"))
            of_session = select(Phase).where(Phase.session_id == session.id)
            phases = db.scalars(of_session.order_by(Phase.phase_id)).all()
            for phase in phases:
                # There is too little movement in free movement, which is reported in words.
                achieved_s = phase.latency_ms / 1000.0 + 0.02 if phase.limb else None
                db.add(measured(phase, achieved_s))
            replayed = next(phase for phase in phases if phase.limb == "hand")
            replayed.active_s = REPLAYED_S
            clock_s = (replayed.client_started_s or 0.0) - HISTORY_S
            latency_s = replayed.latency_ms / 1000.0
            store_movement(db, replayed, latency_s, duration_s=REPLAYED_S, clock_s=clock_s)
        database.close()
        yield server


def test_every_console_page_is_accessible(
    played_server: LiveServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """No page of the console has a serious accessibility violation or an error in its log.

    A session and its replay fill the window and scroll inside it: nothing empty is below them.
    """
    page = page_factory((1280, 800))
    traffic = Traffic(page)

    def is_sound(name: str) -> None:
        for scheme in in_both_schemes(page):
            assert axe(page) == [], (name, scheme)
            screenshot(page, f"console-{name}-{scheme}")

    page.goto(played_server.url)
    expect(page.get_by_role("heading", name="Sign in")).to_be_visible()
    is_sound("login")
    experimenter = Experimenter(page, played_server.url)
    experimenter.log_in()
    is_sound("studies")
    for tab in TABS:
        experimenter.open_tab(STUDY, tab)
        if tab in ("dashboard", "sessions", "ledger"):
            page.get_by_text("Simulated", exact=True).first.click()
        if tab == "dashboard":
            plot = page.locator(".js-plotly-plot").first
            expect(plot).to_be_visible(timeout=PATIENCE_MS)
        traffic.settle()
        is_sound(tab or "overview")
    experimenter.open_tab(STUDY, "sessions")
    page.get_by_text("Simulated", exact=True).first.click()
    page.get_by_text("SIM-0001").first.click()
    expect(page.get_by_text("Session completed")).to_be_visible(timeout=PATIENCE_MS)
    is_sound("session")
    assert page.evaluate(BELOW_THE_WINDOW_PX) == 0
    page.get_by_role("link", name="Replay Hand task").first.click()
    expect(page.locator("[data-way=space]")).to_be_visible(timeout=PATIENCE_MS)
    page.keyboard.press("L")
    is_sound("replay")
    assert page.evaluate(BELOW_THE_WINDOW_PX) == 0


@pytest.mark.parametrize("size", [(1180, 820), (820, 1180)])
def test_the_tablet_is_accessible(
    running_server: LiveServer,
    page_factory: Callable[..., Page],
    page_watch: PageWatch,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    size: tuple[int, int],
) -> None:
    """Pairing, consent and a form have no serious violation, in both orientations and languages."""
    page_watch.allow(r"status of 401")
    console = Experimenter(page_factory((1280, 800), "dark"), running_server.url)
    tablet = Participant(page_factory(size), running_server.url)
    tablet.page.goto(f"{running_server.url}/tablet")
    expect(tablet.page.get_by_role("heading", name="Connect this tablet")).to_be_visible()
    assert axe(tablet.page) == []
    screenshot(tablet.page, f"tablet-pairing-{size[0]}")
    console.log_in()
    console.open_tab(STUDY)
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
