"""Browser tests of a second server and of a full disk, as the operator sees them."""

import re
from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.faults.commands import UNUSABLE, reembody
from tests.faults.streaming import signed_in
from tests.faults.test_disk_full import (
    command,
    fill_up,
    health,
    made_export,
    new_session,
    small_disk,
    wait_for,
)
from tests.features.record.headset.site import Site
from tests.features.record.headset.streaming import in_free_movement, materialised
from tests.support.browser import PageWatch
from tests.support.server import LiveServer, free_port


def test_a_refused_second_server_does_not_change_the_console(
    headset_site: Site, page_factory: Callable[..., Page]
) -> None:
    """A second server that is refused on the same folder does not change a running cockpit."""
    server = headset_site.server
    experimenter = Experimenter(page_factory(), server.url)
    page, session_id = experimenter.page, materialised(headset_site)
    experimenter.log_in()
    page.goto(f"{server.url}/#/sessions/{session_id}")
    strip = page.get_by_label("Signal and alarms")
    with headset_site.headset(headset_site.token(session_id)) as headset:
        streamer = in_free_movement(headset_site, session_id, headset)
        with streamer.streaming(running=True, probing=True):
            expect(strip).to_contain_text(
                "Movement is arriving and being stored", timeout=PATIENCE_MS
            )
            said = reembody(server, "serve", "--port", free_port())
            assert said.code == UNUSABLE
            assert f"process id {server.pid} on port {server.port}" in said.err
            expect(strip).to_contain_text(
                "Movement is arriving and being stored", timeout=PATIENCE_MS
            )
            expect(strip.get_by_role("alert")).to_have_count(0)
    assert "server_restarted" not in str(headset_site.view(session_id))


def test_a_full_disk_raises_an_alarm_and_an_export_can_be_deleted(
    tmp_path: Path,
    page_factory: Callable[..., Page],
    page_watch: PageWatch,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """A full disk raises an alarm with a remedy, and deleting an export clears it."""
    page_watch.allow(r"status of 503")
    folder = tmp_path / "live"
    server = LiveServer(folder, environment={"REEMBODY_LOW_DISK_BYTES": "0"})
    with small_disk(folder / "data") as disk, server, signed_in(server) as client:
        session = new_session(client)
        experimenter = Experimenter(page_factory(), server.url)
        experimenter.log_in()
        page = experimenter.page
        export = made_export(client)
        page.goto(f"{server.url}/#/sessions/{session['id']}")
        strip = page.get_by_label("Signal and alarms")
        expect(strip).to_be_visible(timeout=PATIENCE_MS)
        fill_up(disk / "ballast")
        wait_for(lambda: command(client, session, "note").status_code == 503)
        alarm = strip.get_by_role("alert")
        expect(alarm).to_contain_text("Data cannot be stored", timeout=PATIENCE_MS)
        expect(alarm).to_contain_text("If the disk is full, delete exports")
        assert axe(page) == []
        screenshot(page, "disk-full")
        page.get_by_role("button", name=re.compile("^Downloads")).click()
        page.get_by_role("button", name="Remove").first.click()
        wait_for(lambda: client.get(f"/api/exports/{export}").status_code == 404)
        page.keyboard.press("Escape")
        (disk / "ballast").unlink()
        expect(strip).not_to_contain_text("Data cannot be stored", timeout=PATIENCE_MS)
        assert health(client)["storage"] == "ok"
        # Leave the page before the server ends: its stream would be cut off.
        page.close()
