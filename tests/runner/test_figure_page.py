"""Tests of `./run bench all`: every benchmark once, and the tables that it writes."""

from datetime import date
from typing import Any

import pytest

from tests.benchmarks.__main__ import NAMES, main
from tests.benchmarks.figure_page import BEGIN, END, BenchmarkFailed, run_all, written
from tests.benchmarks.report import Figure, Report

DAY = date(2026, 11, 29)
PAGE = "# Benchmarks\n\nWritten by hand.\n"


def report(name: str) -> dict[str, Any]:
    """Return the report of a benchmark with a met limit, a missed one and a peer."""
    if name == "broken":
        raise BenchmarkFailed("no browser")
    made = Report(name)
    made.figures = [
        Figure("forms", "p95", 40.0, "ms", "limit", 50.0),
        Figure("forms", "rate | sent", 1234.5, "1/s", "at least", 2000.0),
        Figure("start", "peak", 0.1234, "GiB", "oTree", 0.5),
    ]
    return made.as_json()


def test_the_page_has_value_peer_ratio_and_verdict_of_each_figure() -> None:
    """A figure's row has its value, its peer or limit, the ratio of the two, and if it is met."""
    page = written(PAGE, run_all(["desk"], report), DAY)
    assert page.startswith(PAGE)
    assert "| forms | p95 | 40 ms | limit | 50 | 0.80 | yes |" in page
    assert "| forms | rate \\| sent | 1,234 1/s | at least | 2,000 | 0.62 | **no** |" in page
    assert "| start | peak | 0.123 GiB | oTree | 0.5 | 0.25 |  |" in page


def test_writing_again_changes_only_what_was_run() -> None:
    """Tables of other benchmarks stay, and a table is replaced rather than written twice."""
    first = written(PAGE, run_all(["desk", "start"], report), DAY)
    second = written(first, run_all(["start"], report), date(2026, 12, 1))
    assert second.count("### desk") == second.count("### start") == 1
    assert (second.count("2026-11-29"), second.count("2026-12-01")) == (1, 1)
    assert (second.count(BEGIN), second.count(END)) == (1, 1)
    assert written(second, run_all([], report), DAY) == second


def test_a_benchmark_that_fails_is_listed_and_the_others_go_on() -> None:
    """A failed benchmark has its reason in the page and in the JSON; later ones are run."""
    found = run_all(["broken", "desk"], report)
    assert found.as_json()["failed"] == {"broken": "no browser"}
    assert [one["part"] for one in found.as_json()["figures"]] == [
        "desk: forms",
        "desk: forms",
        "desk: start",
    ]
    assert "### broken\n\nFailed on 2026-11-29: no browser" in written(PAGE, found, DAY)


def test_only_benchmarks_have_names(capfd: pytest.CaptureFixture[str]) -> None:
    """No helper is offered as a benchmark, and an unknown one is refused with those there are."""
    assert not {"__main__", "figure_page", "report", "against"} & set(NAMES)
    assert main(["all", "--only", "desks"]) == 2
    assert "no benchmark desks" in capfd.readouterr().err
