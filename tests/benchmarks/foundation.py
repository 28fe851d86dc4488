"""The first minute, the durable acknowledgement and the export: what everything else stands on."""

import tempfile
from pathlib import Path

from tests.benchmarks import acknowledgement, exporting, starting
from tests.benchmarks.report import Report

PARTS = ("start", "telemetry", "export")


def measure(parts: frozenset[str]) -> Report:
    """Measure the named parts, in a scratch folder."""
    report = Report("foundation")
    with tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch:
        folder = Path(scratch)
        if "telemetry" in parts:
            report.add(*acknowledgement.figures(folder / "telemetry"))
        if "export" in parts:
            report.add(*exporting.figures(folder / "export"))
        if "start" in parts:
            report.add(*starting.figures(folder / "start"))
    return report
