"""Browser test of a withdrawal: a correction, a copy and an erasure."""

from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.e2e.people import Experimenter
from tests.features.care.rights.visit import make_visit
from tests.features.lab import STUDY
from tests.features.record.headset.site import open_site
from tests.support.server import LiveServer


def test_a_withdrawn_participant_is_erased_by_typing_the_code(
    shared_server: LiveServer, page_factory: Callable[..., Page], axe: Callable[[Page], list[str]]
) -> None:
    """After a correction and a copy, erasing a participant leaves only a tombstone on the pages."""
    page = page_factory()
    with open_site(shared_server) as site:
        visit = make_visit(site, "P-0077")
        site.command(visit.session_id, "withdraw", reason="felt sick")
        experimenter = Experimenter(page, shared_server.url)
        experimenter.log_in()
        experimenter.open_tab(STUDY, "participants")
        row = page.get_by_role("row", name="P-0077")
        expect(row).to_be_visible()
        assert axe(page) == []
        row.get_by_role("button", name="Correct an answer").click()
        page.get_by_role("button", name="Correct: How old are you?").click()
        page.get_by_label("Correct value").fill("44")
        page.get_by_label("How do you know?").fill("They told us afterwards.")
        page.get_by_role("button", name="Save correction").click()
        expect(page.get_by_text("18 years until")).to_be_visible()
        assert axe(page) == []
        page.keyboard.press("Escape")
        with page.expect_download() as download:
            row.get_by_role("button", name="Copy of their data").click()
        assert download.value.suggested_filename == "reembody_access_P-0077.zip"
        row.get_by_role("button", name="Erase").click()
        erase = page.get_by_role("button", name="Erase permanently")
        expect(erase).to_be_disabled()
        page.get_by_label("Type P-0077 to confirm").fill("P-0077")
        assert axe(page) == []
        erase.click()
        expect(page.get_by_text("No trace of it is left")).to_be_visible(timeout=30_000)
        page.get_by_role("button", name="Destroyed").first.click()
        expect(page.get_by_text("Destroyed on")).to_be_visible()
        page.get_by_role("button", name="Close").last.click()
        expect(page.get_by_text("P-0077")).to_have_count(0)
        expect(page.get_by_text("erased-")).to_be_visible()
        assert axe(page) == []
