"""Measure how often each test rejects without an effect, and the coverage of intervals.

On simulated data sets of the study's design (`tests.benchmarks.null_data`): 12, 18 and 24
participants in equal parts; participants differ in level, or also in how they react to latency.
2,004 sets of the first kind and 504 of the second, three times as many for tests that are quick to
compute. Every set has its own seed, so the figures are the same with any number of processes. It
runs two processes and takes about four minutes on two free cores.

Each rate has a limit: at most 5 % plus three standard errors for exact tests, at most 6.5 % for the
others, at least 93.5 % for intervals. With `--write` the table shipped with the product and the
page of the documentation are rewritten; it cannot be combined with `--only`.
"""

import json
import multiprocessing
import os
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, replace
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from app.science.statistics import LEAST_COVERAGE, LEVEL, MOST_REJECTIONS, ErrorRate, ErrorRates
from tests.benchmarks.null_data import NullDesign, null_data, population_alpha
from tests.benchmarks.null_tests import ABOUT, GROUPS
from tests.benchmarks.report import Figure, Report

PARTS = tuple(GROUPS)
SEED = 20201112
SIZES = (12, 18, 24)
_QUICK = ("ranks", "means", "intervals")
SETS = {
    "level": {part: 2004 if part in _QUICK else 668 for part in PARTS},
    "reactions": {part: 668 if part in _QUICK else 168 for part in PARTS},
}
"""Data sets of each size."""
REACTION = {"level": 0.0, "reactions": 0.8}
CHUNK = 42
WORKERS = 2
REPOSITORY = Path(__file__).resolve().parents[2]
TABLE = REPOSITORY / "app" / "science" / "statistics" / "error_rates.json"
PAGE = REPOSITORY / "docs" / "statistics-error-rates.md"
HEAD = """# Error rates of the tests

Made by `./run bench error_rates --write`; do not edit. Simulated data sets in which nothing has an
effect, of {sizes} participants in equal parts, three latencies, two limbs, seed {seed}. An item is
answered from 1 to 7, mostly with agreement, so ties abound. *Level*: participants differ in level.
*Reactions*: they also differ in how they react to latency, while answers to each latency have the
same distribution over people. Then the orders of a participant's values are not equally likely, as
rank tests assume, and models without slopes for participants are wrong.

Tests at 5 %, intervals of 95 %; rates are in per cent with one standard error, over all data sets
and by number of participants. Exact tests guarantee at most 5 % if participants differ in level.
The product's pages warn if a test rejects in less than 4 or more than 6.5 %, or an interval covers
the true value in less than 93.5 %; such figures are marked here. *Not made*: data sets on which a
model did not converge, in addition to those counted.

Not measured: McDonald's omega (a hundred of its bootstraps take minutes), analyses between groups.
"""
MARKS = {
    "": "",
    "rejects_too_often": " (too often)",
    "rejects_too_seldom": " (too seldom)",
    "covers_too_seldom": " (too seldom)",
}


class Task(NamedTuple):
    """A run of data sets of one kind; each has its own seed, independent of the run."""

    scenario: str
    participants: int
    first: int
    sets: int
    part: str
    alpha: float


def measure(
    parts: frozenset[str], duration_s: float | None = None, *, write: bool = False
) -> Report:
    """Measure the named parts; their duration cannot be chosen."""
    chosen = tuple(part for part in PARTS if part in parts)
    if write and chosen != PARTS:
        sys.exit("The table is written whole; leave --only away.")
    counts: Counter[tuple[str, str, int, str]] = Counter()
    tasks = list(_tasks(chosen))
    # Threads of numerical libraries would compete for two cores.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    with ProcessPoolExecutor(WORKERS, multiprocessing.get_context("spawn")) as pool:
        for done, found in enumerate(pool.map(_work, tasks), 1):
            counts.update(found)
            print(f"  {done} of {len(tasks)} runs", end="\r", file=sys.stderr, flush=True)
    design = asdict(NullDesign(0)) | {"participants": SIZES, "reaction": REACTION}
    table = ErrorRates(SEED, design, tuple(_rows(counts)))
    if write:
        TABLE.write_text(stored(table), encoding="utf-8")
        PAGE.write_text(page(table), encoding="utf-8")
    report = Report("error_rates")
    report.add(*(_figure(row) for row in table.rows if not row.participants))
    return report


def stored(table: ErrorRates) -> str:
    """Return the table as JSON for the product, one row per line."""
    rows = ",\n".join(json.dumps(asdict(row)) for row in table.rows)
    head = f'"seed": {table.seed},\n"design": {json.dumps(table.design)}'
    return f'{{\n{head},\n"rows": [\n{rows}\n]\n}}\n'


def page(table: ErrorRates) -> str:
    """Return the table for readers, as Markdown."""
    sizes = [str(size) for size in SIZES]
    lines = [HEAD.format(sizes=", ".join(sizes), seed=table.seed)]
    for scenario in SETS:
        lines += [f"## {scenario.capitalize()}", ""]
        lines.append(f"| Test | on | exact | all | {' | '.join(sizes)} | data sets | not made |")
        lines.append("|---|---|---|---|" + "---|" * len(SIZES) + "---|---|")
        lines += [_line(table, name, scenario) for name in ABOUT]
        lines.append("")
    return "\n".join(lines).rstrip() + "\n"


def _line(table: ErrorRates, name: str, scenario: str) -> str:
    rows = [table.of(name, scenario, size) for size in (0, *SIZES)]
    joint, about = rows[0], ABOUT[name]
    if joint is None:
        return f"| {about.title} | {about.measure} |  | not measured |"
    rates = " | ".join(_cell(row) for row in rows)
    exact = "yes" if joint.exact else ""
    counts = f"{joint.sets:,} | {joint.failed or ''}"
    return f"| {about.title} | {about.measure} | {exact} | {rates} | {counts} |"


def _cell(row: ErrorRate | None) -> str:
    if row is None or not row.sets:
        return "-"
    mark = MARKS[row.warning] if not row.participants else ""
    return f"{100 * row.rate:.1f} ± {100 * row.standard_error:.1f}{mark}"


def _tasks(parts: tuple[str, ...]) -> Iterator[Task]:
    alpha = population_alpha(NullDesign(0), np.random.default_rng(SEED))
    for scenario, sets in SETS.items():
        for part, participants in product(parts, SIZES):
            for first in range(0, sets[part], CHUNK):
                count = min(CHUNK, sets[part] - first)
                yield Task(scenario, participants, first, count, part, alpha)


def _work(task: Task) -> Counter[tuple[str, str, int, str]]:
    """Count how often each test was computed, failed, and rejected (or contained the truth)."""
    design = replace(NullDesign(task.participants), reaction=REACTION[task.scenario])
    counts: Counter[tuple[str, str, int, str]] = Counter()
    for number in range(task.first, task.first + task.sets):
        seed = [SEED, list(SETS).index(task.scenario), task.participants, number]
        data = null_data(design, np.random.default_rng(seed))
        rng = np.random.default_rng([*seed, PARTS.index(task.part)])
        for name, outcome in GROUPS[task.part](data, task.alpha, rng):
            kind = "failed" if outcome is None else "made"
            counts[name, task.scenario, task.participants, kind] += 1
            counts[name, task.scenario, task.participants, "hits"] += bool(outcome)
    return counts


def _rows(counts: Counter[tuple[str, str, int, str]]) -> Iterator[ErrorRate]:
    for scenario in SETS:
        for name, about in ABOUT.items():
            for sizes in (SIZES, *((size,) for size in SIZES)):
                made, failed, hits = (
                    sum(counts[name, scenario, size, kind] for size in sizes)
                    for kind in ("made", "failed", "hits")
                )
                if made + failed:
                    yield ErrorRate(
                        test=name,
                        scenario=scenario,
                        measure=about.measure,
                        kind=about.kind,
                        exact=about.exact and scenario == "level",
                        participants=0 if sizes == SIZES else sizes[0],
                        sets=made,
                        failed=failed,
                        rate=round(hits / made, 6) if made else 0.0,
                    )


def _figure(row: ErrorRate) -> Figure:
    limit = ("at most", MOST_REJECTIONS)
    if row.exact:
        limit = ("at most, 3 SE", LEVEL + 3.0 * float(np.sqrt(LEVEL * (1 - LEVEL) / row.sets)))
    if row.kind == "coverage":
        limit = ("at least", LEAST_COVERAGE)
    peer, value = limit
    return Figure(row.scenario, row.test, 100 * row.rate, "%", peer, 100 * value)
