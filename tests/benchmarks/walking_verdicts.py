"""Decide from the figures which results of the paper reproduce."""

from collections.abc import Iterator, Sequence

import numpy as np

from app.science.walking.evaluation import Evaluation
from tests.benchmarks.walking_cells import Studied
from tests.benchmarks.walking_replication import Replication

MOST_CELLS = 0.8
LIMITS = (0.5, 5.5, 0.05, 0.17)
"""Mean and sd of neighbours left out, of nodes left out, in percent: about the paper's own."""
LONG_SHARE = 0.05


def verdicts(populations: Sequence[Studied], one: Replication) -> str:
    """Return a list with a verdict on each statement of the paper."""
    found = [cell.evaluation for studied in populations for cell in studied.cells]
    lines = [*_models(found), *_parts(one)]
    return "\n".join(f"- {line}" for line in lines)


def _models(found: list[Evaluation]) -> Iterator[str]:
    adapt = _share(one.crps_ratio("adapt", "stat") < 1.0 for one in found)
    yield (
        "*Parameters that depend on path and person predict better than static ones.*"
        f" {_verdict(holds=adapt >= MOST_CELLS)}: P_adapt errs less than P_stat in"
        f" {_cells(adapt, found)}."
    )
    single = _share(one.errors("prob").median_s < one.errors("adapt").median_s for one in found)
    yield (
        "*Drawn parameters predict better than the most suitable ones, by the median error of one"
        f" draw.* {_verdict(holds=single >= MOST_CELLS)}: so it is in {_cells(single, found)}. A"
        " draw from the true distribution errs by about sqrt 2 times as much as the distribution's"
        " median, so by this measure a better model of variety loses."
    )
    prob = _share(one.crps_ratio("prob", "adapt") < 1.0 for one in found)
    stat = _share(one.crps_ratio("prob", "stat") < 1.0 for one in found)
    gain = 100.0 * (1.0 - float(np.median([one.crps_ratio("prob", "adapt") for one in found])))
    yield (
        "*Drawn parameters reproduce variety, and are closest to reality.*"
        f" {_verdict(holds=min(prob, stat) >= MOST_CELLS)} by a proper score, CRPS: P_prob is"
        " better than P_adapt in"
        f" {_cells(prob, found)}, by {gain:.0f} % in the median, and than P_stat in"
        f" {_cells(stat, found)}. Closest among these three, that is, which are variants of one"
        " model: they are compared with other ways to predict travel times, on real people, in the"
        " next section."
    )


def _parts(one: Replication) -> Iterator[str]:
    papers = np.mean([part.outcomes["prob"].mean_crps_s for part in one.by_papers_reading])
    own = [cell.evaluation for cell in one.studied.cells[1:]]
    chosen = np.mean([part.outcomes["prob"].mean_crps_s for part in own])
    yield (
        "*Suitability 1 - m / max(m) serves as a density.* "
        f"{_verdict(holds=bool(papers <= 1.1 * chosen))}: in both workplaces together P_prob has a"
        f" CRPS of {papers:.3f} s by the paper's reading, {chosen:.3f} s by the one"
        " chosen on the training people. The paper suspects itself that barely suitable parameters"
        " are drawn too often."
    )
    left = (one.neighbours.mean, one.neighbours.sd, one.nodes.mean, one.nodes.sd)
    within = all(abs(value) <= limit for value, limit in zip(left, LIMITS, strict=True))
    yield (
        f"*Errors of both interpolations.* {_verdict(holds=within)}. They say how smooth the space"
        f" is: for maps of people left out the deviation is {one.people.sd:.1f} instead of"
        f" {one.neighbours.sd:.1f} %."
    )
    best = min(one.sweep, key=lambda near: near.crps_s)
    most = max(near.k for near in one.sweep)
    yield (
        f"*The more neighbours the better.* {_verdict(holds=best.k == most)}: CRPS is smallest"
        f" at k = {best.k}. Beyond it, walks unlike the question are mixed in. The time grows"
        " linearly in k, and so it does in the paper's own figures, which call it exponential."
    )
    whole, *parts = one.submodels
    helps = [part for part in parts if part.crps_s > 1.02 * whole.crps_s]
    told = ", ".join(
        f"{part.without} {100.0 * (part.crps_s / whole.crps_s - 1.0):+.0f} %" for part in parts
    )
    yield (
        f"*Each parameter improves the result.* {_verdict(holds=len(helps) == len(parts))}: CRPS in"
        f" workplace 1 changes without each by {told}. Nothing about curvature follows from this:"
        f" {_straight(one)} of the walks there lead along a straight line of two points, on which"
        " turning is zero and the angular velocity has no effect."
    )
    off = [abs(walk.prob_s[0] / walk.reference_s[0] - 1.0) for walk in one.long_walks]
    yield (
        "*Medians over 10, 25 and 50 m within 5 %, with the walks' own spread.*"
        f" {_verdict(holds=max(off) <= LONG_SHARE)}: P_prob's medians are off by at most"
        f" {100.0 * max(off):.1f} %."
    )


def _straight(one: Replication) -> str:
    walks = one.studied.workplaces[0]
    straight = sum(len(entry.path.points_m) == 2 for entry in walks)
    return f"all {straight}" if straight == len(walks) else f"{straight} of {len(walks)}"


def _verdict(*, holds: bool) -> str:
    return "**Reproduces**" if holds else "**Does not reproduce**"


def _share(flags: Iterator[bool]) -> float:
    return float(np.mean(list(flags)))


def _cells(share: float, found: list[Evaluation]) -> str:
    return f"{round(share * len(found))} of {len(found)} cells"
