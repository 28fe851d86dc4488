"""Format the results of `reembody walk`: JSON for scripts, tables for people."""

from dataclasses import asdict

import numpy as np

from app.cli.walk.run import Fitted, Sampled
from app.science.walking.evaluation import COVERAGES, PERCENTILES, Evaluation
from app.science.walking.maps import SuitabilityOptions
from app.science.walking.models import FittedWalking
from app.science.walking.records import TURNING

_SHOWN = 6


def fit_json(done: Fitted) -> dict[str, object]:
    """Return a fitted model for scripts."""
    fit = done.fit
    return {
        "model": str(done.order.out),
        "content_hash": done.content_hash,
        "walks": len(fit.database),
        "people": len(fit.database.persons),
        "kinds": sorted(set(fit.database.kinds)),
        "dependencies": list(fit.database.names),
        "without": list(done.left_out),
        "cut_walks": done.cut,
        "fitted": [
            {
                "walk": name,
                "walked_m": entry.walk.length_m,
                "length_m": entry.path.length_m,
                "turning_rad": entry.dependencies[TURNING] * entry.path.length_m,
                "own_path": entry.is_own_path,
            }
            for name, entry in zip(done.walks.names, done.walks.entries, strict=True)
        ],
        "left_out": [{"walk": name, "reason": reason} for name, reason in done.walks.left_out],
        "entries": len(fit.space.z),
        "k": fit.space.k,
        "reading": asdict(fit.reading),
        "reading_crps_s": [
            {"reading": asdict(score.options), "crps_s": score.crps_s} for score in fit.scores
        ],
        "static": dict(zip(_parameters(fit), fit.static.vector.tolist(), strict=True)),
    }


def fit_text(done: Fitted) -> str:
    """Describe a fitted model for people."""
    fit = done.fit
    base = fit.database
    kinds = ", ".join(sorted(set(base.kinds)))
    shortest, longest = base.lengths_m.min(), base.lengths_m.max()
    lines = [
        (
            f"{len(base)} walks of {len(base.persons)} people ({kinds}), {shortest:.2f} to"
            f" {longest:.2f} m"
        ),
        f"  {'depends on':<14}{', '.join(base.names)}",
    ]
    if done.left_out:
        lines.append(f"  {'left out':<14}{', '.join(done.left_out)}: not known for all walks")
    own = [
        f"{name} ({entry.walk.length_m:.2f} m, {entry.path.length_m:.2f} m without sway)"
        for name, entry in zip(done.walks.names, done.walks.entries, strict=True)
        if entry.is_own_path
    ]
    if own:
        lines.append(
            f"  {'own path':<14}{len(own)} walk(s) took another way than the shortest and are"
            f" fitted on it: {_some(own)}"
        )
    if done.walks.left_out:
        listed = [f"{name}: {reason}" for name, reason in done.walks.left_out]
        lines.append(f"  {'walks left out':<14} {_some(listed)}")
    if done.cut:
        lines.append(
            f"  {'note':<14}{done.cut} walk(s) begin or end with the recording, amid walking; they"
            " say little about how people start and stop"
        )
    lines.append(f"  {'space':<14}{len(fit.space.z)} entries, {fit.space.k} neighbours")
    lines.append(f"  {'reading':<14}{reading_text(fit.reading)}")
    lines += [
        f"  {'':<14}CRPS {score.crps_s:.3f} s  {reading_text(score.options)}"
        for score in fit.scores[:3]
    ]
    parameters = ", ".join(
        f"{name} {value:.2f}"
        for name, value in zip(_parameters(fit), fit.static.vector, strict=True)
    )
    lines += [f"  {'static':<14}{parameters}", "", f"written: {done.order.out}"]
    return "\n".join(lines)


def _some(texts: list[str]) -> str:
    more = f"; and {len(texts) - _SHOWN} more (--json has all)" if len(texts) > _SHOWN else ""
    return "; ".join(texts[:_SHOWN]) + more


def reading_text(options: SuitabilityOptions) -> str:
    """Describe a reading: the options that turn error maps into suitability."""
    parts = [f"by {options.normalisation}", f"power {options.power:g}"]
    if options.threshold:
        parts.append(f"from {options.threshold:g}")
    if options.time_constant_s is not None:
        parts.append(f"time-aware, tau {options.time_constant_s:g} s")
    return ", ".join(parts)


def sample_json(done: Sampled) -> dict[str, object]:
    """Return the draws of `walk sample` for scripts."""
    prediction = done.prediction
    return {
        "length_m": done.path.length_m,
        "points_m": done.path.points_m.tolist(),
        "dependencies": done.dependencies,
        "model": done.order.which,
        "seed": done.order.seed,
        "parameters": _parameters(done.fit),
        "vectors": prediction.vectors.tolist(),
        "durations_s": prediction.durations_s.tolist(),
        "not_arrived": prediction.lost,
    }


def sample_text(done: Sampled) -> str:
    """Format the draws of `walk sample` for people."""
    found, names = done.prediction, _parameters(done.fit)
    count = len(found.durations_s)
    lines = [
        (
            f"path of {done.path.length_m:.2f} m, {len(done.path.points_m)} points; model"
            f" {done.order.which}, {count} walk(s), {found.lost} drawn that did not arrive"
        ),
        "",
        f"  {'':<14}{'5 %':>8}{'25 %':>8}{'median':>8}{'75 %':>8}{'95 %':>8}",
    ]
    columns = [("duration, s", found.durations_s)]
    columns += [(name, found.vectors[:, at]) for at, name in enumerate(names)]
    for name, column in columns:
        cells = "".join(f"{value:>8.2f}" for value in np.percentile(column, PERCENTILES))
        lines.append(f"  {name:<14}{cells}")
    return "\n".join(lines)


def evaluation_json(fit: FittedWalking, result: Evaluation) -> dict[str, object]:
    """Return the scores of `walk evaluate` for scripts."""
    models = {
        name: {
            "crps_s": outcome.mean_crps_s,
            "single_draw": asdict(result.errors(name)),
            "median": asdict(result.medians(name)),
            "coverage": dict(zip(map(str, COVERAGES), result.coverage(name), strict=True)),
            "iqr_ratios": result.iqr_ratios(name),
            "not_arrived": outcome.lost,
        }
        for name, outcome in result.outcomes.items()
    }
    return {
        "walks": len(result.truth_s),
        "people": len(set(result.subjects)),
        "fitted_on": len(fit.database.persons),
        "models": _finite(models),
        "comparisons": _finite([asdict(one) for one in result.comparisons()]),
        "saved_per_cycle_s": result.saved_per_cycle_s("prob", "stat"),
    }


def evaluation_text(fit: FittedWalking, result: Evaluation) -> str:
    """Format the scores of `walk evaluate` for people."""
    lines = [
        (
            f"{len(result.truth_s)} walks of {len(set(result.subjects))} people, model fitted on"
            f" {len(fit.database.persons)} others; seconds"
        ),
        "",
        (
            f"  {'model':<8}{'CRPS':>8}{'|dt|, one draw: 5 %':>22}{'25 %':>8}{'median':>8}"
            f"{'75 %':>8}{'95 %':>8}{'in 50 %':>9}{'in 90 %':>9}"
        ),
    ]
    for name, outcome in result.outcomes.items():
        errors = result.errors(name).percentiles_s
        first, *others = errors
        inside = "".join(f"{100.0 * share:>8.0f}%" for share in result.coverage(name))
        cells = "".join(f"{value:>8.3f}" for value in others)
        shown = inside if outcome.draws_s.shape[1] > 1 else f"{'-':>9}{'-':>9}"
        lines.append(f"  {name:<8}{outcome.mean_crps_s:>8.3f}{first:>22.3f}{cells}{shown}")
    lines.append("")
    lines += [
        f"  {one.first} against {one.second}, |dt| of one draw: Wilcoxon p {one.p:.3g},"
        f" rank biserial {one.rank_biserial:+.2f}, power {one.power:.2f}"
        for one in result.comparisons()
    ]
    return "\n".join(lines)


def _parameters(fit: FittedWalking) -> list[str]:
    return [one.name for one in fit.database.grid.parameters]


def _finite(value: object) -> object:
    """Replace numbers that are not finite by None, because JSON has no NaN."""
    if isinstance(value, dict):
        return {key: _finite(own) for key, own in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(own) for own in value]
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value
