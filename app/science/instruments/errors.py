"""What can be wrong with an instrument, its formulas or its answers.

InstrumentError (ValueError)
├── FormulaError               a score's formula cannot be read; points at the character
├── InstrumentDefinitionError  the instrument contradicts itself; holds every problem with its place
├── AnswerError                one answer is not on its item's scale
└── InstrumentTableError       a table of answers cannot be scored at all
"""

from dataclasses import dataclass


class InstrumentError(ValueError):
    """Something about an instrument or its answers was refused."""


class FormulaError(InstrumentError):
    """A formula cannot be read. `position` counts characters from 0."""

    def __init__(self, formula: str, position: int, message: str, remedy: str) -> None:
        self.formula = formula
        self.position = position
        self.message = message
        self.remedy = remedy
        super().__init__(
            f"{message} (character {position + 1} of {shortened(formula)!r}). {remedy}"
        )


@dataclass(frozen=True)
class DefinitionProblem:
    """One contradiction in an instrument; `path` leads to it, such as ("scores", 2, "formula")."""

    path: tuple[str | int, ...]
    message: str
    value: object = None
    valid: object = None
    remedy: str = ""


class InstrumentDefinitionError(InstrumentError):
    """An instrument contradicts itself; `problems` holds every reason, not just the first."""

    def __init__(self, problems: tuple[DefinitionProblem, ...]) -> None:
        self.problems = problems
        lines = (
            f"{'.'.join(map(str, problem.path))}: {problem.message} {problem.remedy}".rstrip()
            for problem in problems
        )
        super().__init__("The instrument contradicts itself:\n" + "\n".join(lines))


class AnswerError(InstrumentError):
    """One answer is not on its item's scale. `row` counts data rows from 1; None outside tables."""

    def __init__(self, item: str, value: object, valid: str, *, row: int | None = None) -> None:
        self.item = item
        self.value = value
        self.valid = valid
        self.row = row
        where = "" if row is None else f"Row {row}: "
        super().__init__(
            f"{where}item {item} has the answer {shortened(value)!r}. Valid is {valid}. "
            "Correct the answer, or leave it empty if it is missing."
        )


class InstrumentTableError(InstrumentError):
    """A table of answers cannot be scored: the message says where, why and what to do."""


def shortened(value: object, limit: int = 80) -> object:
    """The value itself, but long text cut down so that a message stays readable."""
    if isinstance(value, str) and len(value) > limit:
        return value[: limit - 3] + "..."
    return value
