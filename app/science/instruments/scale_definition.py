"""Whether a scale is consistent: its ends, its steps and its labels."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from app.science.instruments.errors import DefinitionProblem

if TYPE_CHECKING:
    from app.science.instruments.model import Scale

_Path = tuple[str | int, ...]

MAX_STEPS = 101


def scale_problems(scale: "Scale | None", path: _Path) -> Iterator[DefinitionProblem]:
    """Every contradiction within a scale, if there is one; `path` leads to it."""
    if scale is None:
        return
    count = len(scale.steps)
    if scale.step < 1:
        yield DefinitionProblem(
            (*path, "step"), "A step must be a whole number.", scale.step, ">= 1", "Write 1."
        )
    elif not 2 <= count <= MAX_STEPS:
        yield DefinitionProblem(
            (*path, "maximum"),
            f"A scale from {scale.minimum} to {scale.maximum} has {count} steps.",
            scale.maximum,
            f"2 to {MAX_STEPS} steps",
            "Make maximum larger than minimum.",
        )
    elif scale.steps[-1] != scale.maximum:
        yield DefinitionProblem(
            (*path, "step"),
            f"Steps of {scale.step} from {scale.minimum} do not reach {scale.maximum}.",
            scale.step,
            f"a divisor of {scale.maximum - scale.minimum}",
            "Choose a step that leads from minimum to maximum.",
        )
    elif len(scale.labels) not in (0, 2, count):
        yield DefinitionProblem(
            (*path, "labels"),
            f"There are {len(scale.labels)} labels for {count} steps.",
            len(scale.labels),
            f"{count} labels, 2 (for both ends) or none",
            "Give one label for each step from lowest to highest, or only those of both ends.",
        )
