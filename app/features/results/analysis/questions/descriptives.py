"""Descriptive statistics by condition: means, spreads and the share of a score's maximum."""

import numpy as np

from app.features.results.analysis.questions.measures import Measure
from app.features.results.analysis.questions.words import (
    TestReport,
    error_rate_warning,
    interval_words,
    number,
)
from app.science.statistics import FloatArray, share_of_maximum


def descriptive(measure: Measure) -> TestReport:
    """Return the mean, standard deviation and median of every cell of the design."""
    rows = []
    for limb in measure.limbs:
        columns = (column for _, column in measure.table(limb).items())
        for level, column in zip(measure.levels, columns, strict=True):
            values = column.dropna().to_numpy(dtype=np.float64)
            rows.append((limb, level, *_cell(values), *_share(measure, values)))
    words = measure.factor.words
    cells = [f"{row[0]} {words(row[1])} M = {row[3]}, SD = {row[5]}" for row in rows]
    shares = () if measure.maximum is None else ("mean share of maximum",)
    unit = measure.unit
    return TestReport(
        key="means",
        title="Means",
        sentence=f"Every cell of the design, in {unit}. {_maximum_words(measure)}",
        apa=f"{measure.title}: {'; '.join(cells)}",
        columns=(
            *("task", measure.factor.heading, "n", f"mean ({unit})", "95 % CI", "SD", "median"),
            *shares,
        ),
        rows=rows,
        method=(
            "Each value is a participant’s mean over the phases of the cell. Intervals are "
            f"Student’s. {error_rate_warning('student_mean')}"
        ),
        source="Student 1908, Biometrika 6:1.",
    )


def _cell(values: FloatArray) -> tuple[str, ...]:
    if not values.size:
        return ("0", *[number(None)] * 4)
    mean, median = number(float(values.mean())), number(float(np.median(values)))
    spread = number(float(values.std(ddof=1)) if values.size > 1 else None)
    return str(values.size), mean, interval_words(values), spread, median


def _share(measure: Measure, values: FloatArray) -> tuple[str, ...]:
    if measure.maximum is None:
        return ()
    if not values.size:
        return (number(None),)
    share = float(share_of_maximum(values, measure.maximum).mean())
    return (f"{number(100.0 * share, 0)} %",)


def _maximum_words(measure: Measure) -> str:
    if measure.maximum is None:
        return ""
    return (
        f"Shares are of the largest possible score, {measure.maximum:g}; 0 % is the middle "
        "of the scale."
    )
