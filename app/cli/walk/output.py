"""Format the results of `reembody walk`: JSON for scripts, tables for people."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from app.cli.walk.run import Evaluated, Fitted, Sampled
from app.science.walking.evaluation import (
    COVERAGES,
    PAPERS,
    PERCENTILES,
    Comparison,
    Evaluation,
    reason_for_no_interval,
)
from app.science.walking.maps import SuitabilityOptions
from app.science.walking.models import MIXED, WITHOUT, FittedWalking
from app.science.walking.records import TURNING

_SHOWN = 6
_WORDS = {
    "velocity": "maximum speed",
    "acceleration": "acceleration",
    "angular": "largest curvature",
}
"""What the parameters are called for people, as the console calls them."""


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
        "people_named_by_file": sorted(done.walks.named_by_file),
        "fitted": [
            {
                "walk": name,
                "walked_m": entry.walk.length_m,
                "length_m": entry.path.length_m,
                "turning_rad": entry.dependencies[TURNING] * entry.path.length_m,
                "own_path": entry.is_own_path,
                "scene": scene,
                "others": {one: entry.dependencies[one] for one in done.order.depends_on},
            }
            for name, entry, scene in zip(
                done.walks.names, done.walks.entries, done.walks.scenes, strict=True
            )
        ],
        "left_out": _listed(done.walks.left_out),
        "notices": done.walks.notices,
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
    scenes = Counter(done.walks.scenes)
    if set(scenes) != {None}:
        counted = (
            f"{_counted(count, 'walk')} {'on the open floor' if key is None else f'in {key}'}"
            for key, count in scenes.most_common()
        )
        lines.append(f"  {'scenes':<14}{', '.join(counted)}")
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
    lines += _left_out_lines(done.walks.left_out)
    lines += [f"  {'notice':<14}{text}" for text in done.walks.notices]
    lines += [f"  {'note':<14}{text}" for text in fit.caveats]
    lines.append(f"  {'space':<14}{len(fit.space.z)} entries, {fit.space.k} neighbours")
    lines.append(f"  {'reading':<14}{reading_text(fit.reading)}")
    lines += [
        f"  {'':<14}CRPS {score.crps_s:.3f} s  {reading_text(score.options)}"
        for score in fit.scores[:3]
    ]
    parameters = ", ".join(
        f"{_WORDS.get(one.name, one.name)} {value:.2f} {one.unit}"
        for one, value in zip(fit.database.grid.parameters, fit.static.vector, strict=True)
    )
    lines += [f"  {'static':<14}{parameters}", "", f"written: {done.order.out}"]
    return "\n".join(lines)


def _listed(left_out: Sequence[tuple[str, str]]) -> list[dict[str, str]]:
    return [{"walk": name, "reason": reason} for name, reason in left_out]


def _left_out_lines(left_out: Sequence[tuple[str, str]]) -> list[str]:
    if not left_out:
        return []
    listed = _some([f"{name}: {reason}" for name, reason in left_out])
    return [f"  {'left out':<14}{_counted(len(left_out), 'walk')}: {listed}"]


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
        "model": done.which,
        "synthetic": done.synthetic,
        "kinds": sorted(set(done.fit.database.kinds)),
        "seed": done.order.seed,
        "parameters": _parameters(done.fit),
        "vectors": prediction.vectors.tolist(),
        "durations_s": prediction.durations_s.tolist(),
        "not_arrived": prediction.lost,
        "outside": done.fit.outside(done.dependencies),
        "notes": list(done.notes),
    }


def sample_text(done: Sampled) -> str:
    """Format the draws of `walk sample` for people."""
    found, parameters = done.prediction, done.fit.database.grid.parameters
    count = len(found.durations_s)
    lines = [
        (
            f"path of {done.path.length_m:.2f} m, {len(done.path.points_m)} points; model"
            f" {done.which}, {count} walk(s), {found.lost} drawn that did not arrive"
        ),
        *(
            ["SYNTHETIC: the model was fitted on walks that a program made"]
            if done.synthetic
            else []
        ),
        "",
    ]
    columns = [("duration, s", found.durations_s)]
    columns += [
        (f"{_WORDS.get(one.name, one.name)}, {one.unit}", found.vectors[:, at])
        for at, one in enumerate(parameters)
    ]
    width = 2 + max(len(name) for name, _ in columns)
    lines.append(f"  {'':<{width}}{'5 %':>8}{'25 %':>8}{'median':>8}{'75 %':>8}{'95 %':>8}")
    for name, column in columns:
        cells = "".join(f" {value:>7.2f}" for value in np.percentile(column, PERCENTILES))
        lines.append(f"  {name:<{width}}{cells}")
    lines += [f"  note: {text}" for text in done.notes]
    return "\n".join(lines)


def evaluation_json(done: Evaluated) -> dict[str, object]:
    """Return the scores of `walk evaluate` for scripts."""
    fit, result = done.fit, done.result
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
        "people": result.people,
        "fitted_on": len(fit.database.persons),
        "in_sample_people": _in_sample(fit, result),
        "left_out": _listed(done.left_out),
        "notices": done.walks.notices,
        "models": _finite(models),
        "comparisons": [_comparison_json(one, result) for one in _comparisons(result)],
        "against_baselines": [
            {
                "baseline": name,
                "crps_less_s": gain_s,
                "low_s": low_s,
                "high_s": high_s,
                "no_interval": _too_few(result),
            }
            for name, gain_s, low_s, high_s in _gains(result)
        ],
        "saved_per_cycle_s": result.saved_per_cycle_s("prob", "stat"),
    }


def evaluation_text(done: Evaluated) -> str:
    """Format the scores of `walk evaluate` for people."""
    fit, result = done.fit, done.result
    width = max(15, 2 + max(len(name) for name in result.outcomes))
    lines = [
        (
            f"{_counted(len(result.truth_s), 'walk')} of {_counted(result.people, 'person')},"
            f" {_fitted_on(fit, result)}; seconds"
        ),
        *_left_out_lines(done.left_out),
        *(f"  {'notice':<14}{text}" for text in done.walks.notices),
        "",
        (
            f"  {'model':<{width}}{'CRPS':>8}{'|dt|, one draw: 5 %':>22}{'25 %':>8}{'median':>8}"
            f"{'75 %':>8}{'95 %':>8}{'in 50 %':>9}{'in 90 %':>9}"
        ),
    ]
    for name, outcome in result.outcomes.items():
        errors = result.errors(name).percentiles_s
        first, *others = errors
        inside = "".join(f"{100.0 * share:>8.0f}%" for share in result.coverage(name))
        cells = "".join(f"{value:>8.3f}" for value in others)
        shown = inside if outcome.draws_s.shape[1] > 1 else f"{'-':>9}{'-':>9}"
        lines.append(f"  {name:<{width}}{outcome.mean_crps_s:>8.3f}{first:>22.3f}{cells}{shown}")
    lines.append("")
    lines += [_comparison_text(one, result) for one in _comparisons(result)]
    for name, gain_s, low_s, high_s in _gains(result):
        interval = (
            ""
            if low_s is None or high_s is None
            else f"; 95 % of people drawn again: {_smaller(low_s)} to {_smaller(high_s)}"
        )
        lines.append(f"  {MIXED} against {name}: CRPS {_smaller(gain_s)}{interval}")
        if name.startswith(WITHOUT) and gain_s <= 0.0:
            lines.append(
                f"  With {name.removeprefix(WITHOUT)} these walks are predicted no better than"
                " without: a fit that leaves it out serves them as well"
            )
    if too_few := _too_few(result):
        lines.append(f"  No intervals and no tests: {too_few}")
    return "\n".join(lines)


def _smaller(gain_s: float) -> str:
    """Say by how much an error is smaller, or larger."""
    return f"{abs(gain_s):.3f} s {'smaller' if gain_s >= 0.0 else 'larger'}"


def _counted(count: int, noun: str) -> str:
    many = {"person": "people"}.get(noun, f"{noun}s")
    return f"{count} {noun if count == 1 else many}"


def _in_sample(fit: FittedWalking, result: Evaluation) -> list[str]:
    """Return the evaluated people on whom the model was fitted, too."""
    return sorted(set(result.subjects) & set(fit.database.subjects))


def _fitted_on(fit: FittedWalking, result: Evaluation) -> str:
    count, same = len(fit.database.persons), len(_in_sample(fit, result))
    if not same:
        return f"model fitted on {count} others"
    whom = "all" if same == result.people else str(same)
    return (
        f"model fitted on {_counted(count, 'person')}, {whom} of these among them: figures are"
        " in-sample and say nothing about other people"
    )


def _too_few(result: Evaluation) -> str | None:
    """Return why neither intervals nor tests are given; None if there are enough people."""
    return reason_for_no_interval(result.people)


def _comparisons(result: Evaluation) -> list[Comparison]:
    return result.comparisons(by_person=True)


def _comparison_json(one: Comparison, result: Evaluation) -> dict[str, object]:
    """Return a comparison over people; the figures of the test are null with too few of them."""
    too_few = _too_few(result)
    found: dict[str, object] = {**asdict(one), "n": result.people, "not_tested": too_few}
    if too_few:
        found |= dict.fromkeys(("p", "rank_biserial", "power"))
    return {key: _finite(value) for key, value in found.items()}


def _comparison_text(one: Comparison, result: Evaluation) -> str:
    tested = (
        ""
        if _too_few(result)
        else f"; Wilcoxon over n = {result.people} people, p {one.p:.3g}, rank biserial"
        f" {one.rank_biserial:+.2f}, power {one.power:.2f}"
    )
    return (
        f"  {one.first} against {one.second}, |dt| of one draw, mean of each person:"
        f" {one.difference_s:+.3f} s{tested}"
    )


def _gains(result: Evaluation) -> list[tuple[str, float, float | None, float | None]]:
    """Return by how much P_mixed's CRPS is smaller than each baseline's, with its interval.

    P_mixed without each of the model's further dependencies is one of the baselines.
    With too few people the interval's ends are None.
    """
    rng = np.random.default_rng(1)
    names = [name for name in result.outcomes if name not in (MIXED, *PAPERS)]
    names = names if MIXED in result.outcomes else []
    found: list[tuple[str, float, float | None, float | None]] = []
    for name in names:
        gain_s, low_s, high_s = result.better_by_s(MIXED, name, rng)
        found.append(
            (name, gain_s, None, None) if _too_few(result) else (name, gain_s, low_s, high_s)
        )
    return found


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
