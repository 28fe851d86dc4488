"""Browser tests of a tablet's form that is filled in before the application has been loaded."""

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest
from playwright.sync_api import Locator, Page, Route, expect

from tests.e2e.people import PATIENCE_MS
from tests.e2e.test_tablet_offline import ARE_KEPT, FORM, KEPT, code_for, entered
from tests.features.record.headset.site import Site
from tests.support.browser import ColorScheme, PageWatch, accessibility_violations

APPLICATION = re.compile(r"/assets/main-[^/]*\.js$")
# What is seen and heard of each part of the form, without the ids that are generated.
PARTS = """() => [...document.querySelectorAll("main :is(h1, p, [data-name], [data-name] *)")].map(
    (one) => {
        const { x, y, width, height } = one.getBoundingClientRect();
        const { color, backgroundColor, font } = getComputedStyle(one);
        const told = (one.getAttribute("aria-labelledby") ?? "").split(" ")
            .map((id) => document.getElementById(id)?.textContent);
        const generated = ["id", "name", "aria-labelledby", "aria-describedby", "checked"];
        const attributes = [...one.attributes].filter(({ name }) => !generated.includes(name))
            .map(({ name, value }) => `${name}=${value}`).sort();
        const text = one.children.length === 0 ? one.textContent : "";
        return [one.tagName, ...attributes, text, ...told, one.checked, x, y, width, height,
            color, backgroundColor, font].join(" ");
    })"""
LANDSCAPE, PORTRAIT, PHONE = (1180, 820), (820, 1180), (390, 844)


class Tablet:
    """A paired tablet at a form, whose application is loaded when the test says so."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self._held: list[Route] = []

    @contextmanager
    def without_application(self) -> Iterator[None]:
        """Open the page anew, with its form; its application arrives at the end of the block."""
        with self.held_application():
            expect(self.questions.first).to_be_visible()
            expect(self.next).to_have_count(0)
            yield

    @contextmanager
    def held_application(self) -> Iterator[None]:
        """Open the page anew; its application was asked for, and arrives at the block's end."""
        self.page.route(APPLICATION, lambda route: self._held.append(route))
        self.page.reload()
        while not self._held:
            self.page.wait_for_timeout(20)
        yield
        while self._held:
            self._held.pop().continue_()
        self.page.unroute(APPLICATION)

    @property
    def questions(self) -> Locator:
        """Return the questions on the page."""
        return self.page.locator("[data-name]")

    @property
    def next(self) -> Locator:
        """Return the button of the application that leads to the next page."""
        return self.page.get_by_role("button", name=re.compile("^(Next|Weiter)$"))

    def option(self, question: int, value: int) -> Locator:
        """Return an option as it is seen: its label."""
        return self.questions.nth(question).locator(f'label:has(input[value="{value}"])')

    def parts(self) -> list[str]:
        """Return what each part of the form is, where it is and how it looks."""
        found: list[str] = self.page.evaluate(PARTS)
        return found


@pytest.fixture
def open_tablet(
    headset_site: Site, page_factory: Callable[..., Page], page_watch: PageWatch
) -> Callable[..., Tablet]:
    """Provide a function that pairs a tablet with a session at a form of five pages."""

    def opened(
        size: tuple[int, int] = LANDSCAPE, scheme: ColorScheme = "light", kind: str = "people"
    ) -> Tablet:
        session_id = headset_site.join(kind=kind)
        headset_site.skip_to(session_id, FORM)
        # The worker would answer from its cache, where no test can hold the application back.
        page = page_factory(size, scheme, service_workers="block")
        code = code_for(headset_site, session_id)
        page.goto(f"{headset_site.server.url}/tablet?code={code}")
        tablet = Tablet(page)
        expect(tablet.next).to_be_visible()
        return tablet

    return opened


@pytest.mark.parametrize(
    ("size", "scheme", "language", "presses", "kind"),
    [
        (LANDSCAPE, "light", "English", 0, "people"),
        (LANDSCAPE, "light", "Deutsch", 1, "simulated"),
        (PORTRAIT, "dark", "Deutsch", 0, "simulated"),
        (PORTRAIT, "dark", "English", 1, "people"),
    ],
)
def test_the_application_draws_what_is_there_before_it(
    open_tablet: Callable[..., Tablet],
    size: tuple[int, int],
    scheme: ColorScheme,
    language: str,
    presses: int,
    kind: str,
) -> None:
    """Before and after the application has come, the form is the same, and nothing moves."""
    tablet = open_tablet(size, scheme, kind)
    tablet.page.get_by_text(language, exact=True).click()
    for _ in range(presses):
        tablet.page.get_by_role("button", name=re.compile("%")).click()
    expect(
        tablet.page.locator(f"html[lang={'de' if language == 'Deutsch' else 'en'}]")
    ).to_have_count(1)
    with tablet.without_application():
        tablet.option(1, 6).click()
        before = tablet.parts()
        assert accessibility_violations(tablet.page) == []
    expect(tablet.next).to_be_visible()
    tablet.page.mouse.move(0, 0)
    assert tablet.parts() == before


def test_a_form_that_would_move_waits_for_the_application(
    open_tablet: Callable[..., Tablet],
) -> None:
    """On a phone, where the bar has several lines, the form comes with the application."""
    tablet = open_tablet(PHONE)
    with tablet.held_application():
        expect(tablet.questions).to_have_count(0)
    expect(tablet.next).to_be_visible()


def test_answers_before_the_application_are_kept_and_continued(
    open_tablet: Callable[..., Tablet],
) -> None:
    """They survive a reload without it, can be changed by keyboard, and keep the focus."""
    tablet = open_tablet()
    page = tablet.page
    with tablet.without_application():
        tablet.option(0, 2).click()
        page.keyboard.press("ArrowRight")
        tablet.option(1, 7).click()
        page.wait_for_function(ARE_KEPT, arg=2, timeout=PATIENCE_MS)
    expect(tablet.next).to_be_visible()
    chosen = page.locator("[data-name] input:checked")
    assert [one.input_value() for one in chosen.all()] == ["3", "7"]
    expect(tablet.questions.nth(1).locator('input[value="7"]')).to_be_focused()
    kept = page.evaluate(KEPT)
    assert sorted(entered(kept).values()) == ["3", "7"]
    (form,) = kept["kept"]
    assert sorted(one["changes"] for one in form["draft"]["traces"].values()) == [0, 1]
    tablet.option(2, 4).click()
    tablet.next.click()
    expect(page.get_by_text("Page 2 of 5")).to_be_visible()
    with tablet.without_application():
        expect(page.get_by_text("Page 2 of 5")).to_be_visible()
        tablet.option(0, 5).click()
    expect(tablet.next).to_be_visible()
    page.wait_for_function(ARE_KEPT, arg=4, timeout=PATIENCE_MS)
    assert page.evaluate(KEPT)["kept"][0]["idempotencyKey"] == form["idempotencyKey"]


def test_a_press_during_which_the_application_comes_is_not_lost(
    open_tablet: Callable[..., Tablet],
) -> None:
    """What is pressed is replaced only after it has been released."""
    tablet = open_tablet()
    with tablet.without_application():
        box = tablet.option(0, 6).bounding_box()
        assert box is not None
        tablet.page.mouse.move(box["x"] + 10, box["y"] + 10)
        tablet.page.mouse.down()
    tablet.page.wait_for_timeout(500)
    tablet.page.mouse.up()
    expect(tablet.next).to_be_visible()
    expect(tablet.questions.first.locator('input[value="6"]')).to_be_checked()


def test_an_application_that_does_not_load_is_fetched_again(
    open_tablet: Callable[..., Tablet], page_watch: PageWatch
) -> None:
    """The page is reloaded once the server answers, and shows what was filled in."""
    page_watch.allow("Failed to (load|fetch)")
    tablet = open_tablet()
    page = tablet.page
    page.route(APPLICATION, lambda route: route.abort())
    page.reload()
    tablet.option(0, 2).click()
    page.wait_for_function(ARE_KEPT, arg=1, timeout=PATIENCE_MS)
    page.unroute(APPLICATION)
    expect(tablet.next).to_be_visible()
    expect(tablet.questions.first.locator('input[value="2"]')).to_be_checked()
