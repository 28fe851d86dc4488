"""Two ways to use a page, so that one journey is walked by mouse and by keyboard alone."""

import re
from typing import Protocol

from playwright.sync_api import Locator, Page, expect

from tests.e2e.people import PATIENCE_MS
from tests.support.server import ADMIN_PASSWORD

FARTHEST = 160
"""The most presses of one key to reach an element."""

# Tab goes forward where the place follows the focus in the document, and Shift+Tab back.
IS_BEFORE_FOCUS = """(element) => (document.activeElement.compareDocumentPosition(element)
    & Node.DOCUMENT_POSITION_PRECEDING) !== 0"""
IS_FOCUSED = "(element) => element === document.activeElement"
IS_IN_FOCUSED_GROUP = "(element) => element.name === document.activeElement?.name"


class Hand(Protocol):
    """What people do to a page. Every method waits until the place is there and enabled."""

    page: Page

    def log_in(self, url: str) -> None:
        """Open the console and sign in."""

    def press(self, place: Locator) -> None:
        """Press a button, follow a link, or tick a box."""

    def write(self, field: Locator, text: str) -> None:
        """Replace the text of a field."""

    def choose(self, box: Locator, option: str) -> None:
        """Choose from a list that opens."""

    def pick(self, menu: Locator, item: str) -> None:
        """Choose an item of a menu."""

    def switch(self, name: str) -> None:
        """Choose one of several radio buttons that stand side by side."""

    def flip(self, name: str) -> None:
        """Turn a switch on or off."""

    def open_tab(self, name: str) -> None:
        """Open a tab."""

    def set_cell(self, row: str, column: int, text: str) -> None:
        """Replace a number in the table of joints."""

    def save(self) -> None:
        """Open the dialog that saves an avatar."""


def cell(page: Page, row: str, column: int) -> Locator:
    """Return a cell of the table: columns 2 and 3 are the limits, 4 to 6 the motor."""
    return page.locator(f"[data-row='{row}'][data-column='{column}']")


class Mouse:
    """A mouse, with the keyboard for texts and numbers only."""

    def __init__(self, page: Page) -> None:
        self.page = page

    def log_in(self, url: str) -> None:
        """Open the console and sign in."""
        self.page.goto(url)
        self.page.get_by_label("User name").fill("admin")
        self.page.get_by_label("Password", exact=True).fill(ADMIN_PASSWORD)
        self.page.get_by_role("button", name="Sign in").click()

    def press(self, place: Locator) -> None:
        """Click."""
        place.click(timeout=PATIENCE_MS)

    def write(self, field: Locator, text: str) -> None:
        """Replace the text of a field."""
        field.fill(text, timeout=PATIENCE_MS)

    def choose(self, box: Locator, option: str) -> None:
        """Click the box, and the option in the list that opens."""
        box.click(timeout=PATIENCE_MS)
        self.page.get_by_role("option", name=option).click(timeout=PATIENCE_MS)

    def pick(self, menu: Locator, item: str) -> None:
        """Click the menu and its item."""
        menu.click(timeout=PATIENCE_MS)
        self.page.get_by_role("menuitem", name=item).click(timeout=PATIENCE_MS)

    def switch(self, name: str) -> None:
        """Click the label."""
        self.page.get_by_text(name, exact=True).click(timeout=PATIENCE_MS)

    def flip(self, name: str) -> None:
        """Click the switch."""
        self.page.get_by_role("switch", name=name).click(timeout=PATIENCE_MS)

    def open_tab(self, name: str) -> None:
        """Click the tab."""
        self.page.get_by_role("tab", name=name).click(timeout=PATIENCE_MS)

    def set_cell(self, row: str, column: int, text: str) -> None:
        """Double-click the number and type another."""
        cell(self.page, row, column).dblclick(timeout=PATIENCE_MS)
        self.page.keyboard.type(text)
        self.page.keyboard.press("Enter")

    def save(self) -> None:
        """Click Save."""
        self.press(self.page.get_by_role("button", name="Save", exact=True))


class Keys:
    """A keyboard and nothing else; `presses` counts its keys, without typed texts."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.presses = 0

    def hit(self, key: str) -> None:
        """Press one key."""
        self.presses += 1
        self.page.keyboard.press(key)

    def log_in(self, url: str) -> None:
        """Open the console and sign in; the first field has the focus."""
        self.page.goto(url)
        expect(self.page.get_by_label("User name")).to_be_focused(timeout=PATIENCE_MS)
        self.page.keyboard.type("admin")
        self.hit("Tab")
        self.page.keyboard.type(ADMIN_PASSWORD)
        self.hit("Enter")

    def go_to(self, place: Locator) -> None:
        """Press Tab or Shift+Tab until the element has the focus."""
        expect(place).to_be_visible(timeout=PATIENCE_MS)
        expect(place).to_be_enabled(timeout=PATIENCE_MS)
        self._tab_to(place)

    def press(self, place: Locator) -> None:
        """Go there and press Enter, or Space for a box to tick."""
        self.go_to(place)
        is_box = place.evaluate("(element) => element.matches('[type=checkbox]')")
        self.hit("Space" if is_box else "Enter")

    def write(self, field: Locator, text: str) -> None:
        """Go to the field and type over what it has."""
        self.go_to(field)
        self.hit("Control+a")
        self.page.keyboard.type(text)

    def choose(self, box: Locator, option: str) -> None:
        """Go to the box, open its list with an arrow, and go down to the option."""
        self.go_to(box)
        if box.get_attribute("aria-expanded") != "true":
            self.hit("ArrowDown")
        wanted = self.page.get_by_role("option", name=option)
        expect(wanted).to_be_visible(timeout=PATIENCE_MS)
        for _ in range(FARTHEST):
            if wanted.get_attribute("data-combobox-selected") is not None:
                break
            self.hit("ArrowDown")
        self.hit("Enter")
        expect(wanted).to_be_hidden(timeout=PATIENCE_MS)

    def pick(self, menu: Locator, item: str) -> None:
        """Open the menu with Enter and go down to the item."""
        self.press(menu)
        wanted = self.page.get_by_role("menuitem", name=item)
        expect(wanted).to_be_visible(timeout=PATIENCE_MS)
        for _ in range(FARTHEST):
            if wanted.evaluate(IS_FOCUSED):
                break
            self.hit("ArrowDown")
        self.hit("Enter")

    def switch(self, name: str) -> None:
        """Go to the chosen radio button of the group, and from it with arrows to the other.

        A choice may open a dialog, which takes the focus at once.
        """
        wanted = self.page.get_by_role("radio", name=name, exact=True)
        expect(wanted).to_be_attached(timeout=PATIENCE_MS)
        group = wanted.evaluate("(element) => element.name")
        self._tab_to(self.page.locator(f"input[name='{group}']:checked"))
        for _ in range(FARTHEST):
            if wanted.evaluate(IS_FOCUSED) or not wanted.evaluate(IS_IN_FOCUSED_GROUP):
                return
            self.hit("ArrowRight")
        raise AssertionError(f"the arrows do not lead to {name}")

    def _tab_to(self, place: Locator) -> None:
        """Radio buttons and switches are drawn by their labels: they are there, but not seen."""
        for _ in range(FARTHEST):
            if place.evaluate(IS_FOCUSED):
                return
            self.hit("Shift+Tab" if place.evaluate(IS_BEFORE_FOCUS) else "Tab")
        raise AssertionError(f"Tab does not lead to {place}")

    def flip(self, name: str) -> None:
        """Go there and press Space."""
        self._tab_to(self.page.get_by_role("switch", name=name))
        self.hit("Space")

    def open_tab(self, name: str) -> None:
        """Go to the open tab, and from it with arrows to the other."""
        wanted = self.page.get_by_role("tab", name=name)
        tabs = self.page.get_by_role("tablist").filter(has=wanted)
        self.go_to(tabs.locator("[role=tab][aria-selected=true]"))
        for _ in range(FARTHEST):
            if wanted.evaluate(IS_FOCUSED):
                return
            self.hit("ArrowRight")
        raise AssertionError(f"the arrows do not lead to {name}")

    def set_cell(self, row: str, column: int, text: str) -> None:
        """Go to the number with the arrows and type another."""
        self.go_to_cell(row, column)
        self.page.keyboard.type(text)
        self.hit("Enter")

    def go_to_cell(self, row: str, column: int) -> None:
        """Go to a cell of a group that is open, as in a spreadsheet."""
        place = cell(self.page, row, column)
        self.go_to(self.page.get_by_role("treegrid").locator("[data-here]"))
        line = place.locator("xpath=..")
        for _ in range(FARTHEST):
            if line.locator("[data-here]").count():
                break
            self.hit("ArrowUp" if line.evaluate(IS_BEFORE_FOCUS) else "ArrowDown")
        self.hit("Home")
        for _ in range(column):
            self.hit("ArrowRight")
        expect(place).to_be_focused()

    def save(self) -> None:
        """Press Ctrl+S: the note has the focus."""
        self.hit("Control+s")
        expect(self.page.get_by_label(re.compile("^Note"))).to_be_focused(timeout=PATIENCE_MS)
