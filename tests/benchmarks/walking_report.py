"""Write the replication report as Markdown, with the paper's tables next to ours."""

from collections.abc import Iterable, Sequence
from typing import cast

import numpy as np

from app.science.walking.evaluation import LEAST_PEOPLE, Evaluation
from app.science.walking.maps import SuitabilityOptions
from app.science.walking.models import FittedWalking
from tests.benchmarks.walking_ablation import NEIGHBOURS, Ablation
from tests.benchmarks.walking_cells import OTHERS, PEOPLE, REPETITIONS, Studied
from tests.benchmarks.walking_mixed import MixedCell
from tests.benchmarks.walking_paper import (
    PAPER_LONG,
    PAPER_PERCENTILES,
    PAPER_SUBMODELS,
    PAPER_SWEEP,
    PAPER_TESTS,
)
from tests.benchmarks.walking_people import BASELINE_NAMES, OURS, Score, less
from tests.benchmarks.walking_real import RealWalks
from tests.benchmarks.walking_replication import Replication
from tests.benchmarks.walking_report_texts import (
    ABLATION,
    FEW_PEOPLE,
    INTRODUCTION,
    LEFT_OUT_PEOPLE,
    MIXED_ON_POPULATIONS,
    READING_OF_RESULTS,
    REAL_PEOPLE,
)
from tests.benchmarks.walking_verdicts import verdicts

FEW = " †"
MODELS = {"stat": "P_stat", "adapt": "P_adapt", "prob": "P_prob"}


def replication_report(
    populations: Sequence[Studied],
    repeated: Replication,
    real: RealWalks | None,
    scores: Sequence[Score],
    mixed: Sequence[MixedCell],
    ablations: Sequence[Ablation],
) -> str:
    """Return the whole document."""
    parts = [
        INTRODUCTION.format(people=PEOPLE, others=OTHERS, times=REPETITIONS),
        "## What reproduces, and what does not\n\n" + verdicts(populations, repeated, ablations),
        *(
            ["## Real people, left out one at a time\n\n" + left_out_people(scores)]
            if scores
            else []
        ),
        "## Populations\n\n" + _populations(populations),
        "## Populations: P_mixed and the baselines\n\n" + mixed_section(mixed),
        *(_workplace(repeated, number) for number in (0, 1)),
        "## Model parameters\n\n" + _submodels(repeated),
        "## Model parameters in all populations\n\n" + ablation_section(ablations),
        "## Interpolation\n\n" + _left_out(repeated),
        "## Neighbours\n\n" + _sweep(repeated) + "\n\n" + neighbours_section(ablations),
        "## Long distances\n\n" + _long_walks(repeated),
        "## Time saved in a work cycle\n\n" + _saved(populations),
        "## Static parameters\n\n" + _static(repeated),
    ]
    if real is not None:
        parts.append("## Real people: the paper's model, fitted on a few\n\n" + _real(real))
    parts.append(READING_OF_RESULTS)
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    named = [cell.replace("|", "\\|") for cell in head]
    lines = ["| " + " | ".join(named) + " |", "|" + " --- |" * len(head)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines)


def _populations(populations: Sequence[Studied]) -> str:
    about = "\n".join(f"- **{one.population.name}**: {one.population.about}" for one in populations)
    rows = []
    for one in populations:
        for cell in one.cells:
            found = cell.evaluation
            crps = [f"{found.outcomes[name].mean_crps_s:.3f}" for name in MODELS]
            half, most = found.coverage("prob")
            rows.append(
                (
                    cell.population,
                    cell.situation,
                    str(len(found.truth_s)),
                    *crps,
                    f"{found.crps_ratio('prob', 'adapt'):.2f}",
                    f"{found.crps_ratio('prob', 'stat'):.2f}",
                    f"{np.median(found.iqr_ratios('prob')):.2f}",
                    f"{100 * half:.0f} / {100 * most:.0f}",
                )
            )
    head = ("population", "situation", "walks", *(f"CRPS {name}, s" for name in MODELS.values()),
            "prob / adapt", "prob / stat", "IQR ratio", "inside 50 / 90 %")  # fmt: skip
    readings = "\n".join(
        f"- {one.population.name}: {_reading(one.fit.reading)}" for one in populations
    )
    ratios = [r for one in populations for c in one.cells for r in c.evaluation.iqr_ratios("prob")]
    overall = f"Median IQR ratio over the courses of all cells: {np.median(ratios):.2f}."
    chosen = f"Readings chosen on the training people:\n\n{readings}"
    return f"{about}\n\n{_table(head, rows)}\n\n{overall}\n\n{chosen}"


def mixed_section(cells: Sequence[MixedCell]) -> str:
    """Return what P_mixed and the baselines do on the walks of the section before."""
    rows = []
    for cell in cells:
        told, outcomes = cell.as_json(), cell.evaluation.outcomes
        low_s, high_s = cast("list[float]", told["mixed_less_best_95_s"])
        gap_s = told["mixed_less_best_s"]
        rows.append(
            (
                cell.population,
                cell.situation,
                *(f"{outcomes[name].mean_crps_s:.3f}" for name in (OURS, *BASELINE_NAMES)),
                f"{cell.best_baseline}: {gap_s:+.3f} ({low_s:+.3f} to {high_s:+.3f})",
                f"{told['coverage_50']:.0f} / {told['coverage_90']:.0f}",
            )
        )
    head = ("population", "situation", "CRPS P_mixed, s",
            *(f"CRPS {name}, s" for name in BASELINE_NAMES),
            "P_mixed less best baseline, s (95 %)", "inside 50 / 90 %")  # fmt: skip
    return f"{MIXED_ON_POPULATIONS}\n{_table(head, rows)}"


def left_out_people(scores: Sequence[Score]) -> str:
    """Return what every model does on real people; intervals over few of them are marked."""
    by_set: dict[str, dict[str, Score]] = {}
    for one in scores:
        by_set.setdefault(one.data.name, {})[one.method] = one
    rows: list[Sequence[str]] = []
    gaps: list[Sequence[str]] = []
    for name, found in by_set.items():
        for method, one in found.items():
            told, mark = one.as_json(), _mark(one)
            cells = [f"{told['crps_s']:.3f} ({_interval(told['crps_s_95'], 3)}){mark}"]
            for share in ("50", "90"):
                inside = f"{told[f'coverage_{share}']:.0f}"
                cells.append(f"{inside} ({_interval(told[f'coverage_{share}_95'], 0)}){mark}"
                             if len(one.crps_s) and told["coverage_90"] else "-")  # fmt: skip
            title = MODELS.get(method, "P_mixed" if method == OURS else method)
            rows.append((name, str(told["walks"]), _people(one), title, *cells))
        best = min((found[own] for own in BASELINE_NAMES), key=lambda one: one.crps_s.mean())
        line, paper = found["line"], found.get("prob")
        gaps.append((
            name, _people(line), f"{best.method}: {_gap(found[OURS], best)}",
            "-" if paper is None else _gap(found[OURS], paper),
            "-" if paper is None else _gap(paper, line),
        ))  # fmt: skip
    head = ("data", "walks", "people", "model", "CRPS, s (95 %)", "inside 50 % (95 %)",
            "inside 90 % (95 %)")  # fmt: skip
    gap_head = ("data", "people", "P_mixed less best baseline, s (95 %)",
                "P_mixed less P_prob, s (95 %)", "P_prob less line, s (95 %)")  # fmt: skip
    note = FEW_PEOPLE.format(mark=FEW, least=LEAST_PEOPLE).strip()
    return f"{LEFT_OUT_PEOPLE}\n{_table(gap_head, gaps)}\n\n{note}\n\n{_table(head, rows)}"


def _people(one: Score) -> str:
    count = len(one.data.walks.persons)
    return str(count) if one.data.ids_are_people else f"{count} numbers"


def _mark(one: Score) -> str:
    return FEW if len(one.data.walks.persons) < LEAST_PEOPLE else ""


def _gap(first: Score, second: Score) -> str:
    gap, low, high = less(first, second)
    return f"{gap:+.3f} ({low:+.3f} to {high:+.3f}){_mark(first)}"


def _interval(bounds: object, digits: int) -> str:
    low, high = cast("list[float]", bounds)
    return f"{low:.{digits}f} to {high:.{digits}f}"


def _workplace(one: Replication, number: int) -> str:
    chosen = one.studied.cells[1 + number].evaluation
    rows: list[Sequence[str]] = []
    for name, title in MODELS.items():
        rows.append((title, "paper", *PAPER_PERCENTILES[number][name], "", ""))
        for told, found in (("ours, paper's reading", one.by_papers_reading[number]),
                            ("ours, chosen reading", chosen)):  # fmt: skip
            errors = found.errors(name)
            cells = [f"{value:.3f}" for value in errors.percentiles_s]
            crps = f"{found.outcomes[name].mean_crps_s:.3f}"
            rows.append((title, told, *cells, _p(errors.shapiro_p), crps))
    head = ("model", "", "5 %", "25 %", "median", "75 %", "95 %", "Shapiro p", "CRPS, s")
    return (
        f"## Workplace {number + 1}: |dt| of one draw, seconds\n\n{_table(head, rows)}\n\n"
        + _tests(chosen, number)
    )


def _tests(found: Evaluation, number: int) -> str:
    rows = [
        (
            f"{MODELS[one.first]} - {MODELS[one.second]}",
            PAPER_TESTS[one.first, one.second][number],
            f"p {_p(one.p)}, power {one.power:.3f}",
            f"{one.difference_s:+.3f}",
        )
        for one in found.comparisons()
    ]
    head = ("Wilcoxon signed-rank, |dt|", "paper", "ours, chosen reading", "mean difference, s")
    return _table(head, rows)


def _submodels(one: Replication) -> str:
    rows = [
        (part.without, PAPER_SUBMODELS[part.without], f"{part.median_s:.3f}", f"{part.crps_s:.3f}")
        for part in one.submodels
    ]
    return _table(("without", "paper, median |dt|", "ours, median |dt|", "ours, CRPS"), rows)


def ablation_section(ablations: Sequence[Ablation]) -> str:
    """Return what each parameter is worth in every population, on all walks and on turning ones."""
    rows = [
        (
            one.population,
            one.walks_set,
            f"{one.walks} of {one.people}",
            f"{one.crps_s:.3f}",
            *(f"{100.0 * part.share:+.0f}{'' if part.helps else ' ns'}" for part in one.parts),
        )
        for one in ablations
    ]
    names = [part.parameter for part in ablations[0].parts]
    head = ("population", "walks", "walks, people", "CRPS, s", *(f"{name}, %" for name in names))
    return f"{ABLATION}\n{_table(head, rows)}"


def neighbours_section(ablations: Sequence[Ablation]) -> str:
    """Return the CRPS by the number of neighbours, in every population."""
    rows = [
        (one.population, one.walks_set, *(f"{value:.3f}" for value in one.by_k.values()))
        for one in ablations
    ]
    head = ("population", "walks, both workplaces", *(f"CRPS k = {k}, s" for k in NEIGHBOURS))
    return _table(head, rows)


def _left_out(one: Replication) -> str:
    rows = [
        ("neighbours, one entry of 5000 left out", "-.434 (5.104)", _left(one.neighbours.mean,
                                                                         one.neighbours.sd)),
        ("radial basis, nodes left out", "-.048 (.172)", _left(one.nodes.mean, one.nodes.sd)),
        ("neighbours, other people only", "", _left(one.people.mean, one.people.sd)),
    ]  # fmt: skip
    return _table(("", "paper, mean (sd), %", "ours"), rows)


def _sweep(one: Replication) -> str:
    rows = [
        (str(near.k), PAPER_SWEEP[near.k], f"{near.median_s:.3f}", f"{near.crps_s:.3f}",
         f"{near.draw_us:.0f}")
        for near in one.sweep
    ]  # fmt: skip
    head = ("k", "paper, median |dt|, s", "ours, median |dt|, s", "ours, CRPS, s",
            "ours, a draw by radial rejection, us")  # fmt: skip
    return _table(head, rows)


def _long_walks(one: Replication) -> str:
    rows = [
        (
            f"{walk.distance_m:g} m",
            *PAPER_LONG[walk.distance_m],
            f"{walk.reference_s[0]:.2f} ({walk.reference_s[1]:.2f})",
            f"{walk.prob_s[0]:.2f} ({walk.prob_s[1]:.2f})",
            f"{walk.stat_s:.2f}",
        )
        for walk in one.long_walks
    ]
    head = ("", "paper: people", "P_prob", "P_stat", "ours: walkers", "P_prob", "P_stat")
    return "Median and interquartile range of travel times, seconds.\n\n" + _table(head, rows)


def _saved(populations: Sequence[Studied]) -> str:
    rows = [
        (
            one.population.name,
            *(f"{cell.evaluation.saved_per_cycle_s('prob', 'stat'):.2f}" for cell in one.cells[1:]),
        )
        for one in populations
    ]
    told = "Of a cycle of 100 s with 20 % walking, by CRPS, P_stat less P_prob; the paper says 2-3."
    return f"{told}\n\n{_table(('population', 'workplace 1, s', 'workplace 2, s'), rows)}"


def _static(one: Replication) -> str:
    fit: FittedWalking = one.papers
    rows = [
        ("paper", ".94", "1.58", "1.79"),
        ("ours, annealing", *(f"{value:.2f}" for value in fit.static.vector)),
        ("ours, best of the grid", *(f"{value:.2f}" for value in fit.static.node)),
    ]
    return _table(("P_stat", "v, m/s", "a, m/s^2", "omega, 1/m"), rows)


def _real(real: RealWalks) -> str:
    rows = [
        (
            f"{one.distance_m:g} m",
            f"{one.peak_m_s:.2f} (sd {one.sd_m_s:.2f})",
            f"{one.predicted_m_s:.2f}",
            f"{one.off_sds:.2f}",
            f"{one.duration_s:.2f}",
            f"{one.predicted_s - one.duration_s:+.2f}",
        )
        for one in real.distances
    ]
    head = ("distance", "peak speed of eight people, m/s", "predicted", "off, sd",
            "duration, s", "predicted less")  # fmt: skip
    walks = zip(real.captured, real.captures.truth_s, strict=True)
    medians = {name: np.median(o.draws_s, axis=1) for name, o in real.captures.outcomes.items()}
    captured = [
        (entry.walk.source, f"{truth:.2f}", *(f"{medians[name][at]:.2f}" for name in MODELS))
        for at, (entry, truth) in enumerate(walks)
    ]
    base = real.fit.database
    return (
        REAL_PEOPLE.format(
            walks=len(base), people=len(base.persons), worst=real.worst_unscaled_sds
        )
        + f"\n{_table(head, rows)}\n\n"
        + _table(("captured walk", "took, s", *(f"{name}, median" for name in MODELS.values())),
                 captured)
    )  # fmt: skip


def _left(mean: float, sd: float) -> str:
    return f"{mean:.3f} ({sd:.3f})"


def _p(p: float) -> str:
    return "< .001" if p < 0.001 else f"{p:.3f}"


def _reading(options: SuitabilityOptions) -> str:
    told = f"by {options.normalisation}, power {options.power:g}"
    if options.time_constant_s is None:
        return told
    return f"{told}, time-aware with tau {options.time_constant_s:g} s"
