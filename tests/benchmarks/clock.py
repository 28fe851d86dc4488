"""Measure how well a headset's clock is fitted to the server's, where the truth is known.

Clocks and networks are simulated, so the figures do not depend on the machine; only the fitting
time does.
"""

import sys
import time

import numpy as np

from app.science.clock import fit_clock
from tests.benchmarks.report import Figure, Report
from tests.science.clock.simulated import (
    ASYMMETRIC,
    SLEWING,
    SYMMETRIC,
    Outcome,
    Scenario,
    outcome,
    simulate,
    table,
)

SCENARIOS: dict[str, tuple[Scenario, ...]] = {
    "symmetric": SYMMETRIC,
    "asymmetric": ASYMMETRIC,
    "beyond": (SLEWING,),
}
PARTS = (*SCENARIOS, "fit")
SEED = 1


def measure(parts: frozenset[str]) -> Report:
    """Measure the named parts; the table of all scenarios goes to standard error."""
    report = Report("clock")
    for part, scenarios in SCENARIOS.items():
        if part in parts:
            outcomes = [outcome(one, np.random.default_rng(SEED)) for one in scenarios]
            print(f"{part}\n{table(outcomes)}", file=sys.stderr)
            report.figures += [figure for one in outcomes for figure in _figures(part, one)]
    if "fit" in parts:
        report.figures.append(_fit_time())
    return report


def _figures(part: str, one: Outcome) -> list[Figure]:
    """Return the figures of a scenario with their limits."""
    limit = ("at most", 5.0) if part == "symmetric" else ("", None)
    return [
        Figure(part, f"{one.scenario}: error p50", one.residual_p50_ms, "ms"),
        Figure(part, f"{one.scenario}: error p95", one.residual_p95_ms, "ms", *limit),
        Figure(part, f"{one.scenario}: bound p50", one.bound_p50_ms, "ms"),
        Figure(part, f"{one.scenario}: bound p95", one.bound_p95_ms, "ms"),
        Figure(part, f"{one.scenario}: within", 100 * one.coverage, "%", "at least", 95.0),
        Figure(part, f"{one.scenario}: negative intervals", one.negative, "", "at most", 0.0),
    ]


def _fit_time() -> Figure:
    """Measure the time to fit three hours of probes, one per second."""
    (three_hours,) = [one for one in SYMMETRIC if one.name == "three hours"]
    probes = simulate(three_hours, np.random.default_rng(SEED)).probes
    began_s = time.perf_counter()
    fit_clock(probes)
    return Figure("fit", "3 h of probes, one a second", time.perf_counter() - began_s, "s")
