"""Browser tests of captures: uploaded, viewed in 3-D, mapped and verified on avatars."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from httpx2 import Client
from playwright.sync_api import Locator, Page, expect

from app.adapters.bvh import read_bvh
from tests.e2e.people import PATIENCE_MS
from tests.features.movement.captures.files import walk_bvh
from tests.support.browser import ColorScheme, ContextFactory, PageWatch
from tests.support.server import ADMIN_PASSWORD, LiveServer

NewConsole = Callable[..., Page]
FRAMES = 150

# Read from a copy of the picture: an empty stage has one colour.
COLOURS = """canvas => {
    const copy = Object.assign(document.createElement('canvas'),
        { width: canvas.width, height: canvas.height });
    const ink = copy.getContext('2d');
    ink.drawImage(canvas, 0, 0);
    const { data } = ink.getImageData(0, 0, copy.width, copy.height);
    const seen = new Set();
    for (let at = 0; at < data.length; at += 4)
        seen.add((data[at] >> 4) << 8 | (data[at + 1] >> 4) << 4 | data[at + 2] >> 4);
    return seen.size;
}"""
WITHOUT_WEBGL = """HTMLCanvasElement.prototype.getContext = new Proxy(
    HTMLCanvasElement.prototype.getContext,
    { apply: (get, canvas, [kind, ...rest]) =>
        kind.startsWith('webgl') ? null : Reflect.apply(get, canvas, [kind, ...rest]) })"""


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    """Provide one server for the tests of this file."""
    with LiveServer(tmp_path_factory.mktemp("captures")) as server:
        yield server


@pytest.fixture(scope="module")
def admin(server: LiveServer) -> Iterator[Client]:
    """Provide a client of the signed-in admin."""
    with server.client() as admin:
        admin.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD})
        yield admin


@pytest.fixture(scope="module")
def walk(admin: Client) -> dict[str, Any]:
    """Provide an uploaded walk."""
    answer = admin.post(
        "/api/captures", params={"name": "a-walk.bvh"}, content=walk_bvh(FRAMES), timeout=60.0
    )
    assert answer.status_code == 201, answer.text
    captured: dict[str, Any] = answer.json()
    return captured


@pytest.fixture
def new_console(server: LiveServer, admin: Client, new_context: ContextFactory) -> NewConsole:
    """Provide a function that opens browsers in which the admin is signed in."""

    def console(scheme: ColorScheme = "light") -> Page:
        context = new_context((1180, 820), scheme)
        context.add_cookies(
            [
                {"name": cookie.name, "value": cookie.value or "", "url": server.url}
                for cookie in admin.cookies.jar
            ]
        )
        return context.new_page()

    return console


@pytest.fixture
def console(new_console: NewConsole) -> Page:
    """Provide the admin's browser."""
    return new_console()


def open_capture(page: Page, server: LiveServer, capture: dict[str, Any], tab: str = "") -> None:
    """Open a tab of a capture."""
    page.goto(f"{server.url}/#/captures/{capture['id']}/{tab}")


def stage(page: Page) -> Locator:
    """Return the 3-D view, once it has drawn something."""
    canvas = page.locator("canvas[data-frame]")
    expect(page.locator("[data-way=space]")).to_be_visible(timeout=PATIENCE_MS)
    return canvas


def test_an_uploaded_walk_is_shown_in_3d(server: LiveServer, console: Page, tmp_path: Path) -> None:
    """A dropped file is listed, drawn in 3-D, scrubbed by keyboard, renamed and deleted."""
    file = tmp_path / "brought.bvh"
    file.write_bytes(walk_bvh(FRAMES + 1))
    console.goto(f"{server.url}/#/captures")
    console.locator("input[type=file]").set_input_files(file)
    console.get_by_role("link", name="Open brought.bvh").click(timeout=PATIENCE_MS)
    canvas = stage(console)
    assert canvas.evaluate(COLOURS) > 20
    at_start = canvas.evaluate("canvas => canvas.toDataURL()")
    expect(console.get_by_text("0.00 s of 5.00 s · frame 0 of 150")).to_be_visible()
    console.keyboard.press("ArrowRight")
    console.keyboard.press("Shift+ArrowRight")
    expect(console.get_by_text("frame 11 of 150")).to_be_visible()
    expect(canvas).to_have_attribute("data-frame", "11")
    console.get_by_label("Position in the movement").focus()
    console.keyboard.press("End")
    expect(console.get_by_text("5.00 s of 5.00 s · frame 150 of 150")).to_be_visible()
    console.wait_for_function(
        "before => document.querySelector('canvas').toDataURL() !== before", arg=at_start
    )
    console.keyboard.press("Space")
    expect(console.get_by_role("button", name="Pause (space)")).to_be_visible()
    console.keyboard.press("Space")
    expect(console.get_by_role("button", name="Play (space)")).to_be_visible()
    console.get_by_role("button", name="Change the title").click()
    console.get_by_label("Title").fill("The first walk")
    console.keyboard.press("Enter")
    expect(console.get_by_role("heading", name="The first walk")).to_be_visible()
    console.get_by_role("button", name="Delete").click()
    console.get_by_role("dialog").get_by_role("button", name="Delete").click()
    expect(console.get_by_role("heading", name="Captures", exact=True)).to_be_visible()
    expect(console.get_by_text("The first walk")).to_have_count(0)


def test_choosing_another_unit_rereads_the_file(
    server: LiveServer, console: Page, walk: dict[str, Any]
) -> None:
    """A guessed unit is marked, and choosing another one changes the size of the body."""
    open_capture(console, server, walk)
    panel = console.get_by_label("How the file was read", exact=True)
    expect(panel.get_by_text("guessed", exact=True)).to_be_visible()
    height_m = size_m(panel)
    panel.get_by_role("combobox", name="Unit of length in the file").click()
    console.get_by_role("option", name="Inch").click()
    panel.get_by_role("button", name="Read again").click()
    expect(panel.get_by_text("Read again with inch")).to_be_visible(timeout=PATIENCE_MS)
    expect(panel.get_by_text("chosen here")).to_be_visible()
    expect(panel.get_by_text(f"{height_m * 2.54:.2f} m high")).to_be_visible(timeout=PATIENCE_MS)
    panel.get_by_role("combobox", name="Unit of length in the file").click()
    console.get_by_role("option", name="Automatic").click()
    panel.get_by_role("button", name="Read again").click()
    expect(panel.get_by_text("guessed", exact=True)).to_be_visible(timeout=PATIENCE_MS)


def size_m(panel: Locator) -> float:
    """Return the height shown in the panel, in metres."""
    told = panel.get_by_text("m high")
    expect(told).to_be_visible(timeout=PATIENCE_MS)
    return float(told.inner_text().rpartition(", ")[2].removesuffix(" m high"))


def test_a_joint_map_is_changed_undone_and_saved(
    server: LiveServer,
    admin: Client,
    console: Page,
    walk: dict[str, Any],
    page_watch: PageWatch,
) -> None:
    """A joint map rejects a joint with two parts, supports undo and reports saving conflicts."""
    page_watch.allow(r"status of 409")
    open_capture(console, server, walk, "joints")
    hand = console.get_by_role("combobox", name="Left hand")
    hand.fill("LeftForeArm")
    console.get_by_role("option", name="LeftForeArm").click()
    expect(console.get_by_text("This joint is also mapped to Left lower arm.")).to_be_visible()
    expect(console.get_by_role("button", name="Save map")).to_be_disabled()
    console.get_by_role("button", name="Undo").click()
    expect(hand).to_have_value("LeftHand")
    expect(console.get_by_text("also plays")).to_have_count(0)
    hand.focus()
    console.keyboard.press("Escape")
    console.get_by_role("button", name="Clear the joint for: Left hand").press("Enter")
    console.get_by_role("button", name="Save map").click()
    expect(console.get_by_text("The map is saved")).to_be_visible()
    expect(console.get_by_text("Saved by admin")).to_be_visible()
    route = f"/api/captures/{walk['id']}/joint-map"
    mapped = admin.get(route).json()
    assert "LeftHand" not in mapped["joint_map"]
    assert admin.delete(route, params={"version": mapped["version"]}).status_code == 200
    toes = console.get_by_role("combobox", name="Right toes")
    toes.fill("RightFoot")
    console.get_by_role("option", name="RightFoot").click()
    console.get_by_role("button", name="Back to the proposal").click()
    console.get_by_role("button", name="Save map").click()
    expect(console.get_by_text("Someone else has saved another map")).to_be_visible()
    console.get_by_role("button", name="Use theirs").click()
    expect(hand).to_have_value("LeftHand")


def test_a_walk_is_verified_on_three_avatars(
    server: LiveServer, console: Page, walk: dict[str, Any], tmp_path: Path
) -> None:
    """A walk's foot lifts agree on avatars of 130, 165 and 190 cm; an added one is downloaded."""
    open_capture(console, server, walk, "verification")
    expect(console.get_by_text("Every avatar lifts each foot as often")).to_be_visible(
        timeout=PATIENCE_MS
    )
    for stature in ("130 cm", "165 cm", "190 cm"):
        expect(console.get_by_role("rowheader", name=stature)).to_be_visible()
    for figure in ("Path of the toe joint", "When each foot is off", "Leg angles of the source"):
        expect(console.get_by_label(figure).locator(".main-svg").first).to_be_visible(
            timeout=PATIENCE_MS
        )
    console.get_by_label("Stature (cm)").fill("172.5")
    console.get_by_role("button", name="Add an avatar").click()
    expect(console.get_by_role("rowheader", name="172.5 cm")).to_be_visible(timeout=PATIENCE_MS)
    with console.expect_download() as download:
        console.get_by_role("button", name="130 cm as BVH").click()
    taken = tmp_path / "taken.bvh"
    download.value.save_as(taken)
    assert len(read_bvh(taken, metres_per_unit=0.01).rotations) == FRAMES


def test_an_unreadable_file_shows_line_and_reason(
    server: LiveServer, console: Page, tmp_path: Path, page_watch: PageWatch
) -> None:
    """An unreadable file shows its line, reason and remedy; an AMC file requires an ASF."""
    page_watch.allow(r"status of 422")
    broken = tmp_path / "broken.bvh"
    broken.write_bytes(walk_bvh(2).replace(b"CHANNELS 3", b"CHANNELS 9", 1))
    alone = tmp_path / "02_01.amc"
    alone.write_text("#!OML:ASF H:\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n")
    console.goto(f"{server.url}/#/captures")
    console.locator("input[type=file]").set_input_files([broken, alone])
    refused = console.get_by_role("listitem").filter(has_text="broken.bvh")
    expect(refused.get_by_text("Not uploaded")).to_be_visible(timeout=PATIENCE_MS)
    expect(refused.get_by_text("broken.bvh · line 9")).to_be_visible()
    expect(refused.get_by_text("channels")).to_be_visible()
    expect(console.get_by_text("Its .asf file is missing")).to_be_visible()
    console.get_by_role("button", name="Remove broken.bvh from this list").click()
    expect(refused).to_have_count(0)


def test_without_webgl_the_movement_is_seen_from_the_side(
    server: LiveServer, console: Page, walk: dict[str, Any]
) -> None:
    """Without WebGL the page says so and draws the movement as lines from the side."""
    console.add_init_script(WITHOUT_WEBGL)
    open_capture(console, server, walk)
    expect(console.get_by_text("This browser cannot show 3-D")).to_be_visible(timeout=PATIENCE_MS)
    hips = console.locator("[data-way=flat] circle").first
    before = hips.get_attribute("cx")
    console.get_by_label("Position in the movement").focus()
    console.keyboard.press("End")
    expect(hips).not_to_have_attribute("cx", before or "")


@pytest.mark.parametrize("scheme", ["light", pytest.param("dark", marks=pytest.mark.long)])
def test_every_page_of_a_capture_is_accessible(
    server: LiveServer,
    new_console: NewConsole,
    walk: dict[str, Any],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    scheme: ColorScheme,
) -> None:
    """The list of captures and each tab of one have no serious accessibility violation."""
    page = new_console(scheme)
    page.goto(f"{server.url}/#/captures")
    expect(page.get_by_role("link", name="a-walk.bvh")).to_be_visible()
    assert axe(page) == []
    screenshot(page, f"captures-{scheme}")
    for tab, sign in (
        ("movement", "Each square is 1 m wide"),
        ("joints", "Parts of the body without a joint"),
        ("verification", "Every avatar lifts"),
    ):
        open_capture(page, server, walk, tab)
        expect(page.get_by_text(sign)).to_be_visible(timeout=PATIENCE_MS)
        assert axe(page) == []
        screenshot(page, f"capture-{tab}-{scheme}")
