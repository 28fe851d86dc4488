"""Fifty headsets at once: until when everything is safe and shown, and what it costs."""

import tempfile
from pathlib import Path

from tests.benchmarks.load.figures import load_figures
from tests.benchmarks.load.scenario import Load, run_load
from tests.benchmarks.report import Report

PARTS = ("load",)
DURATION_S = 600.0


def measure(parts: frozenset[str], duration_s: float = DURATION_S) -> Report:
    """Measure the named parts, in a scratch folder."""
    report = Report("telemetry")
    with tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch:
        folder = Path(scratch)
        if "load" in parts:
            outcome = run_load(folder / "load", Load(duration_s=duration_s))
            report.add(*load_figures("load", outcome))
    return report
