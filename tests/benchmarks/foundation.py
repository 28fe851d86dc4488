"""Measure the time to the first page, the durable acknowledgement and the export."""

import tempfile
from pathlib import Path

from tests.benchmarks.acknowledgement import figures as acknowledgement_figures
from tests.benchmarks.exporting import figures as export_figures
from tests.benchmarks.report import Report
from tests.benchmarks.starting import figures as start_figures

PARTS = ("start", "telemetry", "export")


def measure(parts: frozenset[str]) -> Report:
    """Measure the named parts, in a scratch folder."""
    report = Report("foundation")
    with tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch:
        folder = Path(scratch)
        if "telemetry" in parts:
            report.add(*acknowledgement_figures(folder / "telemetry"))
        if "export" in parts:
            report.add(*export_figures(folder / "export"))
        if "start" in parts:
            report.add(*start_figures(folder / "start"))
    return report
