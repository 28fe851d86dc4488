"""Browser test of predicting the walking time along a drawn path."""

import re
import time
from collections.abc import Callable, Iterator

import httpx2
import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS
from tests.features.movement.walking.walkers import (
    FLOOR,
    SMALL,
    load_of,
    scene_of,
    table,
    with_columns,
)
from tests.support.browser import ContextFactory, PageWatch, in_both_schemes
from tests.support.server import ADMIN_PASSWORD, LiveServer


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    """Provide one server for the tests of this file."""
    with LiveServer(tmp_path_factory.mktemp("walking")) as server:
        yield server


HALL = """key: hall-a
title: A hall
bounds_m: [-2, -2, 4, 8]
"""


def order_loaded_model(admin: httpx2.Client) -> str:
    """Order a model of walks in several scenes that depends on a load, and return its id."""
    admin.post("/api/walking/scenes", json={"text": HALL})
    data = with_columns(scene=scene_of, load_kg=load_of)
    query = {"name": "tracks.csv", "title": "Carried"}
    sent = admin.post("/api/walking/walk-sets/tracks", params=query, content=data, timeout=60.0)
    options = SMALL | {"depends_on": ["load_kg"]}
    order = {"title": "Loads", "walk_set_id": sent.json()["id"], "options": options}
    made = admin.post("/api/walking/models", json=order)
    assert made.status_code == 201, made.text
    return str(made.json()["id"])


def test_a_drawn_path_gets_a_distribution_of_durations(
    server: LiveServer,
    new_context: ContextFactory,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    page_watch: PageWatch,
) -> None:
    """A path drawn with the mouse and edited by keyboard gets a distribution of durations.

    Changes can be undone, and an obstacle in the way is reported. A model that depends on a load
    takes it, or says that it assumes the mean.
    """
    page_watch.allow(r"status of 422")
    context = new_context((1180, 820), "light")
    with server.client() as admin:
        admin.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD})
        admin.post("/api/walking/scenes", json={"text": FLOOR})
        origin = {"kind": "population", "population": "students", "people": 2, "repetitions": 2}
        wish = {"title": "Made up", "origin": origin | {"scene": "floor"}}
        loaded_id = order_loaded_model(admin)
        walks = admin.post("/api/walking/walk-sets", json=wish, timeout=60.0).json()
        order = {"title": "Small", "walk_set_id": walks["id"], "options": SMALL}
        model = admin.post("/api/walking/models", json=order).json()
        for model_id in (loaded_id, model["id"]):
            while (found := admin.get(f"/api/walking/models/{model_id}").json())[
                "state"
            ] != "ready":
                assert found["state"] == "fitting", found["trouble"]
                time.sleep(0.1)
        context.add_cookies(
            [
                {"name": cookie.name, "value": cookie.value or "", "url": server.url}
                for cookie in admin.cookies.jar
            ]
        )
    page = context.new_page()
    page.goto(f"{server.url}/#/walking")
    picture = page.get_by_role("group", name="Car body and three racks, seen from above")
    expect(picture).to_be_visible(timeout=PATIENCE_MS)
    box = picture.bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + 0.35 * box["width"], box["y"] + 0.25 * box["height"])
    page.mouse.click(box["x"] + 0.6 * box["width"], box["y"] + 0.45 * box["height"])
    answer = page.get_by_role("region", name="How long the walk takes")
    expect(answer.get_by_text("90 % of walks:")).to_be_visible(timeout=PATIENCE_MS)
    expect(answer.get_by_text("synthetic", exact=True)).to_be_visible()
    for figure in (
        "Distribution of predicted durations",
        "Steering parameters that suit such a walk",
    ):
        expect(page.get_by_label(figure).locator(".main-svg").first).to_be_visible(
            timeout=PATIENCE_MS
        )
    assert axe(page) == []
    screenshot(page, "walking")
    page.emulate_media(color_scheme="dark")
    assert axe(page) == []
    point = page.get_by_role("button", name="Point 2")
    before = point.get_attribute("aria-label")
    point.press("ArrowUp")
    expect(point).not_to_have_attribute("aria-label", before or "")
    page.get_by_role("button", name="Undo").click()
    expect(point).to_have_attribute("aria-label", before or "")
    page.get_by_text("Points as numbers").click()
    page.get_by_label("x of point 2 in metres").fill("0")
    page.get_by_label("y of point 2 in metres").fill("-1")
    expect(page.get_by_text("inside obstacle 'car'")).to_be_visible(timeout=PATIENCE_MS)
    page.get_by_role("combobox", name="Model", exact=True).click()
    page.get_by_role("option", name="Loads").click()
    page.get_by_role("combobox", name="Scene", exact=True).click()
    page.get_by_role("option", name="A hall").click()
    hall = page.get_by_role("group", name="A hall, seen from above").bounding_box()
    assert hall is not None
    for share in (0.7, 0.5):
        page.mouse.click(hall["x"] + 0.5 * hall["width"], hall["y"] + share * hall["height"])
    expect(answer.get_by_text(re.compile(r"load .* kg \(assumed to be the mean\)"))).to_be_visible(
        timeout=PATIENCE_MS
    )
    page.get_by_label("Load (kg)").fill("9")
    expect(answer.get_by_text("load 9 kg: beyond every walk")).to_be_visible(timeout=PATIENCE_MS)
    for scheme in in_both_schemes(page):
        assert axe(page) == [], scheme
        screenshot(page, f"walking-load-{scheme}")
    page.goto(f"{server.url}/#/walking/models/{loaded_id}")
    facts = page.get_by_text("7 on the open floor, 2 in A hall")
    expect(facts).to_be_visible(timeout=PATIENCE_MS)
    expect(page.get_by_text("mixed without load")).to_be_visible()
    for scheme in in_both_schemes(page):
        assert axe(page) == [], scheme
        screenshot(page, f"walking-loaded-model-{scheme}")


def test_walks_at_an_unlikely_pace_are_doubted_in_the_list(
    server: LiveServer,
    new_context: ContextFactory,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """A set whose times are wrong says so beside its figures; a set as people walk does not."""
    context = new_context((1280, 800))
    rows = [line.split(",") for line in table(5, 4).decode().splitlines()]
    hurried = [rows[0], *([who, str(0.45 * float(t)), *place] for who, t, *place in rows[1:])]
    with server.client() as admin:
        admin.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD})
        order_loaded_model(admin)
        for title, lines in (("At their pace", rows), ("At another rate", hurried)):
            text = "\n".join(",".join(line) for line in lines)
            query = {"name": "tracks.csv", "title": title}
            sent = admin.post("/api/walking/walk-sets/tracks", params=query, content=text.encode())
            assert sent.status_code == 201, sent.text
        context.add_cookies(
            [
                {"name": cookie.name, "value": cookie.value or "", "url": server.url}
                for cookie in admin.cookies.jar
            ]
        )
    page = context.new_page()
    page.goto(f"{server.url}/#/walking/models")
    doubted = page.get_by_role("row", name="At another rate")
    expect(doubted).to_contain_text("Check the unit of x and y", timeout=PATIENCE_MS)
    expect(page.get_by_role("row", name="At their pace")).not_to_contain_text(
        "Check the unit of x and y"
    )
    carried = page.get_by_role("row", name="Carried").filter(has_text="load 0 to 4 kg").first
    expect(carried).to_contain_text("2 in A hall, 2 on the open floor")
    for width, height in ((1280, 800), (1180, 820)):
        page.set_viewport_size({"width": width, "height": height})
        for scheme in in_both_schemes(page):
            assert axe(page) == [], (width, scheme)
            screenshot(page, f"walk-sets-{width}-{scheme}")
