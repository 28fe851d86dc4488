"""Browser tests of the help pages: by keyboard alone, in both themes and languages."""

from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.support.browser import in_both_schemes
from tests.support.server import LiveServer


def test_help_is_opened_and_searched_by_keyboard(
    running_server: LiveServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """The key `?` opens the help for the current page, and a search result leads to a heading.

    Pictures, tables and links of the Markdown are shown, and all text is accessible.
    """
    page = page_factory((1280, 800))
    experimenter = Experimenter(page, running_server.url)
    experimenter.log_in()

    def is_sound(name: str) -> None:
        for scheme in in_both_schemes(page):
            assert axe(page) == [], (name, scheme)
            screenshot(page, f"help-{name}-{scheme}")

    page.keyboard.press("?")
    expect(page.get_by_role("heading", name="The operator's tour", level=1)).to_be_visible(
        timeout=PATIENCE_MS
    )
    picture = page.get_by_role("img", name="The cockpit")
    picture.scroll_into_view_if_needed()
    expect(picture).to_have_js_property("complete", value=True)
    assert picture.evaluate("image => image.naturalWidth") > 0
    page.evaluate("scrollTo(0, 0)")
    is_sound("tour")

    page.goto(f"{running_server.url}/#/storage")
    expect(page.get_by_role("heading", name="Storage", level=1)).to_be_visible()
    page.keyboard.press("?")
    expect(page.get_by_role("heading", name="Backups", level=1)).to_be_visible()

    page.keyboard.press("/")
    page.keyboard.type("glossary session")
    expect(page.get_by_role("status").get_by_text("1 heading found")).to_be_visible()
    is_sound("search")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    heading = page.get_by_role("heading", name="The session", level=2)
    expect(heading).to_be_focused()
    expect(page.get_by_role("table").filter(has_text="Sitzung").first).to_be_visible()
    is_sound("glossary")

    page.get_by_role("article").get_by_role("link", name="table or column").click()
    expect(page.get_by_role("heading", name="Data dictionary", level=1)).to_be_visible()
    page.set_viewport_size({"width": 820, "height": 1180})
    is_sound("dictionary-820")


def test_the_help_menu_is_german(
    running_server: LiveServer, page_factory: Callable[..., Page]
) -> None:
    """The help menu opens the English help pages, with German controls and a note."""
    page = page_factory((1280, 800))
    experimenter = Experimenter(page, running_server.url)
    experimenter.log_in()
    experimenter.choose_german()
    page.get_by_role("button", name="Hilfe").click()
    page.get_by_role("menuitem", name="Hilfeseiten").click()
    expect(page.get_by_text("Die Hilfeseiten gibt es nur auf Englisch.")).to_be_visible()
    expect(page.get_by_role("searchbox", name="Überschriften durchsuchen")).to_be_visible()
    page.goto(f"{running_server.url}/#/help/nothing")
    expect(page.get_by_text("Diese Hilfeseite gibt es nicht")).to_be_visible()
