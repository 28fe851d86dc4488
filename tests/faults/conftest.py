"""Print the figures of the fault tests at the end of a run."""

from _pytest.terminal import TerminalReporter

from tests.faults.figures import as_table, noted, save
from tests.features.conftest import fresh_lab, lab

__all__ = ["fresh_lab", "lab"]


def pytest_terminal_summary(terminalreporter: TerminalReporter) -> None:
    """Print the table of this run's figures and save it."""
    told = noted()
    if told:
        terminalreporter.section("figures of the fault tests")
        for line in as_table(told):
            terminalreporter.write_line(line)
        save(told)
