"""A pytest plugin that writes the counts of a run, for `./run test` to add up."""

import json
import os
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import pytest
from _pytest.terminal import TerminalReporter

TALLY_VARIABLE = "REEMBODY_TEST_TALLY"
SLOWEST = 20


@dataclass
class Tally:
    """Counts of one run or of several; an error outside a test's own body counts as failed.

    `slowest` contains test names and durations in seconds, including fixtures, slowest first.
    """

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    skips: list[tuple[str, str]] = field(default_factory=list)
    slowest: list[tuple[str, float]] = field(default_factory=list)

    def add(self, other: "Tally") -> None:
        """Add the counts of `other`."""
        self.passed += other.passed
        self.failed += other.failed
        self.skipped += other.skipped
        self.skips += other.skips
        both = self.slowest + other.slowest
        self.slowest = sorted(both, key=lambda one: one[1], reverse=True)[:SLOWEST]

    @classmethod
    def read(cls, path: Path) -> "Tally":
        """Read the counts of a run; they are empty if the run wrote none."""
        return cls(**json.loads(path.read_text())) if path.exists() else cls()


def pytest_terminal_summary(terminalreporter: TerminalReporter) -> None:
    """Write the tally to the file that the environment variable names."""
    stats = terminalreporter.stats
    skips = [(report.nodeid, _reason(report)) for report in stats.get("skipped", [])]
    tally = Tally(
        passed=len(stats.get("passed", [])) + len(stats.get("xfailed", [])),
        failed=len(stats.get("failed", [])) + len(stats.get("error", [])),
        skipped=len(skips),
        skips=skips,
        slowest=_slowest(stats),
    )
    if os.environ.get(TALLY_VARIABLE):
        Path(os.environ[TALLY_VARIABLE]).write_text(json.dumps(asdict(tally)))


def _slowest(stats: dict[str, list[Any]]) -> list[tuple[str, float]]:
    """Return the slowest tests, by the sum of setup, call and teardown."""
    durations_s: dict[str, float] = {}
    for report in (one for group in stats.values() for one in group):
        if isinstance(report, pytest.TestReport):
            durations_s[report.nodeid] = durations_s.get(report.nodeid, 0.0) + report.duration
    return sorted(durations_s.items(), key=lambda one: one[1], reverse=True)[:SLOWEST]


def _reason(report: pytest.TestReport | pytest.CollectReport) -> str:
    if isinstance(report.longrepr, tuple):
        return report.longrepr[2].removeprefix("Skipped: ")
    return str(report.longrepr)
