"""Browser test of importing answers from another tool, and of the preregistration page."""

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import Experimenter
from tests.support.server import LiveServer

STUDY = "reembodiment-latency"
PEOPLE = ("A1", "A2", "A3")
FILE = "code;condition;fms\n" + "".join(
    f"{code};{ms} ms;{'none' if ms == 0 else n + ms // 50}\n"
    for n, code in enumerate(PEOPLE)
    for ms in (0, 125, 350)
)


@pytest.fixture
def importing(
    shared_server: LiveServer, page_factory: Callable[..., Page], tmp_path: Path
) -> Callable[[str, str], Page]:
    """Provide `importing(name, text)`: the page after that file was chosen for import."""

    def chosen(name: str, text: str) -> Page:
        file = tmp_path / name
        file.write_text(text, encoding="utf-8")
        page = page_factory()
        experimenter = Experimenter(page, shared_server.url)
        experimenter.log_in()
        experimenter.open_tab(STUDY, "preregistration")
        expect(page.get_by_text("Not preregistered")).to_be_visible()
        experimenter.open_tab(STUDY, "export")
        page.get_by_role("button", name="Import answers").click()
        page.locator("input[type=file]").set_input_files(file)
        return page

    return chosen


def test_a_file_is_mapped_checked_and_imported(
    importing: Callable[[str, str], Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """A file with a word in place of a number is imported only after the number is entered."""
    page = importing("answers.csv", FILE)
    expect(page.get_by_text("Cells that do not fit: 3").first).to_be_visible()
    assert axe(page) == []
    page.get_by_label("Number for “none”").fill("0")
    page.keyboard.press("Tab")
    page.get_by_role("button", name="Import 9 forms").click()
    expect(page.get_by_text("Imported, not measured here")).to_be_visible(timeout=20_000)
    expect(page.get_by_role("row", name="latency_350 3 8")).to_be_visible()
    assert axe(page) == []
    screenshot(page, "imported")
    page.emulate_media(color_scheme="dark")
    assert axe(page) == []


def test_a_foreign_file_shows_what_is_doubtful_and_why_columns_are_left_out(
    importing: Callable[[str, str], Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """Doubts about a guessed scale, and reasons against columns, stand in the page."""
    rows = [
        f"B{n};{n % 2};{(n + 1) % 2};{n % 2};{('maybe', 'seldom')[n % 2]};{13 * n + 21};note {n}"
        for n in range(12)
    ]
    head = "participant;own1;own2;own3;mood;weight;remarks"
    page = importing("foreign.csv", "\n".join([head, *rows]))
    expect(page.get_by_text("Only 0 and 1 were seen: answers of yes or no")).to_be_visible()
    expect(page.get_by_role("listitem").filter(has_text="mood")).to_contain_text("(12): ")
    confirm = page.get_by_role("checkbox", name="The questionnaire's scale is 0 to 1")
    expect(confirm).not_to_be_checked()
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        confirm.scroll_into_view_if_needed()
        assert axe(page) == []
        screenshot(page, f"foreign answers {scheme}")
    confirm.check()
    expect(confirm).to_be_checked()
    screenshot(page, "foreign answers confirmed dark")
