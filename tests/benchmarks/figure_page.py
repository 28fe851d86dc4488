"""All benchmarks one after the other, and the tables of docs/benchmarks.md that they make.

Each benchmark runs in a process of its own, so none measures with another's memory or loaded
modules. One that fails is listed with its reason, and the others go on. The tables stand between
two marks at the end of the page; what is written above them is not touched, and neither are the
tables of benchmarks that were not run this time.
"""

import json
import re
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date
from pathlib import Path
from typing import Any

REPOSITORY = Path(__file__).resolve().parents[2]
PAGE = REPOSITORY / "docs" / "benchmarks.md"
ALL = "all"
BEGIN, END = "<!-- figures: begin -->", "<!-- figures: end -->"
INTRODUCTION = """\
## Figures of the newest runs

Made by `./run bench all --write`; do not edit. `--only NAME` runs one benchmark and leaves the
tables of the others as they are. A ratio is the value by that of the peer or limit, measured in the
same run.
"""
COLUMNS = ("part", "figure", "value", "peer or limit", "its value", "ratio", "met")
LONGEST_REASON = 300
_TABLE = re.compile(r"^### (\S+)\n", re.MULTILINE)
Run = Callable[[str], dict[str, Any]]
"""Runs a benchmark and returns its report as JSON."""


class BenchmarkFailed(RuntimeError):
    """Raised if a benchmark ended without figures; the message is the last line that it wrote."""


@dataclass
class AllReports:
    """The reports of several benchmarks by name, and why others have none."""

    reports: dict[str, dict[str, Any]] = field(default_factory=dict)
    failed: dict[str, str] = field(default_factory=dict)

    def as_json(self) -> dict[str, Any]:
        """Return all figures in the shape of one benchmark; a part is `BENCHMARK: PART`."""
        figures = [
            {**figure, "part": f"{name}: {figure['part']}"}
            for name, report in self.reports.items()
            for figure in report["figures"]
        ]
        machines = [report["machine"] for report in self.reports.values()]
        head = {"benchmark": ALL, "machine": machines[0] if machines else None}
        return {**head, "figures": figures, "failed": self.failed}


def run_all(names: Sequence[str], run: Run) -> AllReports:
    """Run benchmarks one after the other."""
    found = AllReports()
    for name in names:
        print(f"./run bench {name}", file=sys.stderr)
        try:
            found.reports[name] = run(name)
        except BenchmarkFailed as error:
            print(f"  failed: {error}", file=sys.stderr)
            found.failed[name] = str(error)
    return found


def run_one(name: str) -> dict[str, Any]:
    """Run a benchmark in a process of its own; its progress goes to standard error."""
    command = [sys.executable, "-m", "tests.benchmarks", name, "--json"]
    done = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=False)
    sys.stderr.write(done.stderr)
    if done.returncode != 0:
        said = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
        raise BenchmarkFailed(said[-1][:LONGEST_REASON])
    report: dict[str, Any] = json.loads(done.stdout)
    return report


def written(page: str, found: AllReports, today: date) -> str:
    """Return the page with the tables of these reports in place of their previous ones."""
    before, _, rest = page.partition(BEGIN)
    tables = _tables(rest.partition(END)[0])
    after = rest.partition(END)[2]
    for name, report in found.reports.items():
        tables[name] = table(report, today)
    for name, reason in found.failed.items():
        tables[name] = f"Failed on {today.isoformat()}: {_cell(reason)}"
    parts = [f"### {name}\n\n{tables[name]}" for name in sorted(tables)]
    body = "\n\n".join([INTRODUCTION.strip(), *parts])
    return f"{before.rstrip()}\n\n{BEGIN}\n{body}\n{END}\n{after.lstrip()}"


def _tables(section: str) -> dict[str, str]:
    pieces = _TABLE.split(section)
    return {name: text.strip() for name, text in zip(pieces[1::2], pieces[2::2], strict=True)}


def table(report: Mapping[str, Any], today: date) -> str:
    """Return a benchmark's figures as a table below the machine that they were measured on."""
    about = report["machine"]
    machine = (
        f"{today.isoformat()}, {about['cores']} cores of {about['cpu']}, {about['system']}, "
        f"Python {about['python']}, load {about['load_average_1min']} before."
    )
    rows = [_row(figure) for figure in report["figures"]]
    head = f"| {' | '.join(COLUMNS)} |\n{'|---' * len(COLUMNS)}|"
    return "\n".join([machine, "", head, *rows])


def _row(figure: Mapping[str, Any]) -> str:
    met = {True: "yes", False: "**no**", None: ""}[figure["met"]]
    ratio = "" if figure["ratio"] is None else f"{figure['ratio']:.2f}"
    cells = [
        figure["part"],
        figure["name"],
        f"{_number(figure['value'])} {figure['unit']}".strip(),
        figure["peer"],
        _number(figure["peer_value"]),
        ratio,
        met,
    ]
    return f"| {' | '.join(map(_cell, cells))} |"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")


def _number(value: float | None) -> str:
    if value is None:
        return ""
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.3g}"
