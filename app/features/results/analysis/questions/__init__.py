"""The study's questions and their answers: tests of what was declared, in sentences and tables."""

from app.features.results.analysis.questions.answers import answers_of

__all__ = ["answers_of"]
