"""Forms, answers and scores."""

from app.features.record.questionnaires.schemas import (
    Administration,
    AnswerValue,
    CorrectionView,
    Receipt,
    StoredAnswers,
    StoredScores,
    SubmissionRequest,
)
from app.features.record.questionnaires.service import (
    answers_of,
    correct_answer,
    current_administration,
    newest_corrections,
    stored_answers,
    stored_scores,
    submit,
)

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
    "newest_corrections",
    "stored_answers",
    "stored_scores",
    "submit",
]
