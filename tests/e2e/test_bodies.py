"""A browser test of bodies: uploaded, looked at, checked, named, and worn by a configuration."""

import re
from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.support.browser import PageWatch
from tests.support.humanoid_files import dog_file, humanoid_file, with_ktx2, with_uastc
from tests.support.humanoid_model import Model, without
from tests.support.server import LiveServer


def test_a_body_is_uploaded_checked_and_named(
    running_server: LiveServer,
    page_factory: Callable[..., Page],
    page_watch: PageWatch,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    tmp_path: Path,
) -> None:
    """A dropped model is measured and drawn, its missing fingers are listed, and it is named once.

    A model of a dog is refused with what it lacks. The model's texture is a KTX2 picture.
    """
    page_watch.allow(r"status of 422")
    page = page_factory((1180, 820))
    Experimenter(page, running_server.url).log_in()
    # A texture that could not be read would be an error of the page.
    (tmp_path / "Worn once.glb").write_bytes(
        humanoid_file(Model(parts=without("Little"), edit=with_ktx2))
    )
    (tmp_path / "dog.glb").write_bytes(dog_file())
    page.goto(f"{running_server.url}/#/bodies")
    expect(page.get_by_role("heading", name="Three statures")).to_be_visible(timeout=PATIENCE_MS)
    # Statures compare best from the front.
    expect(page.locator("canvas[data-side=front]")).to_be_visible(timeout=PATIENCE_MS)
    chosen = page.locator("input[type=file]")
    chosen.set_input_files([tmp_path / "dog.glb", tmp_path / "Worn once.glb"])
    expect(page.get_by_role("alert")).to_contain_text("no LeftUpperArm", timeout=PATIENCE_MS)
    page.get_by_role("link", name="Open Worn once.glb").click(timeout=PATIENCE_MS)
    checks = page.get_by_role("list", name="Checks")
    expect(checks).to_contain_text("8 of 10 fingers")
    expect(page.locator("[data-way=space]")).to_be_visible(timeout=PATIENCE_MS)
    name = page.get_by_label("Name for studies")
    expect(name).to_have_value("worn-once")
    name.fill("Worn Once")
    expect(page.get_by_role("button", name="Give it this name")).to_be_disabled()
    name.fill("worn_once")
    page.keyboard.press("Enter")
    expect(page.get_by_text("is what studies and records call it.")).to_be_visible()
    expect(page.locator("pre")).to_contain_text("body: worn_once")
    page.get_by_text("Save an avatar configuration that wears it").click()
    page.get_by_role("button", name="Save configuration").click()
    expect(page.get_by_text("Saved as worn_once, version 1.")).to_be_visible(timeout=PATIENCE_MS)
    expect(page.get_by_text("worn_once, version 1", exact=True)).to_be_visible()
    assert axe(page) == []
    page.get_by_role("link", name="Bodies").first.click()
    expect(page.get_by_role("list", name="Bodies")).to_contain_text("worn_once")
    assert axe(page) == []
    # Of the figures at three statures: those of a generated walk.
    rows = page.get_by_role("row").filter(has=page.get_by_role("rowheader"))
    expect(rows.first).to_contain_text("130 cm")
    expect(rows.first.get_by_role("cell").first).to_have_text(re.compile(r"\d+\.\d"))
    page.evaluate("scrollTo(0, 0)")
    screenshot(page, "bodies")
    page.get_by_role("link", name="neutral").click()
    expect(page.locator("[data-way=space]")).to_be_visible(timeout=PATIENCE_MS)
    expect(page.get_by_text("Its author lets everybody wear it.")).to_be_visible()
    screenshot(page, "body")


def test_a_body_says_that_its_textures_are_missing(
    running_server: LiveServer,
    page_factory: Callable[..., Page],
    page_watch: PageWatch,
    screenshot: Callable[[Page, str], object],
    tmp_path: Path,
) -> None:
    """A body that is grey because a decoder could not be loaded says so; another try loads it."""
    page_watch.allow("Failed to load resource|Couldn.t load texture")
    page = page_factory((1180, 820))
    Experimenter(page, running_server.url).log_in()
    model = tmp_path / "Compressed.glb"
    model.write_bytes(humanoid_file(Model(parts=without("Little"), edit=with_uastc)))
    page.goto(f"{running_server.url}/#/bodies")
    page.locator("input[type=file]").set_input_files(model)
    page.route("**/basis_transcoder-*", lambda route: route.abort())
    page.get_by_role("link", name="Open Compressed.glb").click()
    told = page.get_by_text("Drawn without one of its textures")
    expect(told).to_contain_text("the decoder of compressed textures (KTX2) could not be loaded")
    expect(page.get_by_role("alert")).to_contain_text("A part of this page could not be loaded")
    screenshot(page, "body-without-textures")
    page.get_by_role("button", name="Later").click()
    page.unroute_all()
    page.get_by_role("button", name="Try again").click()
    expect(told).to_have_count(0)
    expect(page.locator("[data-way=space]")).to_be_visible()
