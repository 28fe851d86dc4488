"""Browser test of the try-out: the physics of a configuration in the page that edits it."""

import re
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import Locator, Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.features.movement.captures.files import walk_bvh
from tests.support.browser import ContextFactory
from tests.support.server import LiveServer
from tests.support.tryout_page import figure, opened_tryout


def test_a_configuration_is_tried_before_it_is_saved(
    running_server: LiveServer,
    new_context: ContextFactory,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    tmp_path: Path,
) -> None:
    """By keys and mouse: a joint swings, a part is pushed and pulled, a box drops, latency shows.

    A change that is not saved is tried at once, a saved version beside it. Nothing fails.
    """
    context = new_context((1280, 800), "light", "en-US", "reduce")
    signed_in = context.new_page()
    Experimenter(signed_in, running_server.url).log_in()
    page = opened_tryout(context, running_server.url, tmp_path)
    expect(page.locator("[data-way=space]")).to_be_visible(timeout=PATIENCE_MS)
    assert axe(page) == []
    # It stands still for a step at a time; the pose of a reset is at rest.
    page.get_by_role("heading", name="Standard").click()
    page.get_by_role("button", name="Pause").focus()
    page.keyboard.press("Enter")
    page.keyboard.press("r")
    speed = page.get_by_text("simulated")
    expect(speed).to_contain_text("0.0 s simulated")
    for _ in range(20):
        page.keyboard.press(".")
        page.wait_for_timeout(60)
    expect(speed).to_contain_text(re.compile(r"^0\.[12] s"))
    # A push by key acts on the shin, for as long as it was asked for.
    page.keyboard.press("p")
    page.keyboard.press(".")
    expect(page.get_by_text("100 N", exact=True)).to_be_visible()
    expect(_mark(page, "push")).to_have_text("Push, 100 N")
    expect(_mark(page, "reset")).to_have_count(1)
    # With the focus nowhere, the space bar plays and does not scroll.
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press(" ")
    assert page.evaluate("window.scrollY") == 0
    expect(page.get_by_role("button", name="Pause")).to_be_visible()
    expect(page.get_by_text("100 N", exact=True)).to_be_hidden()
    # The stiff shin turns by about a degree; it is back within two before the push has ended.
    expect(figure(page, "peak")).to_have_text(re.compile(r"^[01]\.\d°$"))
    expect(figure(page, "return")).to_have_text("0.00 s")
    # The target jumps by 40 degrees every second.
    page.get_by_text("Step", exact=True).click()
    expect(figure(page, "jump")).to_have_text(re.compile(r"^.?(39|40)\.\d°$"))
    expect(figure(page, "rise")).to_have_text(re.compile(r"^0\.[0-4]\d\ss$"))
    expect(figure(page, "settling")).to_have_text(re.compile(r"^0\.\d\d\ss$"))
    expect(figure(page, "overshoot")).to_have_text(re.compile(r"^\d\.\d\s%$"))
    screenshot(page, "tryout-step")
    page.get_by_text("Sine", exact=True).click()
    expect(figure(page, "greatest")).not_to_have_text("–")
    screenshot(page, "tryout-sine")
    # The pointer pulls at the trunk; the camera stays where it is.
    picture = page.get_by_role("img", name="The simulated body")
    box = picture.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + 0.45 * box["height"]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y, steps=3)
    force = page.locator("span", has_text=re.compile(r"^\d+ N$"))
    expect(force).to_be_visible()
    expect(force).to_have_text(re.compile(r"^[1-9]\d+ N$"))
    screenshot(page, "tryout-pull")
    page.mouse.up()
    expect(force).to_be_hidden()
    expect(_mark(page, "pull")).to_have_count(1)
    # The camera goes along by choice only, where less motion is preferred.
    follow = page.get_by_role("switch", name="Follow")
    expect(follow).not_to_be_checked()
    page.keyboard.press("f")
    expect(follow).to_be_checked()
    page.keyboard.press("v")
    page.get_by_role("button", name="Drop a box").click()
    expect(_mark(page, "drop")).to_have_count(1)
    expect(figure(page, "greatest")).not_to_have_text(re.compile(r"^[789]\."))
    # A latency of 125 ms is an error of up to 20 deg * 2 pi / 2 s * 0.125 s = 7.9 deg.
    page.get_by_label("Latency").fill("125")
    expect(figure(page, "greatest")).to_have_text(re.compile(r"^[789]\.\d°$"))
    expect(_mark(page, "latency")).to_have_count(0)
    page.get_by_label("Latency").fill("0")
    expect(_mark(page, "latency")).to_have_text("Latency 0 ms")
    # The working configuration gets a weak motor, the saved one beside it stays as it was.
    time_s = _time_s(speed)
    page.get_by_role("combobox", name="Side by side with").click()
    page.get_by_role("option", name=re.compile("version 2")).click()
    expect(page.get_by_role("columnheader", name="Standard, version 2")).to_have_count(3)
    # Its time and its curves go on.
    assert _time_s(speed) > time_s
    page.evaluate("tryoutPage.change('LeftUpperArmZ', {max_torque_nm: 2})")
    expect(figure(page, "limit")).to_have_text("2.0 N m")
    expect(figure(page, "saturated")).to_have_text(re.compile(r"^[1-9]\d*\s%$"))
    other = _row(page, "Time at the torque limit").get_by_role("cell").last
    expect(other).to_have_text("0 %")
    expect(page.get_by_text(re.compile("at its limit now"))).to_be_visible()
    expect(_mark(page, "change")).to_have_count(1)
    screenshot(page, "tryout-side-by-side")
    assert axe(page) == []
    page.set_viewport_size({"width": 1180, "height": 820})
    page.emulate_media(color_scheme="dark")
    screenshot(page, "tryout-dark-1180")
    assert axe(page) == []
    expect(page.get_by_role("alert")).to_have_count(0)
    expect(page.get_by_text("the simulation failed")).to_have_count(0)


WALKED = 3
"""Metres after which a body has left the picture of a camera that stands."""
COLOURFUL = 80
"""Saturation from which a pixel is no floor, line or word, of 255."""


def test_the_camera_goes_along_with_a_body_that_walks(
    running_server: LiveServer,
    new_context: ContextFactory,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    tmp_path: Path,
) -> None:
    """A capture that walks stays in the picture; without Follow it leaves it, until a key resets.

    The floor grows with the way, and the way is told in metres.
    """
    context = new_context((1180, 820), "dark", "en-US", "no-preference")
    Experimenter(context.new_page(), running_server.url).log_in()
    walk = context.request.post(
        f"{running_server.url}/api/captures",
        params={"name": "a-long-walk.bvh"},
        data=walk_bvh(900),
        headers={"Origin": running_server.url},
    )
    assert walk.status == 201, walk.text()
    page = opened_tryout(context, running_server.url, tmp_path)
    expect(page.locator("[data-way=space]")).to_be_visible(timeout=PATIENCE_MS)
    follow = page.get_by_role("switch", name="Follow")
    expect(follow).to_be_checked()
    page.get_by_role("combobox", name="Play a capture").click()
    page.get_by_role("option").first.click()
    page.get_by_role("heading", name="Standard").click()
    page.get_by_role("button", name="Pause").focus()
    expect(page.get_by_text(re.compile(rf"[{WALKED}-9]\.\d m from the middle"))).to_be_visible()
    page.keyboard.press("Enter")
    assert _stands_in_the_middle(page)
    screenshot(page, "tryout-walk")
    # Left behind, the body is out of the picture, until the view is reset.
    page.keyboard.press("f")
    expect(follow).not_to_be_checked()
    page.keyboard.press("r")
    # The view is reset to where the body is, which is soon back in the middle.
    expect(page.get_by_text("m from the middle")).to_be_hidden(timeout=PATIENCE_MS)
    page.keyboard.press("v")
    page.keyboard.press("Enter")
    expect(page.get_by_text(re.compile(rf"[{WALKED}-9]\.\d m from the middle"))).to_be_visible()
    page.keyboard.press("Enter")
    assert not _stands_in_the_middle(page)
    page.keyboard.press("v")
    assert _stands_in_the_middle(page)
    assert axe(page) == []
    expect(page.get_by_role("alert")).to_have_count(0)


def _stands_in_the_middle(page: Page) -> bool:
    """Return whether something as colourful as a body is in the middle of the picture."""
    # A picture is drawn with the next frame of the page.
    page.wait_for_timeout(200)
    picture = page.get_by_role("img", name="The simulated body").screenshot()
    drawn = Image.open(BytesIO(picture)).convert("HSV")
    width, height = drawn.size
    box = (round(0.4 * width), round(0.3 * height), round(0.6 * width), round(0.7 * height))
    saturation = drawn.crop(box).getchannel("S").histogram()
    return sum(saturation[COLOURFUL:]) > 0.02 * sum(saturation)


def _mark(page: Page, kind: str) -> Locator:
    return page.locator(f"[data-mark={kind}]")


def _time_s(speed: Locator) -> float:
    return float((speed.text_content() or "").split()[0])


def _row(page: Page, name: str) -> Locator:
    return page.get_by_role("row", name=re.compile(name))
