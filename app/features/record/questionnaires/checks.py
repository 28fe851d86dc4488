"""Whether a filled-in form can be stored as it came."""

from app.errors import InvalidInput
from app.features.record.questionnaires.schemas import SubmissionRequest
from app.science.instruments import Instrument, validate_answers


def check_answers(
    instrument: Instrument, request: SubmissionRequest, *, allow_missing: bool
) -> None:
    """Raise InvalidInput with every answer that does not fit, or for an order or a language that
    is not the form's. `allow_missing`: required answers may be left out.
    """
    problems = [
        problem
        for problem in validate_answers(instrument, request.answers)
        if not (allow_missing and problem.value is None)
    ]
    if problems:
        raise InvalidInput(
            f"{len(problems)} answer{'s do' if len(problems) != 1 else ' does'} not fit",
            value=[problem.item for problem in problems],
            remedy="Mend the answers named below; nothing was stored.",
            details=[
                {
                    "item": problem.item,
                    "message": problem.message,
                    "value": problem.value,
                    "valid": problem.valid,
                    "remedy": problem.remedy,
                }
                for problem in problems
            ],
        )
    if sorted(request.shown_order) != sorted(instrument.by_key):
        raise InvalidInput(
            "shown_order must name every item once",
            value=request.shown_order,
            valid=sorted(instrument.by_key),
        )
    if request.language not in instrument.languages:
        raise InvalidInput(
            f"the form is not written in {request.language!r}",
            value=request.language,
            valid=list(instrument.languages),
        )
