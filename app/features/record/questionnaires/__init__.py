"""Questionnaires of a session: forms, answers, corrections and scores."""

from app.features.record.questionnaires.repository import (
    answers_of,
    correct_answer,
    newest_corrections,
    stored_answers,
    stored_scores,
)
from app.features.record.questionnaires.schemas import (
    Administration,
    AnswerValue,
    CorrectionView,
    Receipt,
    StoredAnswers,
    StoredScores,
    SubmissionRequest,
)
from app.features.record.questionnaires.service import current_administration, due_form, submit

__all__ = [
    "Administration",
    "AnswerValue",
    "CorrectionView",
    "Receipt",
    "StoredAnswers",
    "StoredScores",
    "SubmissionRequest",
    "answers_of",
    "correct_answer",
    "current_administration",
    "due_form",
    "newest_corrections",
    "stored_answers",
    "stored_scores",
    "submit",
]
