"""Browser tests of devices on the lab's network, with and without its certificate."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Error, Page, expect

from app.wire.messages import PROTOCOL_VERSION, SUBPROTOCOL
from tests.e2e.people import Experimenter, Participant
from tests.faults.streaming import pair_headsets
from tests.support.browser import (
    ARGUMENTS,
    ContextFactory,
    PageWatch,
    in_both_schemes,
    watched_contexts,
)
from tests.support.chromium_binary import find_chromium
from tests.support.lan import LanServer
from tests.support.nss_trust import TrustUnavailableError, trusting_home

GREETED = """([url, protocols, hello]) => new Promise((resolve) => {
    const socket = new WebSocket(url, protocols);
    socket.onopen = () => socket.send(JSON.stringify(hello));
    socket.onmessage = ({ data }) => { socket.close(); resolve(JSON.parse(data).type); };
    socket.onerror = () => resolve("error");
})"""
STUDY = "reembodiment-latency"


@pytest.fixture(scope="module")
def lan(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LanServer]:
    """Provide a server with the built-in authority."""
    with LanServer(tmp_path_factory.mktemp("lan")) as server:
        yield server


@pytest.fixture(scope="module")
def trusting_browser(
    browser: Browser, lan: LanServer, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Browser]:
    """Provide a browser whose user has installed only the help page's certificate."""
    home, chromium = tmp_path_factory.mktemp("trusting"), find_chromium()
    certificate = home / "reembody-ca.crt"
    certificate.write_bytes(lan.authority())
    try:
        trusting_home(home, certificate)
    except TrustUnavailableError as error:
        pytest.skip(f"no second trust store can be made here: {error}")
    trusting = browser.browser_type.launch(
        executable_path=chromium.executable,
        args=list(ARGUMENTS),
        env={**os.environ, **chromium.environment, "HOME": str(home)},
    )
    yield trusting
    trusting.close()


@pytest.fixture
def trusting(trusting_browser: Browser, page_watch: PageWatch) -> Iterator[ContextFactory]:
    """Provide contexts of the browser that trusts the lab's certificate."""
    with watched_contexts(trusting_browser, page_watch) as factory:
        yield factory


def test_with_the_certificate_the_lab_works_over_https_and_wss(
    lan: LanServer, trusting: ContextFactory, page_watch: PageWatch
) -> None:
    """With the certificate, signing in, pairing a tablet and a headset's socket work over TLS."""
    page_watch.allow(r"status of 401 .*/api/tablet/state")  # sent before pairing
    operator = Experimenter(trusting().new_page(), lan.secure_url)
    operator.log_in()
    assert operator.page.evaluate("window.isSecureContext") is True
    (cookie,) = operator.page.context.cookies()
    assert cookie["name"] == "__Host-reembody_login"
    assert (cookie["secure"], cookie["httpOnly"], cookie["path"]) == (True, True, "/")
    operator.open_tab(STUDY)
    operator.create_session()
    tablet = Participant(trusting((1180, 820)).new_page(), lan.secure_url)
    tablet.pair(operator.code_for("tablet"))
    expect(operator.page.get_by_text("Tablet").first).to_be_visible()
    (headset,) = pair_headsets(lan, 1)
    hello = {"type": "hello", "protocol": PROTOCOL_VERSION, "client": "test"}
    socket = f"wss://127.0.0.1:{lan.lan_port}/api/vr/stream"
    protocols = [SUBPROTOCOL, f"bearer.{headset.token}"]
    assert operator.page.evaluate(GREETED, [socket, protocols, hello]) == "welcome"


def test_without_the_certificate_the_help_page_explains_what_to_do(
    lan: LanServer, new_context: ContextFactory, page_watch: PageWatch
) -> None:
    """Without the certificate the browser refuses https, and the help page explains what to do."""
    page_watch.allow("ERR_CERT_AUTHORITY_INVALID")
    page = new_context((390, 844), locale="de-DE").new_page()
    with pytest.raises(Error, match="ERR_CERT_AUTHORITY_INVALID"):
        page.goto(f"{lan.secure_url}/tablet")
    page = page.context.new_page()
    page.goto(lan.help_url)
    expect(page.get_by_role("heading", name="Dieses Gerät verbinden")).to_be_visible()
    page.get_by_role("link", name="English").click()
    expect(page.get_by_role("heading", name="Connect this device")).to_be_visible()
    onward = page.get_by_role("link", name="Open the tablet's page")
    expect(onward).to_have_attribute("href", f"{lan.secure_url}/tablet")
    with page.expect_download() as download:
        page.get_by_role("link", name="as PEM file").click()
    assert Path(download.value.path()).read_bytes().startswith(b"-----BEGIN CERTIFICATE")


@pytest.mark.parametrize("size", [(390, 844), (1180, 820)])
def test_the_help_page_fits_and_can_be_read(
    lan: LanServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    size: tuple[int, int],
) -> None:
    """The help page fits a phone and has no serious accessibility violation, in both languages."""
    page = page_factory(size)
    for language in ("en", "de"):
        page.goto(f"{lan.help_url}/?lang={language}")
        for section in page.locator("details").all():
            section.evaluate("(section) => { section.open = true; }")
        for scheme in in_both_schemes(page):
            assert page.evaluate("document.documentElement.scrollWidth") <= size[0]
            assert axe(page) == [], scheme
            screenshot(page, f"help-{language}-{size[0]}-{scheme}")


@pytest.mark.parametrize("size", [(1280, 800), (1180, 820)])
def test_the_console_shows_how_to_reach_the_lab(
    lan: LanServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    size: tuple[int, int],
) -> None:
    """The console's Network page shows addresses, fingerprint, QR code and the cable connection."""
    operator = Experimenter(page_factory(size), lan.url)
    operator.log_in()
    page = operator.page
    page.get_by_role("link", name="Network").click()
    expect(page.get_by_role("heading", name="Network", exact=True)).to_be_visible()
    expect(page.get_by_text(lan.secure_url).first).to_be_visible()
    expect(page.get_by_text(f"adb reverse tcp:{lan.port} tcp:{lan.port}")).to_be_visible()
    fingerprint = page.get_by_role("main").inner_text().replace("\n", ":")
    with lan.client() as client:
        shown = client.get(lan.help_url).text.partition('class="fingerprint">')[2]
    assert shown.partition("</span>")[0].removeprefix("<span>") in fingerprint
    for scheme in in_both_schemes(page):
        assert axe(page) == [], scheme
        screenshot(page, f"network-{size[0]}-{scheme}")


def test_pairing_offers_the_certificate_first(
    lan: LanServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """The pairing dialog shows the network address and links to the certificate's page."""
    operator = Experimenter(page_factory(), lan.url)
    operator.log_in()
    operator.open_tab(STUDY)
    operator.create_session()
    page = operator.page
    page.get_by_role("button", name="Pair the tablet").click()
    expect(page.get_by_text(f"{lan.secure_url}/tablet?code=")).to_be_visible()
    page.get_by_text("New device?").click()
    expect(page.get_by_text(lan.help_url)).to_be_visible()
    assert axe(page) == []
    screenshot(page, "pairing-first-time")
