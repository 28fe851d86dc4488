"""Browser test of a whole session without a mouse, in which every key press is counted."""

import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.people import PATIENCE_MS, PICTURE_HIDDEN
from tests.e2e.scripted_tablet import ScriptedTablet
from tests.e2e.wearer import Wearer
from tests.features.lab import ok
from tests.protocol.helpers import STUDY as FILE
from tests.support.browser import PageWatch
from tests.support.server import ADMIN_PASSWORD, LiveServer

STUDY = "keyboard-study"
TITLE = "A study by keyboard"
PHASES = 2
FARTHEST = 80
"""The most presses of Tab to reach an element."""
ARMED_AFTER_MS = 800
"""The cockpit ignores Enter for this long after a step has changed."""
# Keys pressed in every session, and those of each task phase: docs/operator-steps.md.
FIXED_AT_MOST, PER_PHASE = 35, 1
PROCEDURE = """procedure:
  before:
    - {step: consent, text: consent}
    - {step: form, instrument: demographics}
    - {step: instructions, text: instructions}
    - {step: height, text: height}
    - {step: materialise, text: t_pose}
    - {step: free_roam, duration_s: 1, latency_ms: 0, text: free_roam}
  block:
    limb_order: fixed
    phases:
      - limb: hand
        preparation_s: 0.3
        duration_s: 1.5
        freeze_s: 0.3
        questionnaire: karas2020
        text: hand_task
"""


def short_study() -> str:
    """Return the shipped study with two conditions and short phases."""
    text = FILE
    start, end = text.index("procedure:\n"), text.index("  after:\n")
    text = text[:start] + PROCEDURE + text[end:]
    text = re.sub(r"  - key: latency_125\n.*?(?=  - key)", "", text, flags=re.DOTALL)
    text = text.replace("    - {phase: foot, min_active_share: 0.9}\n", "")
    text = text.replace("en: Acting through another body", f"en: {TITLE}", 1)
    return text.replace("key: reembodiment-latency", f"key: {STUDY}", 1)


@dataclass
class Keyboard:
    """The operator's keyboard. `steps`: the purpose of each key press.

    `typed`: the number of characters typed into fields.
    """

    page: Page
    steps: list[str] = field(default_factory=list)
    typed: int = 0

    def press(self, key: str, why: str) -> None:
        """Press one key."""
        self.steps.append(why)
        self.page.keyboard.press(key)

    def write(self, text: str) -> None:
        """Type a text into the focused field."""
        self.typed += len(text)
        self.page.keyboard.type(text)

    def go_to(self, place: Locator, why: str) -> None:
        """Press Tab until the element has the focus."""
        expect(place).to_be_visible(timeout=PATIENCE_MS)
        for _ in range(FARTHEST):
            if self._is_at(place):
                return
            self.press("Tab", why)
        raise AssertionError(f"Tab does not lead to {why}")

    def choose(self, place: Locator, why: str) -> None:
        """Focus the element and press Enter."""
        self.go_to(place, why)
        self.press("Enter", why)

    def do_next(self, name: str) -> None:
        """Press the key of the main button, as soon as it is enabled."""
        button = self.page.get_by_role("button", name=name).first
        expect(button).to_be_enabled(timeout=PATIENCE_MS)
        self.page.wait_for_timeout(ARMED_AFTER_MS)
        if self.is_held():
            self.go_to(button, name)
        self.press("Enter", name)
        expect(button).not_to_be_visible(timeout=PATIENCE_MS)

    def is_held(self) -> bool:
        """Return whether the focused control handles Enter itself."""
        return bool(
            self.page.evaluate("() => document.activeElement?.closest('button, a') != null")
        )

    def _is_at(self, place: Locator) -> bool:
        return bool(place.evaluate("(element) => element === document.activeElement"))


@contextmanager
def paired(keyboard: Keyboard, url: str) -> Iterator[tuple[ScriptedTablet, Wearer]]:
    """Show both pairing codes; the devices use them, which closes the dialogs."""
    with (
        ScriptedTablet(url, code_for(keyboard, "tablet")) as tablet,
        _gone(keyboard),
        Wearer(url, code_for(keyboard, "headset")) as wearer,
        _gone(keyboard),
    ):
        yield tablet, wearer


def code_for(keyboard: Keyboard, device: str) -> str:
    """Open a device's pairing dialog and return the code."""
    page = keyboard.page
    keyboard.press(device[0], f"pair the {device}")
    shown = page.get_by_role("dialog").get_by_text(re.compile(r"^[0-9A-Z]{3}-[0-9A-Z]{3}$"))
    expect(shown).to_be_visible(timeout=PATIENCE_MS)
    return shown.inner_text()


@contextmanager
def _gone(keyboard: Keyboard) -> Iterator[None]:
    expect(keyboard.page.get_by_role("dialog")).to_have_count(0, timeout=PATIENCE_MS)
    yield


def log_in_and_create(keyboard: Keyboard, url: str) -> None:
    """Go from the login page to the cockpit of a new session."""
    page = keyboard.page
    page.goto(url)
    expect(page.get_by_label("User name")).to_be_focused()
    keyboard.write("admin")
    keyboard.press("Tab", "log in")
    keyboard.write(ADMIN_PASSWORD)
    keyboard.press("Enter", "log in")
    keyboard.choose(page.get_by_role("link", name=TITLE).first, "open the study")
    keyboard.choose(page.get_by_role("button", name="New session").first, "new session")
    expect(page.get_by_role("dialog").get_by_role("textbox").first).to_be_focused()
    keyboard.press("Enter", "create the session")
    planned = page.get_by_role("heading", name="Before the start")
    expect(planned).to_be_visible(timeout=PATIENCE_MS)


def start(keyboard: Keyboard) -> None:
    """Start the session, with a reason if a check of the equipment has failed."""
    page = keyboard.page
    page.wait_for_timeout(ARMED_AFTER_MS)
    if keyboard.is_held():
        keyboard.go_to(page.get_by_role("button", name="Start").first, "start")
    keyboard.press("Enter", "start")
    reason = page.get_by_role("dialog").get_by_role("textbox")
    height = page.get_by_label("Matched height")
    expect(reason.or_(height).first).to_be_visible(timeout=PATIENCE_MS)
    if reason.is_visible():
        keyboard.write("Pilot")
        keyboard.press("Enter", "start")
        expect(height).to_be_visible(timeout=PATIENCE_MS)


@pytest.fixture
def console(
    running_server: LiveServer, page_factory: Callable[..., Page], page_watch: PageWatch
) -> Page:
    """Provide a browser without any state, with the short study on the server."""
    page_watch.allow(r"status of 401")
    with running_server.client() as api:
        ok(api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        if api.get(f"/api/studies/{STUDY}").status_code == 404:
            ok(api.post("/api/studies", json={"yaml": short_study()}))
    return page_factory((1280, 800), motion="no-preference")


@pytest.mark.parametrize("watched", [False, pytest.param(True, marks=pytest.mark.long)])
def test_a_whole_session_without_a_mouse(
    console: Page,
    running_server: LiveServer,
    watched: bool,  # noqa: FBT001 - by parameter
) -> None:
    """A whole session without a mouse takes one key press per phase and few others."""
    if not watched:
        console.add_init_script(PICTURE_HIDDEN)
    keyboard = Keyboard(console)
    log_in_and_create(keyboard, running_server.url)
    with paired(keyboard, running_server.url) as (tablet, wearer):
        start(keyboard)
        keyboard.go_to(console.get_by_label("Matched height"), "height")
        stated = console.get_by_label("Stated height")
        expect(stated).not_to_have_value("", timeout=PATIENCE_MS)
        keyboard.write(f"{100 * tablet.person.stature_m:.0f}")
        keyboard.press("Enter", "height")
        keyboard.do_next("Begin free movement")
        before = len(keyboard.steps)
        for _ in range(PHASES):
            keyboard.do_next("Begin hand task")
        in_phases = len(keyboard.steps) - before
        keyboard.do_next("Finish session")
        ended = console.get_by_role("main").get_by_role("heading", name="Session completed")
        expect(ended.first).to_be_visible(timeout=PATIENCE_MS)
    assert (wearer.error, tablet.error) == (None, None)
    sys.stderr.write(f"{len(keyboard.steps)} keys, {keyboard.typed} typed: {tally(keyboard)}\n")
    assert in_phases == PHASES * PER_PHASE
    assert len(keyboard.steps) - in_phases <= FIXED_AT_MOST


def tally(keyboard: Keyboard) -> dict[str, int]:
    """Return the number of keys pressed for each purpose, in the order of the session."""
    return {why: keyboard.steps.count(why) for why in dict.fromkeys(keyboard.steps)}
