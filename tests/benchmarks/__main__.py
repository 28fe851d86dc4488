"""`./run bench NAME [--json]` runs a benchmark of this folder and prints its figures.

Those with a load take its duration (`--seconds`, `--minutes`).
"""

import argparse
import importlib
import json
import signal
import sys
from pathlib import Path

from tests.benchmarks.report import Report, as_table

HERE = Path(__file__).parent
NAMES = sorted(path.stem for path in HERE.glob("*.py") if "def measure(" in path.read_text())
TERMINATED = 128 + signal.SIGTERM


def main(arguments: list[str]) -> int:
    """Run what was asked for; 2 on an unknown name."""
    parser = argparse.ArgumentParser(prog="./run bench", description="Measure.")
    parser.add_argument("name", choices=NAMES, help="which benchmark")
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    parser.add_argument("--only", action="append", help="only these parts; may be repeated")
    duration = parser.add_mutually_exclusive_group()
    duration.add_argument("--seconds", type=float, help="how long a load lasts, where there is one")
    duration.add_argument("--minutes", type=float, help="the same in minutes")
    parser.add_argument("--runs", type=int, help="how often, where all is done several times")
    parser.add_argument("--write", action="store_true", help="store what the product ships of it")
    asked = parser.parse_args(arguments)
    # Whoever ends a benchmark ends its servers too.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(TERMINATED))
    benchmark = importlib.import_module(f"tests.benchmarks.{asked.name}")
    given: dict[str, float | bool] = {"write": True} if asked.write else {}
    if asked.seconds or asked.minutes:
        given["duration_s"] = asked.seconds or 60.0 * asked.minutes
    if asked.runs:
        given["runs"] = asked.runs
    report: Report = benchmark.measure(frozenset(asked.only or benchmark.PARTS), **given)
    print(json.dumps(report.as_json(), indent=2) if asked.json else as_table(report))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
