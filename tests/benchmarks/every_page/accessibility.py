"""Accessibility of one page after the other, where what was examined once is not examined again.

Examining takes most of the time of a look. The same page in a wider window is often the same for
every rule: the same elements with the same attributes, shown and hidden alike, scrolling alike, in
the same colours and sizes of text. Then it violates the same rules, and what was found is repeated.
"""

from dataclasses import dataclass, field

from playwright.sync_api import Page

from tests.support.browser import MOVEMENTS_DONE, RUN_AXE
from tests.support.chromium_binary import axe_script

COLOUR_RULES = ("color-contrast", "link-in-text-block")
RUN_AXE_ON_COLOURS = f"""async () => await axe.run(document, {{
  preload: false, runOnly: {{ type: "rule", values: {list(COLOUR_RULES)} }},
}})"""
# Everything that the rules read of a page, as one text. Ids are numbered in their order, since
# some are drawn at random; of a text only matters whether there is one; where something is drawn
# decides nothing.
READ_BY_RULES = r"""() => {
  const PLACES = new Set(["style", "d", "transform", "x", "y", "dx", "dy", "x1", "x2", "y1", "y2",
    "cx", "cy", "r", "width", "height", "points", "viewBox", "clip-path", "data-unformatted"]);
  const ids = new Map();
  for (const one of document.querySelectorAll("[id]")) ids.set(one.id, `#${ids.size}`);
  const named = (value) => value.split(/\s+/)
    .map((word) => ids.get(word.replace(/^#/, "")) ?? word).join(" ");
  const parts = [location.hash];
  for (const one of document.querySelectorAll("*")) {
    if (["SCRIPT", "STYLE", "LINK", "META"].includes(one.tagName)) continue;
    const style = getComputedStyle(one);
    const box = one.getBoundingClientRect();
    const scrolls = style.overflowX !== "visible" && style.overflowX !== "hidden"
      && (one.scrollWidth > one.clientWidth || one.scrollHeight > one.clientHeight);
    const hasText = [...one.childNodes]
      .some((node) => node.nodeType === Node.TEXT_NODE && node.data.trim() !== "");
    parts.push(one.tagName, one.childElementCount, box.width > 0 && box.height > 0, scrolls,
      hasText, style.visibility, style.display, style.opacity, style.color, style.backgroundColor,
      style.backgroundImage, style.fontSize, style.fontWeight, style.textDecorationLine,
      style.position);
    for (const { name, value } of one.attributes)
      if (!PLACES.has(name)) parts.push(name, named(value));
  }
  return parts.join("\u0000");
}"""


@dataclass
class Examiner:
    """Examines pages by every enabled rule, each page once."""

    _found: dict[tuple[bool, int], dict[str, str]] = field(default_factory=dict)
    repeated: int = 0
    """How often what had been found was repeated."""

    def violations(self, page: Page, *, colours_only: bool) -> dict[str, str]:
        """Return the violated rules of any impact, each with its elements."""
        page.evaluate(MOVEMENTS_DONE)
        key = (colours_only, hash(page.evaluate(READ_BY_RULES)))
        if key in self._found:
            self.repeated += 1
        else:
            self._found[key] = _examined(page, colours_only=colours_only)
        return self._found[key]


def _examined(page: Page, *, colours_only: bool) -> dict[str, str]:
    if not page.evaluate("'axe' in window"):
        page.evaluate(axe_script().read_text(encoding="utf-8"))
    result = page.evaluate(RUN_AXE_ON_COLOURS if colours_only else RUN_AXE)
    return {
        one["id"]: f"{one['id']} ({one['impact']}) "
        + "; ".join(" ".join(map(str, node["target"])) for node in one["nodes"][:4])
        for one in result["violations"]
    }
