"""Browser test of importing answers from another tool, and of the preregistration page."""

from collections.abc import Callable
from pathlib import Path

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


def test_a_file_is_mapped_checked_and_imported(
    shared_server: LiveServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    tmp_path: Path,
) -> None:
    """A file with a word in place of a number is imported only after the number is entered."""
    file = tmp_path / "answers.csv"
    file.write_text(FILE, encoding="utf-8")
    page = page_factory()
    experimenter = Experimenter(page, shared_server.url)
    experimenter.log_in()
    experimenter.open_tab(STUDY, "preregistration")
    expect(page.get_by_text("Not preregistered")).to_be_visible()
    experimenter.open_tab(STUDY, "export")
    page.get_by_role("button", name="Import answers").click()
    page.locator("input[type=file]").set_input_files(file)
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
