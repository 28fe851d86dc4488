"""One look at one page: accessibility, overflow, shifted layout and errors.

Zoom is what a browser's own zoom does to a page: the window has fewer CSS pixels, and each is drawn
with more of the screen's.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.cookies import SimpleCookie
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, BrowserContext, Page, ViewportSize
from playwright.sync_api import TimeoutError as NotInTime

from tests.benchmarks.every_page.accessibility import COLOUR_RULES, violations
from tests.benchmarks.every_page.lab import FilledLab
from tests.benchmarks.every_page.routes import Route
from tests.support.browser import (
    MOVEMENTS_DONE,
    PageWatch,
    in_both_schemes,
    take_screenshot,
)
from tests.support.traffic import Traffic

HEIGHTS_PX = {390: 844, 820: 1180, 1280: 800, 1920: 1080}
WIDTHS_PX = tuple(HEIGHTS_PX)
ZOOMS = (1, 2)
DRAWN_WITHIN_MS = 20_000
SETTLES_WITHIN_S = 45.0
SHIFT_LIMIT = 0.05

# The blank page that a window opens with has no storage.
FORGET = """
if (location.protocol !== "about:") { localStorage.clear(); sessionStorage.clear(); }
"""
OBSERVE_SHIFTS = """
window.layoutShift = 0;
window.shifted = new Set();
new PerformanceObserver((list) => {
  for (const entry of list.getEntries()) {
    if (entry.hadRecentInput) continue;
    window.layoutShift += entry.value;
    for (const { node } of entry.sources) {
      const place = node instanceof Element ? node : node?.parentElement;
      const styles = place?.getAttribute("class") ?? "";
      if (place) window.shifted.add(`${place.tagName.toLowerCase()}.${styles}`);
    }
  }
}).observe({ type: "layout-shift", buffered: true });
"""
DRAWN = """() => {
  const height_px = document.documentElement.clientHeight;
  const inWindow = (one) => one.getBoundingClientRect().top < height_px;
  const busy = [...document.querySelectorAll('.mantine-Loader-root, [aria-busy="true"]')];
  return document.querySelector("h1, h2, form") !== null && !busy.some(inWindow);
}"""
# The elements that reach beyond the window and lie in nothing that scrolls: the innermost ones.
OVERFLOW = """() => {
  const window_px = document.documentElement.clientWidth;
  const overflow_px = Math.max(0, document.documentElement.scrollWidth - window_px);
  const scrolls = (one) => one !== document.body && one !== document.documentElement
    && getComputedStyle(one).overflowX !== "visible";
  const inScroller = (one) => {
    for (let up = one.parentElement; up !== null; up = up.parentElement)
      if (scrolls(up)) return true;
    return false;
  };
  const out = overflow_px === 0 ? [] : [...document.body.querySelectorAll("*")].filter((one) => {
    const box = one.getBoundingClientRect();
    return box.width > 0 && box.right > window_px + 0.5 && !inScroller(one);
  });
  const inner = out.filter((one) => !out.some((other) => other !== one && one.contains(other)));
  const name = (one) => `${one.tagName.toLowerCase()}.${one.getAttribute("class") ?? ""}`
    + ` "${(one.textContent ?? "").trim().slice(0, 30)}" to `
    + `${Math.round(one.getBoundingClientRect().right)}`;
  return { overflow_px, widest: inner.slice(0, 6).map(name) };
}"""


@dataclass(frozen=True)
class Row:
    """What one look at a page found."""

    route: str
    width: int
    theme: str
    zoom: int
    axe: int
    """Violated rules of any impact."""
    overflow_px: int
    """By how much the page is wider than the window, in CSS pixels."""
    shift: float
    """The sum of the layout shifts of the load (unitless, as web.dev/cls defines it)."""
    errors: int
    """Console errors, uncaught exceptions, and 1 if the page still loads after twenty seconds."""
    found: tuple[str, ...] = field(default=(), compare=False)
    """What it was: rules with elements, elements that overflow, those that shifted, errors."""

    @property
    def sound(self) -> bool:
        """Return whether nothing is above its limit."""
        return not (self.axe or self.overflow_px or self.errors) and self.shift <= SHIFT_LIMIT

    def as_json(self) -> dict[str, Any]:
        """Return the row with the figures alone."""
        names = ("route", "width", "theme", "zoom", "axe", "overflow_px", "shift", "errors")
        return {name: getattr(self, name) for name in names}


@dataclass(frozen=True)
class Window:
    """A browser window of one reader, in which page after page is looked at.

    Its pages share what the browser has fetched and compiled, as a reader's do, but nothing that
    they stored: each is looked at as if it were the first.
    """

    context: BrowserContext
    lab: FilledLab
    width_px: int
    """Of the window, in pixels of the screen; the page has `width_px / zoom` CSS pixels."""
    zoom: int
    watch: PageWatch = field(default_factory=PageWatch)

    def looks(self, route: Route, pictures: Path | None = None) -> Iterator[Row]:
        """Load a page once and look at it in both themes, which are switched in place."""
        self.watch.problems.clear()
        page = self.context.new_page()
        try:
            traffic = Traffic(page)
            page.goto(self.lab.server.url + route.address(self.lab.places))
            traffic.settle(SETTLES_WITHIN_S)
            late = []
            if not (route.waits or page.evaluate(DRAWN)):
                late = [] if _is_drawn(page) else ["still loading"]
                traffic.settle(SETTLES_WITHIN_S)
            page.evaluate(MOVEMENTS_DONE)
            shift, shifted = page.evaluate("[window.layoutShift, [...window.shifted]]")
            rules: dict[str, str] = {}
            for at, theme in enumerate(in_both_schemes(page)):
                # Another theme changes colours only, so only their rules are checked again.
                found = violations(page, colours_only=at > 0)
                of_theme = {**rules, **found} if at > 0 else found
                rules = {rule: text for rule, text in found.items() if rule not in COLOUR_RULES}
                out = page.evaluate(OVERFLOW)
                errors = [*self._errors(route), *late]
                if pictures is not None:
                    name = f"{route.name}-{self.width_px}-{100 * self.zoom}-{theme}"
                    take_screenshot(page, pictures, re.sub(r"\W+", "-", name).strip("-"))
                moved = [f"shifted {name}" for name in shifted]
                yield Row(
                    route=route.name,
                    width=self.width_px,
                    theme=theme,
                    zoom=100 * self.zoom,
                    axe=len(of_theme),
                    overflow_px=round(out["overflow_px"]),
                    shift=round(shift, 4),
                    errors=len(errors),
                    found=(*of_theme.values(), *out["widest"], *moved, *errors),
                )
        finally:
            page.close()

    def _errors(self, route: Route) -> list[str]:
        """Return the errors so far that do not belong to the page."""
        return [
            problem
            for problem in self.watch.problems
            if not route.allowed or re.search(route.allowed, problem) is None
        ]


@contextmanager
def opened_window(
    browser: Browser, lab: FilledLab, reader: str, width_px: int, zoom: int
) -> Iterator[Window]:
    """Open a window with the cookies of `reader`, one of `FilledLab.cookies`, or of nobody."""
    height_px = HEIGHTS_PX.get(width_px, 800)
    context = browser.new_context(
        viewport=ViewportSize(width=width_px // zoom, height=height_px // zoom),
        device_scale_factor=zoom,
        reduced_motion="reduce",
        locale="en-US",
        service_workers="block",
    )
    try:
        context.add_init_script(FORGET)
        context.add_init_script(OBSERVE_SHIFTS)
        for name, morsel in SimpleCookie(lab.cookies.get(reader, "")).items():
            context.add_cookies([{"name": name, "value": morsel.value, "url": lab.server.url}])
        window = Window(context, lab, width_px, zoom)
        window.watch.attach(context)
        yield window
    finally:
        context.close()


def _is_drawn(page: Page) -> bool:
    """Wait for a heading or a form, and for everything in the window to be loaded."""
    try:
        page.wait_for_function(DRAWN, timeout=DRAWN_WITHIN_MS)
    except NotInTime:
        return False
    return True
