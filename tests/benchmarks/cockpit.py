"""Measure the cockpit and the tablet: frame latency, page weight and the speed of forms.

Parts: `shown` (from a headset's frame to the console's screen), `memory` (server and page while a
session streams; ten minutes, `--minutes 30` for longer), `load` (the first load of both pages),
`tablets` (sixteen send forms, compared with oTree) and `form` (until a form can be filled in,
compared with oTree and jsPsych). The peers are installed on first use, into folders of their own.
"""

import tempfile
from pathlib import Path

from tests.benchmarks.report import Report
from tests.benchmarks.session_desk import first_load, form, memory, shown, tablets

PARTS = ("shown", "memory", "load", "tablets", "form")
MEMORY_S, SHOWN_S = 600.0, 30.0


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts, each on a server of its own."""
    report = Report("cockpit")
    with tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch:
        folder = Path(scratch)
        if "shown" in parts:
            report.add(*shown.figures(folder / "shown", min(duration_s or SHOWN_S, SHOWN_S)))
        if "memory" in parts:
            report.add(*memory.figures(folder / "memory", duration_s or MEMORY_S))
        if "load" in parts:
            report.add(*first_load.figures(folder / "load"))
        if "tablets" in parts:
            report.add(*tablets.figures(folder / "tablets"))
        if "form" in parts:
            report.add(*form.figures(folder / "form"))
    return report
