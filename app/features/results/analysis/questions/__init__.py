"""Statistical tests of a study's measures in sentences and tables, and the values they test."""

from app.features.results.analysis.questions.answers import answers_of
from app.features.results.analysis.questions.wide import WideColumn, wide_table

__all__ = ["WideColumn", "answers_of", "wide_table"]
