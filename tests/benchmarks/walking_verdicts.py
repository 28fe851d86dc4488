"""Decide from the figures which results of the paper reproduce."""

from collections.abc import Iterator, Sequence

import numpy as np

from app.science.walking.evaluation import Evaluation
from tests.benchmarks.walking_ablation import (
    NEIGHBOURS,
    SETS,
    TURNS_RAD_PER_M,
    Ablation,
    of_set,
)
from tests.benchmarks.walking_cells import Studied
from tests.benchmarks.walking_replication import Replication

MOST_CELLS = 0.8
LIMITS = (0.5, 5.5, 0.05, 0.17)
"""Mean and sd of neighbours left out, of nodes left out, in percent: about the paper's own."""
LONG_SHARE = 0.05


def verdicts(
    populations: Sequence[Studied], one: Replication, ablations: Sequence[Ablation]
) -> str:
    """Return a list with a verdict on each statement of the paper."""
    found = [cell.evaluation for studied in populations for cell in studied.cells]
    lines = [*_models(found), *_parts(one, ablations)]
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


def _parts(one: Replication, ablations: Sequence[Ablation]) -> Iterator[str]:
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
    yield _neighbours(of_set(ablations, SETS[0]))
    yield _each_parameter(of_set(ablations, SETS[1]))
    off = [abs(walk.prob_s[0] / walk.reference_s[0] - 1.0) for walk in one.long_walks]
    yield (
        "*Medians over 10, 25 and 50 m within 5 %, with the walks' own spread.*"
        f" {_verdict(holds=max(off) <= LONG_SHARE)}: P_prob's medians are off by at most"
        f" {100.0 * max(off):.1f} %."
    )


def _neighbours(found: Sequence[Ablation]) -> str:
    most = max(NEIGHBOURS)
    share = _share(one.best_k == most for one in found)
    best = sorted(one.best_k for one in found)
    worse = float(np.median([one.by_k[most] / one.by_k[one.best_k] - 1.0 for one in found]))
    return (
        f"*The more neighbours the better.* {_verdict(holds=share >= MOST_CELLS)}: over both"
        f" workplaces CRPS is smallest at k = {best[0]} to {best[-1]} in the {len(found)}"
        f" populations, and at k = {most} {100.0 * worse:.0f} % larger in the median. Beyond the"
        " best k, walks unlike the question are mixed in. The time grows linearly in k, and so it"
        " does in the paper's own figures, which call it exponential."
    )


def _each_parameter(found: Sequence[Ablation]) -> str:
    """Return the verdict of the walks that turn, on which every parameter can have an effect."""
    names = [part.parameter for part in found[0].parts]
    columns = list(zip(*(one.parts for one in found), strict=True))
    helps = [sum(part.helps for part in column) for column in columns]
    told = ", ".join(
        f"{name} {100.0 * float(np.median([part.share for part in column])):+.0f} % ({count})"
        for name, column, count in zip(names, columns, helps, strict=True)
    )
    holds = all(count >= MOST_CELLS * len(found) for count in helps)
    return (
        f"*Each parameter improves the result.* {_verdict(holds=holds)}: on the walks that turn by"
        f" {TURNS_RAD_PER_M:g} rad/m or more, CRPS changes without each, in the median of"
        f" {len(found)} populations, by {told}. In brackets: in how many populations the"
        " predictions get worse by more than the interval over people."
    )


def _verdict(*, holds: bool) -> str:
    return "**Reproduces**" if holds else "**Does not reproduce**"


def _share(flags: Iterator[bool]) -> float:
    return float(np.mean(list(flags)))


def _cells(share: float, found: list[Evaluation]) -> str:
    return f"{round(share * len(found))} of {len(found)} cells"
