"""Statistical tests of a study's measures, reported in sentences and tables."""

from app.features.results.analysis.questions.answers import answers_of

__all__ = ["answers_of"]
