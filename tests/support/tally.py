"""A pytest plugin that writes what a run came to, for `./run test` to add up."""

import json
import os
from dataclasses import asdict, dataclass, field
from pathlib import Path

import pytest
from _pytest.terminal import TerminalReporter

TALLY_VARIABLE = "REEMBODY_TEST_TALLY"


@dataclass
class Tally:
    """Counts of one run or of several; an error outside a test's own body counts as failed."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    skips: list[tuple[str, str]] = field(default_factory=list)

    def add(self, other: "Tally") -> None:
        """Count `other` in."""
        self.passed += other.passed
        self.failed += other.failed
        self.skipped += other.skipped
        self.skips += other.skips

    @classmethod
    def read(cls, path: Path) -> "Tally":
        """What a run wrote; nothing if it did not get that far."""
        return cls(**json.loads(path.read_text())) if path.exists() else cls()


def pytest_terminal_summary(terminalreporter: TerminalReporter) -> None:
    """Write the tally to the file that the variable names."""
    stats = terminalreporter.stats
    skips = [(report.nodeid, _reason(report)) for report in stats.get("skipped", [])]
    tally = Tally(
        passed=len(stats.get("passed", [])) + len(stats.get("xfailed", [])),
        failed=len(stats.get("failed", [])) + len(stats.get("error", [])),
        skipped=len(skips),
        skips=skips,
    )
    if os.environ.get(TALLY_VARIABLE):
        Path(os.environ[TALLY_VARIABLE]).write_text(json.dumps(asdict(tally)))


def _reason(report: pytest.TestReport | pytest.CollectReport) -> str:
    if isinstance(report.longrepr, tuple):
        return report.longrepr[2].removeprefix("Skipped: ")
    return str(report.longrepr)
