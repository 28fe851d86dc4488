"""`./run bench NAME [--json]` runs a benchmark of this folder and prints its figures.

Benchmarks with a load accept its duration (`--seconds`, `--minutes`). With `--against COMMIT` the
result is instead the ratio of this tree's processor time to COMMIT's (`against`). However a
benchmark ends, its servers end with it. `all` runs every benchmark, for hours, and with `--write`
makes the tables of docs/benchmarks.md (`figure_page`).
"""

import argparse
import importlib
import json
import re
import signal
import sys
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from tests.benchmarks.against import PAIRS, compare
from tests.benchmarks.figure_page import ALL, PAGE, run_all, run_one, table, written
from tests.benchmarks.report import CannotMeasure, Report, as_table
from tests.support.warden import is_warded, run_warded

HERE = Path(__file__).parent
REPOSITORY = HERE.parents[1]
NAMES = sorted(
    path.stem
    for path in HERE.glob("*.py")
    if re.search(r"^def measure\(", path.read_text(encoding="utf-8"), re.MULTILINE)
)
TERMINATED = 128 + signal.SIGTERM
USAGE_ERROR = 2
EPILOGUE = """\
JSON: {"benchmark", "machine", "figures": [{"part", "name", "value", "unit", "peer", "peer_value",
"ratio", "limit", "met"}]}; with --against also "against", "pairs", "ratio_median", "ratio_low",
"ratio_high", "ratio_confidence" and "workload_differs". A ratio below 1 means that this tree takes
less processor time (user and system, of all processes of the benchmark).
"""


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    made = argparse.ArgumentParser(
        prog="./run bench",
        description="Run a benchmark and print its figures.",
        epilog=EPILOGUE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    made.add_argument("name", choices=[ALL, *NAMES], help=f"the benchmark to run, or {ALL}")
    made.add_argument("--json", action="store_true", help="print the figures as JSON")
    made.add_argument(
        "--only",
        action="append",
        metavar="PART",
        help=f"this part, of {ALL} this benchmark; may be repeated",
    )
    duration = made.add_mutually_exclusive_group()
    duration.add_argument("--seconds", type=float, help="duration of the load, if there is one")
    duration.add_argument("--minutes", type=float, help="duration of the load in minutes")
    made.add_argument("--runs", type=int, help="number of runs, if there are several")
    made.add_argument(
        "--widths", type=_widths, metavar="PX,PX", help="windows of these widths, if there are any"
    )
    made.add_argument(
        "--write",
        action="store_true",
        help=f"store the result that the product ships, of {ALL} the tables of docs/benchmarks.md",
    )
    made.add_argument("--against", metavar="COMMIT", help="compare with COMMIT, in pairs of runs")
    made.add_argument("--pairs", type=int, default=PAIRS, help=f"how many pairs ({PAIRS})")
    return made


def _widths(text: str) -> tuple[int, ...]:
    """Read `390,1280`."""
    return tuple(int(one) for one in text.split(","))


def main(arguments: Sequence[str]) -> int:
    """Run the requested benchmark; return 2 for an unknown name, part or commit."""
    asked = parser().parse_args(arguments)
    # Interrupting a benchmark ends its servers too.
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: sys.exit(TERMINATED))
    if asked.against is None and not is_warded():
        command = [sys.executable, "-m", "tests.benchmarks", *arguments]
        return run_warded(command, folder=REPOSITORY).exit_code
    try:
        if asked.name == ALL:
            return _measure_all(asked)
        report = _measured(asked) if asked.against is None else compare(asked)
    except CannotMeasure as error:
        print(f"./run bench: {error}", file=sys.stderr)
        return USAGE_ERROR
    print(json.dumps(report.as_json(), indent=2) if asked.json else as_table(report))
    return 0


def _measure_all(asked: argparse.Namespace) -> int:
    """Run several benchmarks; return 1 if one of them failed."""
    unknown = sorted(set(asked.only or ()) - set(NAMES))
    if unknown:
        raise CannotMeasure(f"no benchmark {unknown[0]}; there are {', '.join(NAMES)}")
    if asked.against is not None:
        raise CannotMeasure(f"--against compares one benchmark, not {ALL}: name it")
    today = datetime.now().astimezone().date()
    found = run_all([name for name in NAMES if name in (asked.only or NAMES)], run_one)
    if asked.write:
        page = written(PAGE.read_text(encoding="utf-8"), found, today)
        PAGE.write_text(page, encoding="utf-8")
    if asked.json:
        print(json.dumps(found.as_json(), indent=2))
    else:
        for name, report in found.reports.items():
            print(f"### {name}\n\n{table(report, today)}\n")
    return 1 if found.failed else 0


def _measured(asked: argparse.Namespace) -> Report:
    benchmark = importlib.import_module(f"tests.benchmarks.{asked.name}")
    unknown = sorted(set(asked.only or ()) - set(benchmark.PARTS))
    if unknown:
        raise CannotMeasure(f"no part {unknown[0]}; {asked.name} has {', '.join(benchmark.PARTS)}")
    given: dict[str, Any] = {"write": True} if asked.write else {}
    if asked.seconds or asked.minutes:
        given["duration_s"] = asked.seconds or 60.0 * asked.minutes
    if asked.widths:
        given["widths"] = asked.widths
    if asked.runs:
        given["runs"] = asked.runs
    report: Report = benchmark.measure(frozenset(asked.only or benchmark.PARTS), **given)
    return report


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)
