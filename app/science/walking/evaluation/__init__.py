"""Evaluate predictions on walks that the model was not fitted on."""

from app.science.walking.evaluation.evaluation import PAPERS, Evaluation, evaluate, pooled
from app.science.walking.evaluation.leave_one_out import (
    LeftOut,
    TimesLeftOut,
    neighbours_left_out,
    nodes_left_out,
    people_left_out,
    times_left_out,
)
from app.science.walking.evaluation.scoring import (
    COVERAGES,
    LEAST_PEOPLE,
    PERCENTILES,
    Comparison,
    over_people,
    reason_for_no_interval,
)

__all__ = [
    "COVERAGES",
    "LEAST_PEOPLE",
    "PAPERS",
    "PERCENTILES",
    "Comparison",
    "Evaluation",
    "LeftOut",
    "TimesLeftOut",
    "evaluate",
    "neighbours_left_out",
    "nodes_left_out",
    "over_people",
    "people_left_out",
    "pooled",
    "reason_for_no_interval",
    "times_left_out",
]
