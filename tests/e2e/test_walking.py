"""Browser test of predicting the walking time along a drawn path."""

from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS
from tests.features.movement.walking.walkers import FLOOR, SMALL, table
from tests.support.browser import ContextFactory, PageWatch, in_both_schemes
from tests.support.server import ADMIN_PASSWORD, LiveServer


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    """Provide one server for the tests of this file."""
    with LiveServer(tmp_path_factory.mktemp("walking")) as server:
        yield server


def test_a_drawn_path_gets_a_distribution_of_durations(
    server: LiveServer,
    new_context: ContextFactory,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    page_watch: PageWatch,
) -> None:
    """A path drawn with the mouse and edited by keyboard gets a distribution of durations.

    Changes can be undone, and an obstacle in the way is reported.
    """
    page_watch.allow(r"status of 422")
    context = new_context((1180, 820), "light")
    with server.client() as admin:
        admin.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD})
        admin.post("/api/walking/scenes", json={"text": FLOOR})
        origin = {"kind": "population", "population": "students", "people": 2, "repetitions": 2}
        wish = {"title": "Made up", "origin": origin | {"scene": "floor"}}
        walks = admin.post("/api/walking/walk-sets", json=wish, timeout=60.0).json()
        order = {"title": "Small", "walk_set_id": walks["id"], "options": SMALL}
        admin.post("/api/walking/models", json=order)
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
    for width, height in ((1280, 800), (1180, 820)):
        page.set_viewport_size({"width": width, "height": height})
        for scheme in in_both_schemes(page):
            assert axe(page) == [], (width, scheme)
            screenshot(page, f"walk-sets-{width}-{scheme}")
