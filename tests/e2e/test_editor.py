"""Browser tests of writing a study and an instrument in the console, on a real server."""

from collections.abc import Callable

import pytest
import yaml
from playwright.sync_api import Page, expect

from tests.e2e.people import Experimenter
from tests.features.design.instruments.test_library import OWN
from tests.support.browser import ColorScheme, in_both_schemes
from tests.support.server import ADMIN_PASSWORD, LiveServer
from tests.support.traffic import Traffic

STUDY = "reembodiment-latency"


class Writer(Experimenter):
    """An author of studies who works at the console."""

    @property
    def text(self) -> str:
        """Return the visible YAML of the text field."""
        return str(self.page.locator(".cm-content").inner_text())

    def open_section(self, name: str) -> None:
        """Open a section of the form."""
        self.page.get_by_role("tab", name=name, exact=False).first.click()

    def replace_all(self, text: str) -> None:
        """Replace the whole text of the file."""
        self.page.locator(".cm-content").click()
        self.page.keyboard.press("Control+A")
        self.page.keyboard.insert_text(text)

    def sees_no_problem(self) -> None:
        """Wait until the file was checked without problems and the page is idle."""
        expect(self.page.get_by_text("No problems")).to_be_visible()
        self.page.wait_for_load_state("networkidle")
        self.page.wait_for_timeout(300)


@pytest.fixture
def writer(live_server: LiveServer, page_factory: Callable[..., Page]) -> Writer:
    """Provide a signed-in author on the list of studies."""
    writer = Writer(page_factory((1280, 800)), live_server.url)
    writer.log_in()
    return writer


def test_a_study_from_template_to_second_version(
    writer: Writer, axe: Callable[[Page], list[str]], screenshot: Callable[[Page, str], object]
) -> None:
    """A study is created from a template, corrected, tested in a dry run, saved and changed.

    A problem links to its line, a change can be undone, and versions can be compared.
    """
    page = writer.page
    page.get_by_role("link", name="New study").click()
    expect(page.get_by_role("heading", name="From a template")).to_be_visible()
    assert axe(page) == []
    page.get_by_role("link", name="Two latencies, hand task").click()
    writer.sees_no_problem()
    assert axe(page) == []
    page.get_by_label("Key", exact=True).first.fill("my-study")
    expect(page.locator(".cm-content")).to_contain_text("key: my-study")

    writer.open_section("Conditions")
    latency = page.get_by_label("Added latency (ms)").nth(1)
    latency.fill("-200")
    problem = page.get_by_role("button", name="conditions[1].latency_ms")
    expect(problem).to_contain_text("negative")
    expect(page.locator(".cm-lint-marker-error")).to_have_count(1)
    expect(page.get_by_role("button", name="Save the study")).to_be_disabled()
    problem.click()
    expect(page.locator(".cm-activeLine")).to_contain_text("latency_ms: -200")
    assert axe(page) == []
    screenshot(page, "editor-problem")
    page.get_by_role("button", name="Undo").click()
    writer.sees_no_problem()
    expect(latency).to_have_value("200")

    writer.open_section("Preregistration")
    page.get_by_role("button", name="Preregistration").click()
    expect(page.get_by_label("Planned participants")).to_have_value("12")
    writer.sees_no_problem()

    page.get_by_role("tab", name="Dry run").click()
    expect(page.get_by_role("row", name="Debriefing")).to_be_visible()
    expect(page.get_by_role("row", name="200 ms added").first).to_be_visible()
    expect(page.get_by_text("![hand_boxes]")).to_have_count(0)
    page.get_by_text("What happens").first.click()
    expect(page.get_by_role("heading", name="What happens")).to_be_visible()
    assert axe(page) == []
    screenshot(page, "editor-dry-run")

    page.get_by_role("button", name="Save the study").click()
    expect(page.get_by_text("Saved as version 1")).to_be_visible()
    expect(page.get_by_role("link", name="To its page, for a new session")).to_be_visible()
    expect(page.get_by_role("heading", name="Two latencies, hand task")).to_be_visible()
    writer.open_section("Conditions")
    page.get_by_label("Added latency (ms)").nth(1).fill("250")
    expect(page.get_by_text("Not saved yet")).to_be_visible()
    page.get_by_role("tab", name="What changes").click()
    expect(page.get_by_text("The balance is affected")).to_be_visible()
    expect(page.get_by_role("row", name="conditions[1].latency_ms")).to_contain_text("250")
    assert axe(page) == []
    screenshot(page, "editor-changes")
    page.get_by_role("button", name="Save as a version").click()
    expect(page.get_by_text("Saved as version 2")).to_be_visible()
    expect(page.get_by_text("As stored")).to_be_visible()
    expect(page.get_by_text("The content is the same")).to_be_visible()
    expect(page.get_by_text("The balance is affected")).to_have_count(0)

    writer.open_tab("my-study", "versions")
    expect(page.get_by_role("link", name="To its page, for a new session")).to_be_hidden()
    expect(page.get_by_role("row", name="conditions[1].latency_ms")).to_be_visible()
    assert axe(page) == []
    screenshot(page, "study-versions")


def test_the_curves_of_simulated_answers_are_edited_and_stored(
    writer: Writer,
    live_server: LiveServer,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """An item's curve is chosen, an unknown item is refused at its field, and a reload keeps it."""
    page = writer.page
    writer.open_tab(STUDY, "edit")
    writer.sees_no_problem()
    writer.open_section("Rehearsals")
    page.get_by_role("button", name="Simulated answers").click()
    page.get_by_role("combobox", name="Instrument to add").fill("karas2020")
    page.keyboard.press("Enter")
    for item in ("q9", "q99"):
        page.get_by_role("combobox", name="Item to add to karas2020").fill(item)
        page.keyboard.press("Enter")
    problem = page.get_by_role("button", name="simulation.aspects.karas2020.q99")
    expect(problem).to_contain_text("'karas2020' has no Likert item 'q99'")
    expect(page.get_by_role("button", name="Save as a version")).to_be_disabled()
    for scheme in in_both_schemes(page):
        assert axe(page) == [], scheme
        screenshot(page, f"editor-rehearsals-problem-{scheme}")
    page.get_by_role("button", name="Clear: q99").click()
    page.get_by_role("combobox", name="q9", exact=True).click()
    page.get_by_role("option", name="simultaneity").click()
    writer.sees_no_problem()
    page.set_viewport_size({"width": 1180, "height": 820})
    for scheme in in_both_schemes(page):
        assert axe(page) == [], scheme
        screenshot(page, f"editor-rehearsals-{scheme}")
    page.get_by_role("button", name="Save as a version").click()
    expect(page.get_by_text("Saved as version 2")).to_be_visible()
    page.reload()
    writer.open_section("Rehearsals")
    expect(page.get_by_role("combobox", name="q9")).to_have_value("simultaneity")
    assert axe(page) == []
    with live_server.client() as admin:
        admin.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD})
        stored = admin.get(f"/api/studies/{STUDY}").json()["yaml"]
    assert yaml.safe_load(stored)["simulation"] == {
        "aspects": {"karas2020": {"q9": "simultaneity"}}
    }


def test_unsaved_changes_are_not_lost(writer: Writer) -> None:
    """Leaving unsaved changes needs confirmation; on return they can be kept or discarded."""
    page = writer.page
    writer.open_tab(STUDY, "edit")
    writer.sees_no_problem()
    page.get_by_label("Title, English").fill("Another title")
    expect(page.locator(".cm-content")).to_contain_text("en: Another title")
    page.get_by_role("link", name="Instruments").click()
    expect(page.get_by_role("dialog", name="Leave without saving?")).to_be_visible()
    page.get_by_role("button", name="Leave", exact=True).click()
    expect(page.get_by_role("heading", name="Instruments")).to_be_visible()
    writer.open_tab(STUDY, "edit")
    expect(page.locator(".cm-content")).to_contain_text("en: Another title")
    page.get_by_role("button", name="Discard them").click()
    expect(page.locator(".cm-content")).to_contain_text("en: Acting through another body")


def test_the_draft_of_a_new_study_is_kept_until_it_is_discarded(
    writer: Writer, axe: Callable[[Page], list[str]], screenshot: Callable[[Page, str], object]
) -> None:
    """An unsaved new study can be continued, and no template replaces it without a word."""
    page = writer.page
    template = page.get_by_role("link", name="Two latencies, hand task")
    page.get_by_role("link", name="New study").click()
    template.click()
    writer.sees_no_problem()
    page.get_by_label("Key", exact=True).first.fill("kept-study")
    expect(page.locator(".cm-content")).to_contain_text("key: kept-study")
    page.get_by_role("link", name="Storage").click()
    page.get_by_role("button", name="Leave", exact=True).click()
    page.goto(f"{writer.url}/#/new")
    expect(page.get_by_text("Continue your draft")).to_be_visible()
    expect(page.get_by_text("Two latencies, hand task (kept-study), changed")).to_be_visible()
    assert axe(page) == []
    screenshot(page, "new-study-draft")
    template.click()
    discard = page.get_by_role("button", name="Discard it and open “Two latencies, hand task”")
    expect(discard).to_be_visible()
    assert axe(page) == []
    page.get_by_role("link", name="Continue", exact=True).click()
    expect(page.locator(".cm-content")).to_contain_text("key: kept-study")
    page.reload()
    expect(page.locator(".cm-content")).to_contain_text("key: kept-study")
    page.goto(f"{writer.url}/#/new/template/two-latencies-hand")
    discard.click()
    expect(page.locator(".cm-content")).not_to_contain_text("key: kept-study")
    page.goto(f"{writer.url}/#/new")
    expect(page.get_by_role("heading", name="From a template")).to_be_visible()
    expect(page.get_by_text("Continue your draft")).to_have_count(0)


def test_an_archived_study_comes_back(writer: Writer) -> None:
    """An archived study disappears from the list after confirmation and can be restored."""
    page = writer.page
    writer.open_tab(STUDY, "versions")
    page.get_by_role("button", name="Archive").click()
    page.get_by_role("dialog").get_by_role("button", name="Archive").click()
    expect(page.get_by_text("Archived: no new sessions")).to_be_visible()
    page.get_by_role("link", name="Studies").click()
    expect(page.get_by_role("heading", name="No studies yet")).to_be_visible()
    page.get_by_role("button", name="Archived studies").click()
    page.get_by_role("link", name="Acting through another body").click()
    page.get_by_role("button", name="Restore").click()
    expect(page.get_by_text("Archived: no new sessions")).to_have_count(0)


def test_an_own_instrument_is_written_tried_and_stored(
    writer: Writer, axe: Callable[[Page], list[str]], screenshot: Callable[[Page, str], object]
) -> None:
    """A mistake in a formula is shown at its line, and the preview scores by the formula."""
    page = writer.page
    page.get_by_role("link", name="Instruments").click()
    expect(page.get_by_role("link", name="Presence (IPQ)")).to_be_visible()
    assert axe(page) == []
    page.get_by_role("link", name="New instrument").click()
    writer.replace_all(OWN.replace("(calm - tense)", "(calm - tens)"))
    expect(page.get_by_role("button", name="scores[0].formula")).to_contain_text("tens")
    writer.replace_all(OWN)
    writer.sees_no_problem()
    page.locator('[data-name="calm"] input').nth(4).check(force=True)
    page.locator('[data-name="tense"] input').nth(0).check(force=True)
    scores = page.get_by_role("region", name="Scores so far")
    expect(scores.get_by_role("row", name="Ease")).to_contain_text("(2 - (-2)) / 2")
    expect(scores.get_by_role("row", name="Twice")).to_contain_text("4")
    assert axe(page) == []
    screenshot(page, "instrument-editor")
    page.get_by_role("button", name="Save", exact=True).click()
    expect(page.get_by_text("calm is stored")).to_be_visible()
    expect(page.get_by_role("heading", name="Calm")).to_be_visible()


@pytest.mark.parametrize("scheme", ["light", pytest.param("dark", marks=pytest.mark.long)])
def test_editor_and_library_are_accessible(
    running_server: LiveServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    scheme: ColorScheme,
) -> None:
    """No section of the form or tab of an instrument has a serious violation in either language."""
    writer = Writer(page_factory((1180, 820), scheme), running_server.url)
    writer.log_in()
    page = writer.page
    traffic = Traffic(page)
    writer.open_tab(STUDY, "edit")
    writer.sees_no_problem()
    sections = ("Conditions", "Orders", "Procedure", "Tasks", "Sickness", "Texts", "Blinding")
    for section in (*sections, "Places"):
        writer.open_section(section)
        assert axe(page) == [], section
    writer.choose_german()
    expect(page.get_by_role("tab", name="Orte und Farben")).to_be_visible()
    screenshot(page, f"editor-de-{scheme}")
    for tab in ("", "scoring", "try", "file"):
        page.goto(f"{running_server.url}/#/instruments/raw_tlx/{tab}")
        traffic.settle()
        assert axe(page) == [], tab
        screenshot(page, f"instrument-{tab or 'items'}-{scheme}")


@pytest.mark.parametrize("size", [(1366, 1024), (1024, 1366), (1180, 820), (820, 1180)])
def test_all_answers_of_a_long_scale_are_large_enough_to_touch(
    running_server: LiveServer, page_factory: Callable[..., Page], size: tuple[int, int]
) -> None:
    """All 21 answers of the sickness scale are visible and at least 44 px wide and high."""
    page = page_factory(size)
    writer = Writer(page, running_server.url)
    writer.log_in()
    page.goto(f"{running_server.url}/#/instruments/fms/try")
    steps = page.locator("[data-name] label")
    expect(steps).to_have_count(21)
    for box in (one.bounding_box() for one in steps.all()):
        assert box is not None
        assert min(box["width"], box["height"]) >= 44
        assert 0 <= box["x"] <= box["x"] + box["width"] <= size[0]
