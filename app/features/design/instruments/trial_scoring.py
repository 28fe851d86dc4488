"""Score answers to an instrument on trial, with every step, without storing anything."""

from app.errors import InvalidInput
from app.features.design.instruments.schemas import (
    AnswerProblemView,
    ItemStep,
    ScoreStep,
    TriedAnswer,
    TryResult,
)
from app.science.instruments import ExplainedScore, Instrument, explain_scoring, validate_answers


def try_answers(instrument: Instrument, answers: dict[str, TriedAnswer]) -> TryResult:
    """Return the scoring step by step; invalid answers are reported and left out of the scores.

    Raises InvalidInput for an answer to an item that the instrument does not have.
    """
    unknown = [key for key in answers if key not in instrument.by_key]
    if unknown:
        raise InvalidInput(
            f"the instrument has no item {unknown[0]!r}",
            value=unknown[0],
            valid=list(instrument.by_key),
        )
    given = {key: value for key, value in answers.items() if value is not None and value != ""}
    invalid = [one for one in validate_answers(instrument, given) if one.item in given]
    valid_answers = {
        key: value for key, value in given.items() if key not in {one.item for one in invalid}
    }
    steps = explain_scoring(instrument, valid_answers)
    return TryResult(
        recode=instrument.recode,
        items=[
            ItemStep(
                item=item.key,
                raw=item.raw,
                recoded=item.recoded,
                scored=item.key in instrument.scored_items,
            )
            for item in steps.items
        ],
        scores=[_score(score) for score in steps.scores],
        problems=[
            AnswerProblemView(item=one.item, message=one.message, remedy=one.remedy)
            for one in invalid
        ],
    )


def _score(explained: ExplainedScore) -> ScoreStep:
    score = explained.score
    return ScoreStep(
        key=score.key,
        label=dict(score.label),
        formula=score.formula,
        filled_in=explained.filled_in,
        value=explained.value,
        minimum=score.minimum,
        maximum=score.maximum,
        missing=list(explained.missing),
    )
