"""Print what `reembody reach` did, as text and as JSON."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

import numpy as np

from app.cli.reach.run import FittedFile, SampledReaches
from app.science.reaching import FittedReaching, ReachEvaluation

_MOST_LISTED = 8


def fit_json(done: FittedFile) -> dict[str, Any]:
    """Return the result of `reach fit` for scripts."""
    return {
        **_model_json(done.fit),
        "out": str(done.out),
        "left_out": [asdict(one) for one in done.left_out],
        "people_named_by_file": sorted(done.recorded.named_by_file),
        "notices": done.recorded.notices,
    }


def fit_text(done: FittedFile) -> str:
    """Format the result of `reach fit` for people."""
    lines = [f"{done.out}: sha256 {done.fit.content_hash}", *_model_lines(done.fit)]
    counted = Counter(one.reason for one in done.left_out)
    lines.append(f"Left out: {len(done.left_out)} movements (--json names each)")
    lines += [f"  {count:4d}  {reason}" for reason, count in counted.most_common()]
    lines += [f"  notice: {text}" for text in done.recorded.notices]
    if named := sorted(done.recorded.named_by_file):
        shown = ", ".join(map(repr, named[:_MOST_LISTED])) + (
            ", ..." if len(named) > _MOST_LISTED else ""
        )
        lines.append(
            f"{_counted(len(named))} known only by a file or a folder, with the code: {shown}. If"
            " one person has several codes, or several people have one, say so with --people."
        )
    return "\n".join(lines)


def evaluation_json(done: tuple[FittedReaching, ReachEvaluation]) -> dict[str, Any]:
    """Return the scores of `reach evaluate` for scripts."""
    fit, found = done
    return {**_model_json(fit), **asdict(found), "verdict": found.verdict}


def evaluation_text(done: tuple[FittedReaching, ReachEvaluation]) -> str:
    """Format the scores of `reach evaluate` for people."""
    fit, found = done
    lines = [
        *_model_lines(fit),
        (
            f"{found.reaches} reaches, each predicted without its own: {found.groups}"
            f" {found.left_out} left out in turn; seconds between the cuts"
        ),
        "",
        f"  {'method':<9}{'CRPS':>7}{'in 50 %':>9}{'in 90 %':>9}   maps better by",
    ]
    for one in found.scores:
        by = "" if one.method == "maps" else f"{one.maps_better_s:+.3f}"
        if one.interval_s is not None:
            by += f" [{one.interval_s[0]:+.3f}, {one.interval_s[1]:+.3f}]"
        lines.append(
            f"  {one.method:<9}{one.crps_s:>7.3f}{100.0 * one.coverage_50:>8.0f}%"
            f"{100.0 * one.coverage_90:>8.0f}%   {by}".rstrip()
        )
    if found.no_interval:
        lines.append(f"  No intervals: {found.groups} {found.left_out} are too few, 6 are needed")
    return "\n".join([*lines, "", f"So {found.verdict}"])


def sample_json(done: SampledReaches) -> dict[str, Any]:
    """Return the draws of `reach sample` for scripts."""
    return {
        "sha256": done.fit.content_hash,
        "synthetic": done.fit.synthetic > 0,
        "distance_m": done.order.distance_m,
        "durations_s": done.durations_s.tolist(),
        "skews": done.skews.tolist(),
        "notes": list(done.notes),
    }


def sample_text(done: SampledReaches) -> str:
    """Summarise the draws of `reach sample`."""
    shares = (0.05, 0.25, 0.5, 0.75, 0.95)
    lines = [f"{done.order.count} reaches of new people over {done.order.distance_m:g} m"]
    lines += [f"  note: {text}" for text in done.notes]
    lines.append(f"  {'':<8}" + "".join(f"{100 * share:>7.0f} %" for share in shares))
    for name, values in (("time, s", done.durations_s), ("skew", done.skews)):
        cells = "".join(f"{value:>9.2f}" for value in np.quantile(values, shares))
        lines.append(f"  {name:<8}{cells}")
    return "\n".join(lines)


def _model_json(fit: FittedReaching) -> dict[str, Any]:
    levels = fit.levels
    return {
        "sha256": fit.content_hash,
        "people": fit.persons,
        "reaches": len(fit.database),
        "synthetic": fit.synthetic,
        "dependencies": list(fit.database.names),
        "distances_m": list(fit.distances_m),
        "tempo": float(np.exp(levels.mean)),
        "tempo_interval": list(levels.interval()),
        "between_people_sd": levels.spread,
        "levels": dict(zip(levels.names, np.exp(levels.logs).tolist(), strict=True)),
        "reading": asdict(fit.reading),
        "rules": asdict(fit.rules),
    }


def _model_lines(fit: FittedReaching) -> Iterator[str]:
    least_m, most_m = fit.distances_m
    yield (
        f"{len(fit.database)} reaches of {_counted(fit.persons)}, {least_m:.2f} to {most_m:.2f} m"
        + (f"; SYNTHETIC: a program made {fit.synthetic} of them" if fit.synthetic else "")
    )
    low, high = fit.levels.interval()
    yield (
        f"Median tempo {np.exp(fit.levels.mean):.2f} of the assumed time, 95 % interval {low:.2f}"
        f" to {high:.2f}; SD between people {100.0 * fit.levels.spread:.0f} %"
    )
    if fit.persons < 6:
        yield (
            f"{_counted(fit.persons)} cannot say how much people differ: the assumed SD of 15 %"
            " counts for as much as three people"
        )
    if not fit.by_width:
        yield "The targets' widths are not known: times depend on distance alone"


def _counted(people: int) -> str:
    return "1 person" if people == 1 else f"{people} people"
