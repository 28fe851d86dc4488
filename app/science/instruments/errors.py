"""Errors of instruments, their formulas and their answers.

InstrumentError (ValueError)
├── FormulaError               a score's formula cannot be parsed; gives the character position
├── InstrumentDefinitionError  the instrument is inconsistent; lists every problem with its path
├── AnswerError                one answer is not valid for its item
└── InstrumentTableError       a table of answers cannot be scored at all
"""

from dataclasses import dataclass


class InstrumentError(ValueError):
    """Base class of the errors in instruments and their answers."""


class FormulaError(InstrumentError):
    """A formula cannot be parsed. `position` counts characters from 0."""

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
    """One inconsistency in an instrument.

    `path` locates it in the definition, such as ("scores", 2, "formula").
    """

    path: tuple[str | int, ...]
    message: str
    value: object = None
    valid: object = None
    remedy: str = ""


class InstrumentDefinitionError(InstrumentError):
    """An instrument is inconsistent; `problems` lists all inconsistencies, not just the first."""

    def __init__(self, problems: tuple[DefinitionProblem, ...]) -> None:
        self.problems = problems
        lines = (
            f"{'.'.join(map(str, problem.path))}: {problem.message} {problem.remedy}".rstrip()
            for problem in problems
        )
        super().__init__("The instrument is not consistent:\n" + "\n".join(lines))


class AnswerError(InstrumentError):
    """One answer is not valid for its item. `row` counts data rows from 1; None outside tables."""

    def __init__(self, item: str, value: object, valid: str, *, row: int | None = None) -> None:
        self.item = item
        self.value = value
        self.valid = valid
        self.row = row
        where = "" if row is None else f"Row {row}: "
        super().__init__(
            f"{where}item {item} has the answer {shortened(value)!r}. Valid answer: {valid}. "
            "Correct the answer, or leave it empty if it is missing."
        )


class InstrumentTableError(InstrumentError):
    """A table of answers cannot be scored; the message says where, why and what to do."""


def shortened(value: object, limit: int = 80) -> object:
    """Return the value, with long text truncated so that a message stays readable."""
    if isinstance(value, str) and len(value) > limit:
        return value[: limit - 3] + "..."
    return value
