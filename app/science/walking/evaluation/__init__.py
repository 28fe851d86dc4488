"""Evaluate predictions on walks that the model was not fitted on."""

from app.science.walking.evaluation.evaluation import Evaluation, evaluate, pooled
from app.science.walking.evaluation.leave_one_out import (
    LeftOut,
    neighbours_left_out,
    nodes_left_out,
    people_left_out,
)
from app.science.walking.evaluation.scoring import COVERAGES, PERCENTILES

__all__ = [
    "COVERAGES",
    "PERCENTILES",
    "Evaluation",
    "LeftOut",
    "evaluate",
    "neighbours_left_out",
    "nodes_left_out",
    "people_left_out",
    "pooled",
]
