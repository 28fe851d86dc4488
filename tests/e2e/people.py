"""Actions of an experimenter at the console and a participant at the tablet."""

import re
from collections.abc import Mapping

from playwright.sync_api import Page, expect

from tests.support import browser
from tests.support.server import ADMIN_PASSWORD

PATIENCE_MS = browser.PATIENCE_MS
PICTURE_HIDDEN = "localStorage.setItem('reembody.cockpit.live', 'false')"
"""For consoles without the live picture: software rendering would use a whole core."""


class Experimenter:
    """An experimenter at the console, who finds controls by the texts on the page."""

    def __init__(self, page: Page, url: str) -> None:
        self.page, self.url = page, url

    def log_in(self) -> None:
        """Open the console and sign in."""
        self.page.goto(self.url)
        self.page.get_by_label("User name").fill("admin")
        self.page.get_by_label("Password", exact=True).fill(ADMIN_PASSWORD)
        self.page.keyboard.press("Enter")
        expect(self.page.get_by_role("heading", name="Studies")).to_be_visible()

    def open_tab(self, study: str, tab: str = "") -> None:
        """Open a tab of a study."""
        self.page.goto(f"{self.url}/#/studies/{study}/{tab}")

    def choose_german(self) -> None:
        """Switch the console from English to German in the account menu."""
        self.page.get_by_role("button", name="admin", exact=True).click()
        self.page.get_by_role("menuitem", name="Deutsch").click()

    def create_session(self) -> None:
        """Create a session for a participant and open it."""
        self.page.get_by_role("button", name="New session").first.click()
        self.page.get_by_role("button", name="Create session").click()
        # Nothing is paired yet, so the pre-flight is open.
        expect(self.page.get_by_role("heading", name="Before the start")).to_be_visible()

    def code_for(self, device: str) -> str:
        """Open the pairing dialog of the tablet or the headset and return its code."""
        self.page.get_by_role("button", name=f"Pair the {device}").click()
        shown = self.page.get_by_text(re.compile(r"^[0-9A-Z]{3}-[0-9A-Z]{3}$")).first
        expect(shown).to_be_visible()
        code = shown.inner_text()
        self.page.keyboard.press("Escape")
        return code

    def press(self, name: str) -> None:
        """Press the button with this name as soon as it is enabled."""
        button = self.page.get_by_role("button", name=name).first
        expect(button).to_be_enabled(timeout=PATIENCE_MS)
        button.click()

    def start(self) -> None:
        """Start the session, with a reason if the pre-flight asks for one.

        Missing devices may connect while the reason is entered; the same button then starts.
        """
        self.press("Start session")
        asked = self.page.get_by_role("dialog")
        begun = self.page.get_by_text(re.compile(r"^Step 1 of"))
        expect(asked.or_(begun).first).to_be_visible(timeout=PATIENCE_MS)
        if asked.is_visible():
            asked.get_by_label("Reason").fill("The headset comes later")
            asked.get_by_role("button", name=re.compile("Start (anyway|session)")).click()
            expect(begun).to_be_visible(timeout=PATIENCE_MS)

    def match_height(self, stated_cm: str, matched_cm: str) -> None:
        """Check the height that was entered on the tablet, and enter the matched height."""
        stated = self.page.get_by_label("Stated height")
        expect(stated).to_have_value(f"{stated_cm} cm", timeout=PATIENCE_MS)
        self.page.get_by_label("Matched height").fill(matched_cm)
        self.press("Save heights")

    def sees_step(self, name: str) -> None:
        """Wait until the step with this name is the current one."""
        heading = self.page.get_by_role("main").get_by_role("heading", name=name)
        expect(heading.first).to_be_visible(timeout=PATIENCE_MS)


class Participant:
    """A participant at the tablet."""

    def __init__(self, page: Page, url: str) -> None:
        self.page, self.url = page, url

    def pair(self, code: str) -> None:
        """Open the page that the pairing QR code leads to."""
        self.page.goto(f"{self.url}/tablet?code={code}")

    def agree(self) -> None:
        """Agree to take part."""
        self.page.get_by_role("button", name="I agree to take part").click()

    def have_read(self) -> None:
        """Confirm that the instructions were read."""
        self.page.get_by_role("button", name="I have read this").click()

    def fill_in(self, answers: Mapping[str, str]) -> None:
        """Answer a form page by page: item key -> value of the option, or text to type."""
        while True:
            for question in self.page.locator("[data-name]").all():
                item = question.get_attribute("data-name") or ""
                if item in answers:
                    self._answer(item, answers[item])
            send = self.page.get_by_role("button", name="Send answers")
            if send.is_visible():
                send.click()
                return
            self.page.get_by_role("button", name="Next").click()

    def waits(self) -> None:
        """Wait until the answers are stored and the form is closed."""
        send = self.page.get_by_role("button", name="Send answers")
        expect(send).to_have_count(0, timeout=PATIENCE_MS)

    def _answer(self, item: str, value: str) -> None:
        question = self.page.locator(f'[data-name="{item}"]')
        option = question.locator(f'input[value="{value}"]')
        if option.count():
            option.first.check(force=True)
        else:
            question.locator("input, textarea").first.fill(value)
