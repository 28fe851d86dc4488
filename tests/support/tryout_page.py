"""The try-out of the shipped configuration on a page of its own, which the server does not ship."""

from pathlib import Path

from playwright.sync_api import BrowserContext, Locator, Page, expect

from tests.support.bundle import bundled

PATIENCE_MS = 60_000
ENTRY = "console/avatarEditor/tryout/testing/page.tsx"


def opened_tryout(context: BrowserContext, server_url: str, folder: Path, more: str = "") -> Page:
    """Return the page, with the physics running; `more` is a script that runs before its own."""
    if more:
        context.add_init_script(more)
    page = bundled(ENTRY, folder).open(context, server_url)
    expect(figure(page, "whole")).to_contain_text("°", timeout=PATIENCE_MS)
    return page


def figure(page: Page, name: str) -> Locator:
    """Return the cell of a figure of the working configuration."""
    return page.locator(f"[data-figure={name}]")
