"""Fixtures of the browser tests; everything in this folder is marked `browser`."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page

from tests.support.browser import (
    ColorScheme,
    ContextFactory,
    PageWatch,
    accessibility_violations,
    launched_browser,
    take_screenshot,
    watched_contexts,
)

SCREENSHOTS_VARIABLE = "REEMBODY_SCREENSHOTS"
HERE = Path(__file__).resolve().parent


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark before `-m` selects."""
    for item in items:
        if item.path.is_relative_to(HERE):
            item.add_marker(pytest.mark.browser)


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """One headless Chromium for all tests of the process."""
    with launched_browser() as browser:
        yield browser


@pytest.fixture
def page_watch() -> PageWatch:
    """What the test's pages complain about; `allow()` what the test provokes on purpose."""
    return PageWatch()


@pytest.fixture
def new_context(browser: Browser, page_watch: PageWatch) -> Iterator[ContextFactory]:
    """`new_context(size=(1280, 800), color_scheme="light", locale="en-US", **playwright's)`."""
    with watched_contexts(browser, page_watch) as factory:
        yield factory


@pytest.fixture
def page_factory(new_context: ContextFactory) -> Callable[..., Page]:
    """Like `new_context`, but a page in a new context of its own."""

    def new_page(
        size: tuple[int, int] = (1280, 800),
        color_scheme: ColorScheme = "light",
        locale: str = "en-US",
        **options: object,
    ) -> Page:
        return new_context(size, color_scheme, locale, **options).new_page()

    return new_page


@pytest.fixture
def screenshot(tmp_path: Path) -> Callable[[Page, str], Path]:
    """`screenshot(page, name)` saves to $REEMBODY_SCREENSHOTS, else to the test's own folder."""
    folder = Path(os.environ.get(SCREENSHOTS_VARIABLE) or tmp_path / "screenshots")
    folder.mkdir(parents=True, exist_ok=True)
    return lambda page, name: take_screenshot(page, folder, name)


@pytest.fixture
def axe() -> Callable[[Page], list[str]]:
    """`axe(page)` lists serious and critical accessibility violations; assert that it is empty."""
    return accessibility_violations
