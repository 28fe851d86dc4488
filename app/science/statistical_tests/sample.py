"""Input and output of a declared test. Loads no numpy: the registry uses these types."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from app.science.statistics import FloatArray

Direction = Literal["two_sided", "rises", "falls"]


@dataclass(frozen=True, eq=False)
class Sample:
    """The values to test, and the options that the study declares.

    Attributes:
        values: (n participants, k levels) complete values in any unit.
        levels: names of the columns, in the order of the factor.
        direction: the direction of the measure along the factor.
        reference: the level with which the others are compared; None for the first.
        holm: whether several comparisons are adjusted by Holm's rule.
        alpha: significance level, with which p is compared.
    """

    values: "FloatArray"
    levels: tuple[str, ...]
    direction: Direction = "two_sided"
    reference: str | None = None
    holm: bool = False
    alpha: float = 0.05


@dataclass(frozen=True)
class Outcome:
    """The result of a declared test.

    Attributes:
        n: number of participants in it.
        p: the decisive p value, to be compared with alpha.
        sentence: statistic, p, effect size and n, as papers print them.
        columns, rows: figures of each level or comparison, as text.
        method: a description of how p was computed.
    """

    n: int
    p: float
    sentence: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    method: str
