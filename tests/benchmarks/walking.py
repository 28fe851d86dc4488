"""Measure the walking model: planner and maps (`walking_maps`), and draws (`walking_sampling`)."""

from tests.benchmarks import walking_maps, walking_sampling
from tests.benchmarks.report import Report

FIGURES = {
    "planner": walking_maps.planner_figures,
    "maps": walking_maps.map_figures,
    "sampling": walking_sampling.sampling_figures,
}
PARTS = tuple(FIGURES)


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts; their duration cannot be chosen."""
    report = Report("walking")
    for part, figures in FIGURES.items():
        if part in parts:
            report.add(*figures())
    return report
