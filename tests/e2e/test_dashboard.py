"""Browser tests of figures and statistical tests, which a URL filters and files save."""

import re
from collections.abc import Callable

from playwright.sync_api import Page, expect

from app.database import open_database
from app.features.design.studies import add_version, study_by_key
from app.protocol.plan import Step
from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.features.builders import NOW, STUDY, SessionSpec, build_session
from tests.protocol.helpers import STUDY as FILE
from tests.protocol.test_preregistration import SECTION
from tests.support.server import LiveServer


def _falling(lower: int) -> Callable[[Step, str], int]:
    """Return the ratings of somebody: they fall with the added latency, from 6 - `lower`."""
    return lambda step, _: 6 - lower - int((step.latency_ms or 0.0) / 100.0)


COLLAPSED_PX = 3000


def _everything_is_a_click_away(page: Page) -> None:
    """Check that the collapsed page is short, one click opens any measure, and paper has it all."""
    results = page.locator("details article")
    assert results.count() > 0
    assert page.evaluate("document.documentElement.scrollHeight") <= COLLAPSED_PX
    assert not any(result.is_visible() for result in results.all())
    page.emulate_media(media="print")
    hidden = [result.inner_text() for result in results.all() if not result.is_visible()]
    methods = page.locator("details details p")
    assert hidden == []
    assert all(method.is_visible() for method in methods.all())
    page.emulate_media(media="screen")
    for card in page.locator("main details:has(> summary h3)").all():
        card.locator("summary").first.click()
        inside = card.locator("article")
        assert all(result.is_visible() for result in inside.all())
        card.locator("summary").first.click()
    page.evaluate("scrollTo(0, 0)")


def _the_main_figures_stand_in_the_window(page: Page) -> None:
    """Below the summary, four drawn figures end above the window's lower edge."""
    main = page.get_by_role("figure").filter(has_text="by added latency").all()[:4]
    assert [one.locator(".js-plotly-plot").count() for one in main] == [1] * 4
    boxes = [one.bounding_box() for one in main]
    height = page.evaluate("innerHeight")
    assert max(box["y"] + box["height"] for box in boxes if box is not None) <= height


def test_figures_are_filtered_by_the_url_and_saved(
    live_server: LiveServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """A filter in the URL selects the figures, which can be saved as pictures and as rows.

    Statistics, the preregistration and the summary then show the same kind of data.
    """
    database = open_database(f"sqlite:///{live_server.data_dir / 'reembody.sqlite'}")
    with database.writing() as db:
        add_version(db, study_by_key(db, STUDY), FILE + SECTION, NOW)
        for at in range(3):
            code = f"SIM-{at:04d}"
            build_session(db, SessionSpec(code, kind="simulated", likert=_falling(at % 2)))
    database.close()
    page = page_factory((1280, 800))
    Experimenter(page, live_server.url).log_in()
    # As a link to the page in another tab has it; the page then has it before its `#`.
    page.goto(f"{live_server.url}/#/studies/{STUDY}/dashboard?kind=simulated&participant=SIM-0001")
    expect(page.get_by_text("from 1 valid session")).to_be_visible(timeout=PATIENCE_MS)
    expect(page).to_have_url(re.compile(rf"\?kind=simulated&participant=SIM-0001#.*/{STUDY}/"))
    agency = page.get_by_role("figure").filter(has_text="Agency by added latency")
    expect(agency.locator(".js-plotly-plot")).to_be_visible(timeout=PATIENCE_MS)
    expect(agency).to_contain_text("Only participants SIM-0001")
    with page.expect_download() as picture:
        agency.get_by_role("button", name="PNG", exact=True).click()
    assert picture.value.path().read_bytes().startswith(b"\x89PNG")
    with page.expect_download() as rows:
        agency.get_by_role("button", name="CSV", exact=True).click()
    text = rows.value.path().read_text()
    assert "SIMULATED DATA" in text
    assert "SIM-0002" not in text
    page.get_by_role("button", name="Clear", exact=True).click()
    page.get_by_role("button", name="Filter", exact=True).click()
    expect(page.get_by_text("from 3 valid sessions")).to_be_visible(timeout=PATIENCE_MS)
    _the_main_figures_stand_in_the_window(page)

    page.get_by_role("link", name="Statistics", exact=True).click()
    # Participants are of one page, the kind of data is of all of them, also when it is reloaded.
    expect(page).not_to_have_url(re.compile("participant="))
    page.reload()
    expect(page.get_by_role("heading", name="Agency", exact=True)).to_be_visible(
        timeout=PATIENCE_MS
    )
    _everything_is_a_click_away(page)
    assert axe(page) == []
    screenshot(page, "statistics")
    page.emulate_media(color_scheme="dark")
    assert axe(page) == []
    screenshot(page, "statistics-dark")
    glance = page.get_by_role("region", name="At a glance")
    agency_row = glance.get_by_role("row").filter(has=page.get_by_role("button", name="Agency"))
    expect(agency_row).to_contain_text("p = .005 (falls)")
    agency_row.get_by_role("button").click()
    expect(page.get_by_role("heading", name="Agency", exact=True)).to_be_in_viewport()
    opened = page.locator("details[open]")
    expect(opened.get_by_text("Too few participants for any result").first).to_be_visible()

    page.get_by_role("link", name="Preregistration", exact=True).click()
    expect(page.get_by_text("n = 3 of 12 planned")).to_be_visible(timeout=PATIENCE_MS)
    expect(page.get_by_text("Fewer than 60 frames per second")).to_be_visible()
    assert axe(page) == []
    page.emulate_media(color_scheme="light")
    assert axe(page) == []
    screenshot(page, "preregistration")

    page.get_by_role("link", name="Summary", exact=True).click()
    expect(page.get_by_role("heading", name="Deviations")).to_be_visible(timeout=PATIENCE_MS)
    expect(page.get_by_role("region", name="Summary")).to_contain_text("3 of 12 planned")
    glance = page.get_by_role("region", name="At a glance")
    glance.get_by_role("button", name="Agency").click()
    expect(page.get_by_role("heading", name="Agency", exact=True)).to_be_in_viewport(
        timeout=PATIENCE_MS
    )
    expect(page.locator("details[open]").first).to_be_visible()
