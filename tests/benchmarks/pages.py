"""Look at every page at every size: accessibility, overflow, shifted layout and errors.

Every route of the console, the tablet and the headset's start page is loaded on a server with
twelve simulated sessions, in windows of 390, 820, 1280 and 1920 px at 100 and 200 % zoom, and
examined in both themes. `--only ROUTE` looks at one page, `--widths 390,1280` at some widths. With
`REEMBODY_SCREENSHOTS=FOLDER` every page is also drawn.
"""

import itertools
import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tests.benchmarks.every_page.lab import filled_lab
from tests.benchmarks.every_page.routes import ROUTES, forgotten_paths
from tests.benchmarks.every_page.visit import SHIFT_LIMIT, WIDTHS_PX, ZOOMS, Row, opened_window
from tests.benchmarks.report import Figure, Report
from tests.support.browser import launched_browser

READERS = tuple(dict.fromkeys(route.reader for route in ROUTES))
PARTS = tuple(route.name for route in ROUTES)
SCREENSHOTS_VARIABLE = "REEMBODY_SCREENSHOTS"


def measure(parts: frozenset[str], widths: Sequence[int] = WIDTHS_PX) -> Report:
    """Look at the named routes in windows of these widths (px)."""
    report = Report("pages")
    chosen = os.environ.get(SCREENSHOTS_VARIABLE)
    rows: list[Row] = []
    with (
        tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch,
        filled_lab(Path(scratch)) as lab,
        launched_browser() as browser,
    ):
        for width_px, zoom, reader in itertools.product(widths, ZOOMS, READERS):
            asked = [one for one in ROUTES if one.reader == reader and one.name in parts]
            if not asked:
                continue
            with opened_window(browser, lab, reader, width_px, zoom) as window:
                for route in asked:
                    for row in window.looks(route, Path(chosen) if chosen else None):
                        _tell(row)
                        rows.append(row)
    for route in ROUTES:
        of_route = [row for row in rows if row.route == route.name]
        if of_route:
            report.add(*_figures(route.name, of_route))
    forgotten = forgotten_paths()
    report.add(Figure("console", "routes not looked at", len(forgotten), "", "at most", 0))
    report.beside = {
        "not_looked_at": forgotten,
        "rows": [row.as_json() for row in rows],
        "found": [
            {"route": row.route, "width": row.width, "theme": row.theme, "zoom": row.zoom}
            | {"what": list(row.found)}
            for row in rows
            if row.found and not row.sound
        ],
    }
    return report


def _figures(route: str, rows: Sequence[Row]) -> tuple[Figure, ...]:
    """Return the worst of each figure over the sizes and themes of a route."""
    return (
        Figure(route, "axe", max(row.axe for row in rows), "rules", "at most", 0),
        Figure(route, "overflow", max(row.overflow_px for row in rows), "px", "at most", 0),
        Figure(route, "shift", max(row.shift for row in rows), "", "at most", SHIFT_LIMIT),
        Figure(route, "errors", max(row.errors for row in rows), "", "at most", 0),
    )


def _tell(row: Row) -> None:
    if not row.sound:
        place = f"{row.route} {row.width} px {row.zoom} % {row.theme}"
        figures = f"axe {row.axe}, overflow {row.overflow_px} px, shift {row.shift}"
        found = "".join(f"\n    {one}" for one in row.found)
        print(f"{place}: {figures}, errors {row.errors}{found}", file=sys.stderr, flush=True)
