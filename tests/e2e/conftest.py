"""Fixtures of the browser tests; everything in this folder is marked `browser`."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect

from app.database import open_database
from tests.e2e.people import PATIENCE_MS
from tests.e2e.telemetry_bench import Headset, Mode, Wear
from tests.features.lab import ok
from tests.features.record.headset.site import Site
from tests.support.browser import (
    ColorScheme,
    ContextFactory,
    Motion,
    PageWatch,
    accessibility_violations,
    launched_browser,
    take_screenshot,
    watched_contexts,
)
from tests.support.bundle import Bundle, bundled
from tests.support.server import ADMIN_PASSWORD, LiveServer
from tests.support.shared_run import once, run_folder

SCREENSHOTS_VARIABLE = "REEMBODY_SCREENSHOTS"
HERE = Path(__file__).resolve().parent
# What is expected is waited for on a slow machine, too: no browser test judges speed.
expect.set_options(timeout=PATIENCE_MS)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the tests of this folder as `browser` before `-m` selects tests."""
    for item in items:
        if item.path.is_relative_to(HERE):
            item.add_marker(pytest.mark.browser)


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """Provide one headless Chromium for all tests of the process."""
    with launched_browser() as browser:
        yield browser


@pytest.fixture
def page_watch() -> PageWatch:
    """Provide the collected errors of the test's pages; expected errors are passed to `allow()`."""
    return PageWatch()


@pytest.fixture
def new_context(browser: Browser, page_watch: PageWatch) -> Iterator[ContextFactory]:
    """Provide a factory of watched browser contexts.

    `new_context(size=(1280, 800), color_scheme="light", locale="en-US", motion="reduce")`.
    """
    with watched_contexts(browser, page_watch) as factory:
        yield factory


@pytest.fixture
def page_factory(new_context: ContextFactory) -> Callable[..., Page]:
    """Provide a function like `new_context` that returns a page in a new context of its own."""

    def new_page(
        size: tuple[int, int] = (1280, 800),
        color_scheme: ColorScheme = "light",
        locale: str = "en-US",
        motion: Motion = "reduce",
        **options: object,
    ) -> Page:
        return new_context(size, color_scheme, locale, motion, **options).new_page()

    return new_page


@pytest.fixture
def screenshot() -> Callable[[Page, str], object]:
    """Provide `screenshot(page, name)`, which saves to $REEMBODY_SCREENSHOTS, if it is set.

    No test examines the pictures, and drawing whole pages takes longer than most tests.
    """
    chosen = os.environ.get(SCREENSHOTS_VARIABLE)
    if not chosen:
        return lambda _page, _name: None
    folder = Path(chosen)
    folder.mkdir(parents=True, exist_ok=True)
    return lambda page, name: take_screenshot(page, folder, name)


@pytest.fixture
def axe() -> Callable[[Page], list[str]]:
    """Provide `axe(page)`, which lists serious and critical accessibility violations."""
    return accessibility_violations


@pytest.fixture(scope="session")
def telemetry_bundle() -> Bundle:
    """Provide the telemetry client, bundled for the browser once per run."""
    folder = run_folder() / "telemetry-bundle"
    with once("telemetry-bundle") as mark:
        if mark:
            bundled("vr/telemetry/testing/bench.ts", folder)
            mark.touch()
    return Bundle(folder)


@pytest.fixture
def running_server(shared_server: LiveServer) -> LiveServer:
    """Provide the server of this process, restarted if the previous test left it stopped."""
    try:
        _ = shared_server.pid
    except RuntimeError:
        shared_server.start()
    return shared_server


@pytest.fixture
def headset_site(running_server: LiveServer) -> Iterator[Site]:
    """Provide a server with its operator signed in."""
    with running_server.client() as operator:
        ok(operator.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        database = open_database(f"sqlite:///{running_server.data_dir / 'reembody.sqlite'}")
        yield Site(running_server, operator, database)
        database.close()


@pytest.fixture
def wear(
    headset_site: Site,
    telemetry_bundle: Bundle,
    new_context: ContextFactory,
    page_watch: PageWatch,
) -> Wear:
    """Provide a function that opens a page as a paired headset, by default in a new context."""
    # The browser reports this error when a server is unavailable.
    page_watch.allow(r"WebSocket connection to .* failed")

    def put_on(
        context: BrowserContext | None = None, mode: Mode = "worker", **limits: float
    ) -> Headset:
        session_id = headset_site.join()
        token = headset_site.token(session_id)
        place = context or new_context()
        server = headset_site.server
        return Headset(place, telemetry_bundle, server, session_id, token, mode, limits).load()

    return put_on
