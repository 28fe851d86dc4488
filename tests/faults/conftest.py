"""Fault tests tell figures; they are printed at the end."""

from _pytest.terminal import TerminalReporter

from tests.faults.figures import as_table, noted, save
from tests.features.conftest import fresh_lab, lab

__all__ = ["fresh_lab", "lab"]


def pytest_terminal_summary(terminalreporter: TerminalReporter) -> None:
    """Print the table of this run."""
    told = noted()
    if told:
        terminalreporter.section("figures of the fault tests")
        for line in as_table(told):
            terminalreporter.write_line(line)
        save(told)
