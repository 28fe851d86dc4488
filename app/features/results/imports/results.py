"""Summarise and test the scores of an import by condition, with the same functions as for sessions.

They are kept apart from the study's own sessions: the setting and devices differ, and no operator
ran a session.
"""

from collections.abc import Sequence

import numpy as np

from app.features.results.imports.schemas import ConditionMean, PairView, ScoreResult
from app.models import ImportedForm
from app.science.instruments import Instrument
from app.science.statistics import (
    Cells,
    StatisticsError,
    cells_of,
    friedman,
    mean_interval,
    pairwise,
)

_MIN_CONDITIONS = 2
_MIN_VALUES = 2


def results_of(instrument: Instrument, forms: Sequence[ImportedForm]) -> list[ScoreResult]:
    """Return the results of every score that has values, in the instrument's order."""
    found = []
    for score in instrument.scores:
        rows = [form for form in forms if form.scores.get(score.key) is not None]
        if rows:
            title = score.label.get("en") or score.key
            found.append(_score(score.key, title, rows))
    return found


def _score(key: str, title: str, rows: Sequence[ImportedForm]) -> ScoreResult:
    conditions = list(dict.fromkeys(row.condition for row in rows))
    means = [
        _mean(name, [float(row.scores[key]) for row in rows if row.condition == name])
        for name in conditions
    ]
    out = ScoreResult(
        score=key,
        title=title,
        means=means,
        n=len({row.participant_code for row in rows}),
        left_out=[],
        test=None,
        why_not=None,
        pairs=[],
    )
    if len(conditions) < _MIN_CONDITIONS:
        return out.model_copy(
            update={"why_not": "There is only one condition, so there is nothing to compare."}
        )
    try:
        cells = cells_of(
            [row.participant_code for row in rows],
            {"condition": [row.condition for row in rows]},
            [float(row.scores[key]) for row in rows],
        )
        return out.model_copy(update=_tests(cells))
    except StatisticsError as error:
        return out.model_copy(update={"why_not": str(error)})


def _tests(cells: Cells) -> dict[str, object]:
    complete, levels = cells.complete(), cells.levels[0]
    pairs = [
        PairView(
            a=one.a,
            b=one.b,
            n=one.test.n,
            w=None if one.test.degenerate else one.test.w,
            p=None if one.test.degenerate else one.test.p,
            p_holm=None if one.test.degenerate else one.p_holm,
            rank_biserial=None if one.test.degenerate else one.test.rank_biserial,
            degenerate=one.test.degenerate or None,
        )
        for one in pairwise(cells.values, levels)
    ]
    fields: dict[str, object] = {"pairs": pairs, "left_out": list(complete.left_out)}
    if all(one.degenerate for one in pairs):
        fields["why_not"] = "Nobody differs between conditions, so there is nothing to test."
    elif len(levels) > _MIN_CONDITIONS:
        omnibus = friedman(complete.values)
        p = "p < .001" if omnibus.p < 0.001 else f"p = {omnibus.p:.3f}".replace("0.", ".", 1)
        fields["test"] = (
            f"Friedman, {omnibus.method}: χ²({omnibus.df}) = {omnibus.statistic:.2f}, {p}, "
            f"W = {omnibus.kendall_w:.3f}".replace("W = 0.", "W = .")
            + f", n = {omnibus.n}"
        )
    return fields


def _mean(condition: str, values: Sequence[float]) -> ConditionMean:
    if len(values) < _MIN_VALUES or not np.ptp(values):
        mean = float(np.mean(values))
        return ConditionMean(
            condition=condition, n=len(values), mean=mean, sd=None, low=None, high=None
        )
    one = mean_interval(np.array(values))
    return ConditionMean(
        condition=condition, n=one.n, mean=one.mean, sd=one.sd, low=one.low, high=one.high
    )
