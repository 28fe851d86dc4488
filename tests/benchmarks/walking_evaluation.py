"""Measure how well the walking model predicts travel times of synthetic and real people.

    ./run bench walking_evaluation [--json]                    the figures with their limits

    .venv/bin/python -m tests.benchmarks.walking_evaluation --write    docs/walking-replication.md

`populations` are the cells of `walking_cells`: P_prob's CRPS at most .9 of P_adapt's and below
P_stat's, P_adapt's below P_stat's, each in 80 % of the cells; the interquartile range of
predictions over that of the walks, median over courses, from .75 to 1.5. `replication` are the
experiments of the paper; of these only the leave-out errors have limits. `ablation` leaves out each
parameter in every population, on all walks at the workplaces and on those that turn. `mixed`
predicts the same synthetic walkers with P_mixed and the baselines; its JSON has `synthetic`, one
row for each cell of `walking_mixed`. `real` needs the shared data: its JSON has `evaluations`, one
row for each model and data set of `walking_people`. On every data set our model's CRPS must not be
larger than the best baseline's by more than the interval over people; on the ten-subject table its
coverages must be within 8 points. Takes a few minutes.
"""

import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np

from tests.benchmarks.report import Figure, Report
from tests.benchmarks.walking_ablation import SETS, ablations, of_set
from tests.benchmarks.walking_cells import Cell, studied
from tests.benchmarks.walking_mixed import mixed_cells
from tests.benchmarks.walking_people import BASELINE_NAMES, OURS, TABLE, Score, less, scores
from tests.benchmarks.walking_real import RealWalks, real_walks, shared_folder
from tests.benchmarks.walking_replication import Replication, replication

DOCUMENT = Path(__file__).resolve().parents[2] / "docs" / "walking-replication.md"
SHARE, RATIO, IQR_LOW, IQR_HIGH = 80.0, 0.9, 0.75, 1.5
POINTS = 8.0
NEIGHBOURS_LIMITS, NODES_LIMITS = (0.5, 5.5), (0.05, 0.17)


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts; their duration cannot be chosen."""
    report = Report("walking_evaluation")
    for part, figures in FIGURES.items():
        if part in parts:
            report.add(*figures())
    if "mixed" in parts:
        report.beside["synthetic"] = [one.as_json() for one in mixed_cells()]
    folder = shared_folder()
    if "real" in parts and folder is not None:
        report.beside["evaluations"] = [one.as_json() for one in scores(folder)]
    return report


def cells() -> list[Cell]:
    """Return all cells of all populations."""
    return [cell for one in studied() for cell in one.cells]


@cache
def repeated() -> Replication:
    """Repeat the paper's experiments on the first population."""
    return replication(studied()[0])


@cache
def real() -> RealWalks | None:
    """Evaluate real walks, or return None if the shared data are not available."""
    folder = shared_folder()
    return None if folder is None else real_walks(folder)


def population_figures() -> Iterator[Figure]:
    """Return the shares of cells within the limits, and the median of interquartile ratios."""
    part, found = "populations", [cell.evaluation for cell in cells()]
    by_adapt = np.array([one.crps_ratio("prob", "adapt") for one in found])
    by_stat = np.array([one.crps_ratio("prob", "stat") for one in found])
    adapt = np.array([one.crps_ratio("adapt", "stat") for one in found])
    yield Figure(part, "cells", float(len(found)), "")
    yield Figure(part, "CRPS prob <= .9 adapt", 100.0 * float((by_adapt <= RATIO).mean()), "%",
                 "at least", SHARE)  # fmt: skip
    yield Figure(part, "CRPS prob / adapt, median", float(np.median(by_adapt)), "", "goal", 0.8)
    yield Figure(part, "CRPS prob / adapt, worst", float(by_adapt.max()), "", "at most", RATIO)
    yield Figure(part, "CRPS prob < stat", 100.0 * float((by_stat < 1.0).mean()), "%",
                 "at least", SHARE)  # fmt: skip
    yield Figure(part, "CRPS adapt < stat", 100.0 * float((adapt < 1.0).mean()), "%",
                 "at least", SHARE)  # fmt: skip
    ratios = [ratio for one in found for ratio in one.iqr_ratios("prob")]
    yield Figure(part, "IQR ratio, median", float(np.median(ratios)), "", "at least", IQR_LOW)
    yield Figure(part, "IQR ratio, median", float(np.median(ratios)), "", "at most", IQR_HIGH)


def mixed_figures() -> Iterator[Figure]:
    """Yield how P_mixed compares with the best baseline on synthetic walkers; without limits."""
    rows = [one.as_json() for one in mixed_cells()]
    gaps = np.array([one["mixed_less_best_95_s"] for one in rows], dtype=np.float64)
    yield Figure("mixed", "cells", float(len(rows)), "")
    yield Figure("mixed", "better than the best baseline, interval below 0",
                 float((gaps[:, 1] < 0.0).sum()), "")  # fmt: skip
    yield Figure("mixed", "worse than the best baseline, interval above 0",
                 float((gaps[:, 0] > 0.0).sum()), "")  # fmt: skip
    for level in ("coverage_50", "coverage_90"):
        inside = np.array([one[level] for one in rows], dtype=np.float64)
        name = f"{level.replace('_', ' of ')} %"
        yield Figure("mixed", f"{name}, least", float(inside.min()), "%")
        yield Figure("mixed", f"{name}, median", float(np.median(inside)), "%")
        yield Figure("mixed", f"{name}, most", float(inside.max()), "%")


def replication_figures() -> Iterator[Figure]:
    """Return the leave-out errors of the prediction by neighbours and by radial bases."""
    one, part = repeated(), "replication"
    for name, left, limits in (
        ("neighbours left out", one.neighbours, NEIGHBOURS_LIMITS),
        ("nodes left out", one.nodes, NODES_LIMITS),
    ):
        yield Figure(part, f"{name}, |mean|", abs(left.mean), "%", "at most", limits[0])
        yield Figure(part, f"{name}, sd", left.sd, "%", "at most", limits[1])
    for near in one.sweep:
        yield Figure(part, f"k = {near.k}, CRPS", near.crps_s, "s")


def ablation_figures() -> Iterator[Figure]:
    """Yield what each parameter is worth, and the best number of neighbours; without limits."""
    for walks_set in SETS:
        found = of_set(ablations(), walks_set)
        part = f"ablation, {walks_set}"
        yield Figure(part, "walks of a population", float(found[0].walks), "")
        for column in zip(*(one.parts for one in found), strict=True):
            name, shares = column[0].parameter, [one.share for one in column]
            yield Figure(
                part, f"CRPS without {name}, median", 100.0 * float(np.median(shares)), "%"
            )
            yield Figure(
                part, f"populations that need {name}", sum(one.helps for one in column), ""
            )
        best = float(np.median([one.best_k for one in found]))
        yield Figure(part, "best number of neighbours, median", best, "")


def real_figures() -> Iterator[Figure]:
    """Yield the errors of predicted speeds and durations, and the CRPS of walks left out."""
    found = real()
    if found is None:
        return
    off = [one.off_sds for one in found.distances]
    yield Figure("real", "peak speed off, worst distance", max(off), "sd", "at most", 1.0)
    errors = [abs(one.predicted_s - one.duration_s) for one in found.distances]
    yield Figure("real", "duration off, median of distances", float(np.median(errors)), "s")
    for name, outcome in found.captures.outcomes.items():
        yield Figure("real", f"CMU walks left out, CRPS {name}", outcome.mean_crps_s, "s")
    yield from left_out_figures()


def left_out_figures() -> Iterator[Figure]:
    """Yield how our model compares with the best baseline on people who were left out."""
    folder = shared_folder()
    if folder is None:
        return
    by_set: dict[str, dict[str, Score]] = {}
    for one in scores(folder):
        by_set.setdefault(one.data.name, {})[one.method] = one
    for name, found in by_set.items():
        best = min((found[own] for own in BASELINE_NAMES), key=lambda one: one.crps_s.mean())
        gap, low, high = less(found[OURS], best)
        about = f"{name}: CRPS ours less {best.method}"
        yield Figure("real", about, gap, "s")
        yield Figure("real", f"{about}, 95 % from", low, "s", "at most", 0.0)
        yield Figure("real", f"{about}, 95 % to", high, "s")
    ours = by_set[TABLE][OURS]
    for level, inside in ((50.0, ours.inside_50), (90.0, ours.inside_90)):
        off = abs(100.0 * float(inside.mean()) - level)
        yield Figure("real", f"{TABLE}: coverage of {level:.0f} % off", off, "points", "at most",
                     POINTS)  # fmt: skip


FIGURES = {
    "populations": population_figures,
    "replication": replication_figures,
    "ablation": ablation_figures,
    "mixed": mixed_figures,
    "real": real_figures,
}
PARTS = tuple(FIGURES)


def main(arguments: list[str]) -> int:
    """Write the replication report with --write; otherwise print it."""
    from tests.benchmarks.walking_report import replication_report

    folder = shared_folder()
    people = () if folder is None else scores(folder)
    text = replication_report(studied(), repeated(), real(), people, mixed_cells(), ablations())
    if "--write" in arguments:
        DOCUMENT.write_text(text, encoding="utf-8")
    else:
        print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
