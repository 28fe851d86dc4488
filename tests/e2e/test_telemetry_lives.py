"""Browser tests of pages that are left, crash or are killed: the journal is sent later."""

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Browser, BrowserContext

from app.models import TelemetryStream
from tests.e2e.killing import crash, kept_profile, kill_browser
from tests.e2e.telemetry_bench import (
    BATCHES_PER_S,
    FRAMES_PER_BATCH,
    Headset,
    Made,
    Mode,
    Wear,
    reconciled,
)
from tests.features.record.headset.site import Site
from tests.support.browser import ContextFactory

MANY = 6000
"""More frames than a page produces before it is killed."""


@pytest.mark.parametrize(("mode", "flush_every_s"), [("page", 600.0), ("worker", 0.25)])
def test_a_page_that_is_left_writes_its_journal_to_disk(
    wear: Wear,
    headset_site: Site,
    new_context: ContextFactory,
    mode: Mode,
    flush_every_s: float,
) -> None:
    """A page that the user leaves has written its journal to disk.

    A client in the page writes it immediately; one in a worker at its regular interval.
    """
    context = new_context()
    headset = wear(context, mode=mode, flushEveryS=flush_every_s)
    first = headset.open()
    headset_site.server.kill()
    headset.produce(30, speed=None)
    certain = headset.made
    if mode == "worker":
        time.sleep(8 * flush_every_s)
    headset.page.goto("about:blank")
    headset_site.server.start()
    check_both_lives(next_life(headset, context), headset_site, first, certain)


@pytest.mark.long
def test_a_crashed_page_sends_its_journal_under_its_old_epoch(
    wear: Wear, headset_site: Site, new_context: ContextFactory
) -> None:
    """A page that crashed offline sends its journal after a restart, under its old epoch."""
    context = new_context()
    headset = wear(context)
    first = headset.open()
    certain = make_and_be_killed(headset, headset_site, lambda: crash(headset.page))
    again = next_life(headset, context)
    check_both_lives(again, headset_site, first, certain)


def test_a_killed_browser_sends_its_journal_under_its_old_epoch(
    wear: Wear, headset_site: Site, browser: Browser, tmp_path: Path
) -> None:
    """A killed browser finds its journal on disk and sends it under the old epoch."""
    profile = tmp_path / "profile"
    with kept_profile(browser, profile) as context:
        headset = wear(context)
        first = headset.open()
        certain = make_and_be_killed(headset, headset_site, lambda: kill_browser(profile))
    with kept_profile(browser, profile) as context:
        check_both_lives(next_life(headset, context), headset_site, first, certain)


def make_and_be_killed(headset: Headset, site: Site, kill: Callable[[], None]) -> Made:
    """Stream, stop the server, continue, and kill the client; return the data surely journaled."""
    headset.produce(2 * BATCHES_PER_S, speed=4.0)
    site.server.kill()
    headset.produce(2 * BATCHES_PER_S, speed=4.0)
    headset.flush()
    certain = headset.made
    headset.begin(MANY // FRAMES_PER_BATCH, speed=4.0)
    time.sleep(0.4)
    kill()
    site.server.start()
    return replace(certain, perhaps=MANY)


def next_life(headset: Headset, context: BrowserContext) -> Headset:
    """Restart the headset and return it."""
    return replace(headset, context=context).load()


def check_both_lives(again: Headset, site: Site, first: int, certain: Made) -> None:
    """Assert that journaled data are stored under their own epoch and new data under a new one."""
    second = again.open()
    again.produce(BATCHES_PER_S, speed=4.0)
    again.drained()
    runs = {first: certain, second: again.made}
    found = reconciled(site.server, again.session_id, runs)
    assert second == first + 1
    assert found.sound
    assert found.stored >= sum(2 * made.frames + made.reports for made in runs.values())
    again.close()
    told = produced_of(site, again.session_id)
    assert told["target", second] == again.made.frames
    # The journal also reports how many frames the crashed page had produced.
    assert certain.frames <= told["actual", first] <= certain.frames + certain.perhaps


def produced_of(site: Site, session_id: str) -> dict[tuple[str, int], int]:
    """Return how many frames each run reported as produced before it disconnected."""
    deadline = time.monotonic() + 10.0
    while True:
        with site.database.reading() as db:
            rows = db.query(TelemetryStream).filter_by(session_id=session_id).all()
            told = {(row.stream, row.epoch): row.produced for row in rows}
        if all(row.produced >= row.next_seq for row in rows) or time.monotonic() > deadline:
            return told
        time.sleep(0.05)
