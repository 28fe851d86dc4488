"""Accessibility of one page: every enabled rule, or in another theme those of colours."""

from playwright.sync_api import Page

from tests.support.browser import MOVEMENTS_DONE, RUN_AXE
from tests.support.chromium_binary import axe_script

COLOUR_RULES = ("color-contrast", "link-in-text-block")
RUN_AXE_ON_COLOURS = f"""async () => await axe.run(document, {{
  preload: false, runOnly: {{ type: "rule", values: {list(COLOUR_RULES)} }},
}})"""


def violations(page: Page, *, colours_only: bool) -> dict[str, str]:
    """Return the violated rules of any impact, each with its elements."""
    page.evaluate(MOVEMENTS_DONE)
    if not page.evaluate("'axe' in window"):
        page.evaluate(axe_script().read_text(encoding="utf-8"))
    result = page.evaluate(RUN_AXE_ON_COLOURS if colours_only else RUN_AXE)
    return {
        one["id"]: f"{one['id']} ({one['impact']}) "
        + "; ".join(" ".join(map(str, node["target"])) for node in one["nodes"][:4])
        for one in result["violations"]
    }
