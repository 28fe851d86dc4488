"""A browser test of what comes from elsewhere: an avatar's file, and another avatar."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.support.server import LiveServer

AVATAR = "#/avatars/standard"
UNSAVED = "1 unsaved change"


def test_a_file_is_exported_edited_refused_and_imported(
    page_factory: Callable[..., Page],
    running_server: LiveServer,
    tmp_path: Path,
    screenshot: Callable[[Page, str], object],
    axe: Callable[[Page], list[str]],
) -> None:
    """What is no configuration is refused with its reason and changes nothing.

    A file that was edited outside shows its differences before it replaces anything.
    """
    page, url = page_factory((1280, 800)), running_server.url
    Experimenter(page, url).log_in()
    page.goto(f"{url}/{AVATAR}")
    page.get_by_role("tab", name="Versions and files").click(timeout=PATIENCE_MS)
    with page.expect_download() as download:
        page.get_by_role("link", name="Download JSON").first.click()
    exported = tmp_path / "exported.json"
    download.value.save_as(exported)
    tree: dict[str, Any] = json.loads(exported.read_text())
    head = page.get_by_role("status").first
    unchanged = head.inner_text()
    name = "my \u202egnp\U0001f9be file with a long name " + "x" * 60 + ".json"
    file = tmp_path / name

    def choose(text: str) -> None:
        file.write_text(text)
        with page.expect_file_chooser() as chooser:
            page.get_by_role("button", name="Load a JSON file").click()
        chooser.value.set_files(file)

    wrong = dict(tree["axes"]["HeadX"], low_deg=90)
    for text, reason in (
        ('{"asset": {"version": "2.0"}}', "This is no avatar configuration"),
        (exported.read_text()[:500], "This is not JSON"),
        (json.dumps({**tree, "version": 2}), "this release reads version 1"),
        (json.dumps({**tree, "total_mass_kg": float("nan")}), "NaN is not a finite number"),
        (json.dumps({**tree, "gravitiy": True}), "Did you mean 'gravity'?"),
        (json.dumps({**tree, "axes": {**tree["axes"], "HeadX": wrong}}), "axes.HeadX.low_deg"),
        ("[" + " " * 10_000_000 + "]", "It has 10 MB; the file of an avatar has at most 262 kB"),
    ):
        choose(text)
        expect(page.get_by_text(reason)).to_be_visible(timeout=PATIENCE_MS)
        expect(page.get_by_text("so nothing was changed")).to_be_visible()
        assert head.inner_text() == unchanged
    screenshot(page, "avatar-file-refused")
    assert axe(page) == []
    choose(json.dumps({**tree, "total_mass_kg": 61.5}))
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("The file replaces 1 value of your work", timeout=PATIENCE_MS)
    expect(dialog).to_contain_text("61.5")
    assert head.inner_text() == unchanged
    screenshot(page, "avatar-file-imported")
    assert axe(page) == []
    dialog.get_by_role("button", name="Replace my work").click()
    expect(page.get_by_text(UNSAVED, exact=True)).to_be_visible(timeout=PATIENCE_MS)
    page.keyboard.press("Control+z")
    expect(page.get_by_text(UNSAVED, exact=True)).to_have_count(0)
    taken_from_another_avatar(page, url, tree, axe)


def taken_from_another_avatar(
    page: Page, url: str, tree: dict[str, Any], axe: Callable[[Page], list[str]]
) -> None:
    """A group takes the gains of another avatar, and nothing else; one edit takes them back."""
    foot = tree["axes"]["LeftFootX"] | {"kp_nm_per_rad": 33.0, "high_deg": 12.0}
    head = tree["axes"]["HeadX"] | {"kp_nm_per_rad": 44.0}
    made = tree | {"axes": tree["axes"] | {"LeftFootX": foot, "HeadX": head}}
    # A title and a note are text, whatever they contain; only the beginning of a note is a heading.
    title = "<b>Preset</b> \U0001f9be"
    note = "Soft <i>foot</i>. Made to be taken over."
    preset = {"key": "preset", "title": title, "origin": "by_hand", "note": note}
    answer = page.request.post(f"{url}/api/avatars", data=preset | {"configuration": made})
    assert answer.status == 201, answer.text()
    page.reload()
    page.get_by_role("tab", name="Versions and files").click(timeout=PATIENCE_MS)
    form = page.get_by_role("form", name="From another avatar")
    form.get_by_role("combobox", name="Avatar and version").click(timeout=PATIENCE_MS)
    page.get_by_role("option", name=f"{title}, version 1", exact=True).click()
    form.get_by_role("button", name="Compare").click()
    panel = page.get_by_role("region", name="From another avatar")
    expect(panel.get_by_role("row")).to_have_count(1 + 3, timeout=PATIENCE_MS)
    assert axe(page) == []
    form.get_by_role("combobox", name="What to take").click()
    page.get_by_role("option", name="left leg", exact=True).click()
    form.get_by_role("button", name="Take over").click()
    expect(page.get_by_text(UNSAVED, exact=True)).to_be_visible(timeout=PATIENCE_MS)
    expect(panel.get_by_role("row")).to_have_count(1 + 2)
    page.keyboard.press("Control+z")
    expect(page.get_by_text(UNSAVED, exact=True)).to_have_count(0)
    form.get_by_role("combobox", name="What to take").click()
    page.get_by_role("option", name="everything", exact=True).click()
    form.get_by_role("button", name="Take over").click()
    expect(page.get_by_text("3 unsaved changes", exact=True)).to_be_visible(timeout=PATIENCE_MS)
    page.keyboard.press("Control+z")
    page.goto(f"{url}/#/avatars/preset/1")
    page.get_by_text("Whole note").click(timeout=PATIENCE_MS)
    expect(page.get_by_text(note, exact=True)).to_be_visible()
