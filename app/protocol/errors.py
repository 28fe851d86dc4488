"""Errors of study and instrument files: a list of all problems, never just the first.

ConfigError (ValueError)   the file cannot be used; contains every ConfigProblem found in it
PlanError (ValueError)     an order of conditions that does not match the study
"""

from collections.abc import Iterable
from dataclasses import asdict, dataclass


@dataclass(frozen=True)
class ConfigProblem:
    """One problem to correct.

    `path`: "orders.replicates", "conditions[1].latency_ms"; empty for the whole file. `line` and
    `column` count from 1 and are 0 if the text does not come from a file. `value` is the given
    value, `valid` what is allowed there, `remedy` what to do.
    """

    path: str
    line: int
    column: int
    message: str
    value: object = None
    valid: object = None
    remedy: str = ""

    def as_json(self) -> dict[str, object]:
        """Return the problem as a JSON object with the attribute names as keys."""
        return asdict(self)

    def __str__(self) -> str:
        place = f"line {self.line}, column {self.column}" if self.line else ""
        where = ", ".join(part for part in (place, self.path) if part)
        text = f"{where}: {self.message}" if where else self.message
        return f"{text} {self.remedy}".rstrip()


class ConfigError(ValueError):
    """A study or instrument file is invalid; `problems` are in the order of the file."""

    def __init__(self, problems: Iterable[ConfigProblem]) -> None:
        self.problems = tuple(sorted(problems, key=lambda one: (one.line, one.column)))
        super().__init__("\n".join(str(problem) for problem in self.problems))


class PlanError(ValueError):
    """An order of conditions does not match the study."""
