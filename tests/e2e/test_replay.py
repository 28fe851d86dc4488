"""Browser test of replaying a phase: by keyboard, by a link, and two phases side by side."""

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect
from sqlalchemy import select

from app.models import Phase
from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.features.builders import SessionSpec, as_physics, build_session
from tests.features.latency_builders import HISTORY_S, store_movement
from tests.features.record.headset.site import Site

DURATION_S = 12.0
EBML = b"\x1a\x45\xdf\xa3"
"""How every WebM file begins (RFC 8794, section 11.2.1)."""


@pytest.fixture
def phases(headset_site: Site) -> list[Phase]:
    """Provide two hand phases of a completed session, each with twelve seconds of movement."""
    with headset_site.database.writing() as db:
        session = build_session(db, SessionSpec("P-replay"))
        as_physics(db, session)
        found = db.scalars(
            select(Phase)
            .where(Phase.session_id == session.id, Phase.limb == "hand")
            .order_by(Phase.phase_id)
        ).all()[:2]
        for epoch, phase in enumerate(found, start=1):
            phase.active_s = DURATION_S
            clock_s = (phase.client_started_s or 0.0) - HISTORY_S
            latency_s = phase.latency_ms / 1000.0
            store_movement(
                db, phase, latency_s, duration_s=DURATION_S, epoch=epoch, clock_s=clock_s
            )
        return list(found)


def test_a_replay_is_synchronised_with_its_events(
    headset_site: Site,
    phases: list[Phase],
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """A replay wears its body, remembers its camera, reopens at a moment by link, is filmed."""
    first, second = phases
    url = headset_site.server.url
    page = page_factory()
    Experimenter(page, url).log_in()
    page.goto(f"{url}/#/sessions/{first.session_id}")
    page.get_by_role("link", name="Replay Hand task").first.click()
    expect(page.locator("[data-way=space]")).to_be_visible(timeout=PATIENCE_MS)
    expect(page.locator("[data-drawn=skin]")).to_be_visible(timeout=PATIENCE_MS)
    times = page.locator("[data-time]")
    expect(times).to_have_attribute("data-time", "0.000")
    for key, time in (("L", "1.000"), (".", "1.033"), ("ArrowRight", "2.033"), ("]", "5.000")):
        page.keyboard.press(key)
        expect(times).to_have_attribute("data-time", time)
    expect(page.locator("[aria-current=time]")).to_contain_text("Panel of box 1")
    expect(page.locator("canvas")).to_have_attribute("data-frame", "150")
    page.get_by_role("button", name=re.compile("Task 1 completed")).click()
    expect(times).to_have_attribute("data-time", "10.000")
    page.keyboard.press("Space")
    expect(page.get_by_role("button", name="Pause (space)")).to_be_visible()
    expect(times).not_to_have_attribute("data-time", "10.000")
    page.keyboard.press("Space")
    cameras = page.get_by_role("radiogroup", name="Camera")
    page.keyboard.press("C")
    page.keyboard.press("C")
    expect(cameras.get_by_role("radio", name="Eyes")).to_be_checked()
    screenshot(page, "replay-first-person")
    page.reload()
    expect(cameras.get_by_role("radio", name="Eyes")).to_be_checked(timeout=PATIENCE_MS)
    page.keyboard.press("C")
    expect(cameras.get_by_role("radio", name="Free")).to_be_checked()
    page.get_by_role("tab", name="Answers after this phase").click()
    expect(page.get_by_role("tabpanel").get_by_role("heading").first).to_be_visible()
    page.get_by_text("Stick figure", exact=True).click()
    expect(page.locator("[data-drawn=skeleton]")).to_be_visible()
    page.get_by_text("Body", exact=True).click()
    page.goto(
        f"{url}/#/sessions/{first.session_id}/replay?phase={first.phase_id}&t=3.5&with={second.phase_id}"
    )
    expect(page.locator("canvas")).to_have_count(2, timeout=PATIENCE_MS)
    expect(page.locator("[data-drawn=skin]")).to_have_count(2, timeout=PATIENCE_MS)
    expect(times).to_have_attribute("data-time", "3.500")
    for canvas in page.locator("canvas").all():
        expect(canvas).to_have_attribute("data-frame", "105")
    assert axe(page) == []
    with page.expect_download(timeout=PATIENCE_MS) as film:
        page.get_by_role("button", name="Record a video from this moment").click()
        expect(page.get_by_role("button", name="Stop and save")).to_be_visible()
        expect(times).not_to_have_attribute("data-time", "3.500")
        page.keyboard.press("End")
    assert film.value.suggested_filename.endswith(".webm")
    assert film.value.path().read_bytes().startswith(EBML)
