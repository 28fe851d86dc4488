"""Browser tests of a first visit: no network, wrong URLs, unusual codes, unknown files."""

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from app.resources import study_configs_dir
from tests.e2e.people import Experimenter
from tests.features.lab import STUDY, ok
from tests.support.browser import ColorScheme, PageWatch
from tests.support.server import ADMIN_PASSWORD, LiveServer

Axe = Callable[[Page], list[str]]
Screenshot = Callable[[Page, str], object]
LONG = "P-" + "0" * 60


@pytest.fixture
def experimenter(running_server: LiveServer, page_factory: Callable[..., Page]) -> Experimenter:
    """Provide an experimenter signed in at a server that only this computer can reach."""
    made = Experimenter(page_factory(), running_server.url)
    made.log_in()
    return made


@pytest.mark.parametrize(
    ("size", "scheme"), [((1280, 800), "light"), ((1280, 800), "dark"), ((820, 1180), "light")]
)
def test_no_device_is_sent_to_its_own_localhost(
    running_server: LiveServer,
    page_factory: Callable[..., Page],
    axe: Axe,
    screenshot: Screenshot,
    size: tuple[int, int],
    scheme: ColorScheme,
) -> None:
    """Without a network, the pairing dialog shows a code and a remedy, but no QR code or URL."""
    experimenter = Experimenter(page_factory(size, scheme), running_server.url)
    experimenter.log_in()
    page = experimenter.page
    experimenter.open_tab(STUDY)
    experimenter.create_session()
    page.get_by_role("button", name="Pair the tablet").click()
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_text("Only this computer can reach the server")).to_be_visible()
    expect(dialog.get_by_text("./run --lan")).to_be_visible()
    expect(dialog.get_by_role("img", name="QR")).to_have_count(0)
    assert "localhost" not in dialog.inner_text()
    assert axe(page) == []
    screenshot(page, f"pairing-only-here-{scheme}-{size[0]}")
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Pair the headset").click()
    expect(page.get_by_role("dialog").get_by_text("adb reverse")).to_be_visible()
    screenshot(page, f"pairing-headset-only-here-{scheme}-{size[0]}")


def test_an_unpaired_tablet_logs_no_error(
    running_server: LiveServer, page_factory: Callable[..., Page]
) -> None:
    """An unpaired tablet asks for its code, and the browser's console stays empty."""
    page = page_factory((1180, 820))
    page.goto(f"{running_server.url}/tablet")
    expect(page.get_by_role("textbox").first).to_be_visible()
    page.wait_for_timeout(6000)


@pytest.mark.parametrize(
    "address", ["nothing-here", "studies", "sessions/a/b/c/d", "studies/%", "studies/%zz/dashboard"]
)
def test_an_unknown_url_shows_page_not_found(
    experimenter: Experimenter, screenshot: Screenshot, address: str
) -> None:
    """An unknown URL shows that the page does not exist, with a link to the studies."""
    page = experimenter.page
    page.goto(f"{page.url.partition('#')[0]}#/{address}")
    expect(page.get_by_text("Page not found")).to_be_visible()
    screenshot(page, "nothing-here")
    page.get_by_role("link", name="Go to studies").click()
    expect(page.get_by_role("heading", name="Studies", exact=True)).to_be_visible()


def test_a_title_without_spaces_wraps(
    running_server: LiveServer, experimenter: Experimenter
) -> None:
    """A title that is one word of the greatest length makes no page wider than the window."""
    word = "x" * 200
    folder = study_configs_dir()
    study = (folder / f"{STUDY}.yaml").read_text(encoding="utf-8")
    study = study.replace(f"key: {STUDY}", "key: one-word", 1)
    study = study.replace("en: Acting through another body", f"en: {word}", 1)
    form = (folder / "instruments" / "fms.yaml").read_text(encoding="utf-8")
    form = re.sub(r"(?m)^title:\n  en: .*$", f"title:\n  en: {word}", form)
    form = form.replace("key: fms", "key: one_word", 1)
    with running_server.client() as client:
        ok(client.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        ok(client.post("/api/studies", json={"yaml": study}))
        ok(client.post("/api/instruments", json={"yaml": form}))
    page = experimenter.page
    page.reload()
    for address in (
        "",
        *(f"studies/one-word{tab}" for tab in ("", "/sessions", "/protocol")),
        "instruments",
        "instruments/one_word",
    ):
        page.goto(f"{running_server.url}/#/{address}")
        expect(page.get_by_text(word).first).to_be_visible()
        width = page.evaluate("document.documentElement.scrollWidth")
        assert width <= 1280, (address, width)


def test_a_code_that_is_too_long_is_reported(experimenter: Experimenter) -> None:
    """A participant code that is too long stays in the field, with the maximum length."""
    page = experimenter.page
    experimenter.open_tab(STUDY)
    page.get_by_role("button", name="New session").first.click()
    page.get_by_label("Participant code").fill(LONG)
    expect(page.get_by_label("Participant code")).to_have_value(LONG)
    expect(page.get_by_text("At most 40 characters")).to_be_visible()


def test_a_loader_does_not_move_if_motion_is_reduced(
    running_server: LiveServer, page_factory: Callable[..., Page]
) -> None:
    """The dots of a loader do not move if the user prefers reduced motion."""
    page = page_factory(motion="reduce")
    page.goto(running_server.url)
    repeats = page.evaluate(
        """() => {
            const one = document.createElement('div');
            one.style.cssText = '';
            one.className = 'probe';
            const sheet = document.createElement('style');
            sheet.textContent = '@keyframes probe {to {opacity: 0}}'
              + '.probe:nth-child(n) {animation: probe 1s infinite}';
            document.head.append(sheet);
            document.body.append(one);
            const style = getComputedStyle(one);
            return [style.animationIterationCount, style.animationDuration];
        }"""
    )
    assert repeats == ["1", "1e-05s"]


def test_a_page_that_is_older_than_the_server_says_so(
    experimenter: Experimenter, page_watch: PageWatch, axe: Axe, screenshot: Screenshot
) -> None:
    """A part of the console that is gone is told in words: updated, or out of reach; then reload.

    The sidebar stays usable, and a server that is out of reach is not reloaded into nothing.
    """
    page = experimenter.page
    for message in ("Failed to", "net::ERR", "dynamically imported module", "404"):
        page_watch.allow(message)
    gone = "**/assets/CapturesPage-*.js"
    page.route(gone, lambda route: route.fulfill(status=404, body="gone"))
    newer = '<script type="module" src="/assets/console-newer.js"></script>'
    page.route(lambda url: url.endswith("/"), lambda route: route.fulfill(body=newer))
    page.get_by_role("link", name="Captures").click()
    notice = page.get_by_role("alert")
    expect(notice).to_contain_text("This page is older than the server")
    assert axe(page) == []
    screenshot(page, "older-than-the-server")
    page.get_by_role("link", name="Studies", exact=True).first.click()
    expect(page.get_by_role("heading", name="Studies", exact=True)).to_be_visible()

    page.unroute_all()
    page.route(gone, lambda route: route.abort())
    page.route(lambda url: url.endswith("/"), lambda route: route.abort())
    page.get_by_role("link", name="Captures").click()
    notice.get_by_role("button", name="Reload").click()
    expect(notice).to_contain_text("The server is not responding")
    screenshot(page, "out-of-reach")
    page.unroute_all()
    notice.get_by_role("button", name="Reload").click()
    expect(page.get_by_role("heading", name="Captures", exact=True)).to_be_visible()
