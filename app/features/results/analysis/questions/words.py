"""Format numbers, p values and intervals as papers print them, and build the reported results.

p has three decimals and no zero before the point; other numbers that cannot exceed 1 have no zero
there either. Nothing is called significant: p is compared with alpha, and the comparison is
reported.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files

from app.features.results.analysis.schemas import ResultView
from app.science.statistics import (
    Direction,
    ErrorRates,
    FloatArray,
    MeanInterval,
    TooFewData,
    error_rates_from_json,
)
from app.science.statistics import mean_interval as interval_of

_SMALLEST_P = 0.001
_BOUNDED_DIGITS = 3
_RATES = "error_rates.json"
NONE = "–"


@dataclass(frozen=True)
class Brief:
    """A result short enough for a table cell; `way`: the direction of a trend as observed."""

    text: str
    way: Direction | None = None


@dataclass(frozen=True)
class TestReport:
    """The report of one test; see `ResultView`.

    `brief`: None if the test could not be computed.
    """

    key: str
    title: str
    sentence: str
    apa: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    method: str
    source: str
    warnings: Sequence[str] = field(default_factory=tuple)
    exploratory: bool = False
    brief: Brief | None = None

    def view(self) -> ResultView:
        """Return the report as a `ResultView`, without duplicate warnings."""
        return ResultView(
            key=self.key,
            title=self.title,
            sentence=" ".join(self.sentence.split()),
            apa=" ".join(self.apa.split()),
            columns=list(self.columns),
            rows=[list(row) for row in self.rows],
            method=self.method,
            source=self.source,
            warnings=list(dict.fromkeys(one for one in self.warnings if one)),
            exploratory=self.exploratory,
        )


def p_words(p: float) -> str:
    """Return p for running text: "p = .012" or "p < .001"."""
    if math.isnan(p):
        return "p unknown"
    return "p < .001" if p < _SMALLEST_P else f"p = {bounded(p)}"


def p_cell(p: float) -> str:
    """Return p for a table cell: ".012" or "< .001"."""
    return p_words(p).removeprefix("p ").removeprefix("= ")


def bounded(value: float, digits: int = _BOUNDED_DIGITS) -> str:
    """Return a number as text, without the zero before the point if it is between -1 and 1."""
    if math.isnan(value):
        return NONE
    text = f"{value:.{digits}f}".replace("-", "−")
    return text.replace("0.", ".", 1) if abs(value) < 1.0 else text


def number(value: float | None, digits: int = 2) -> str:
    """Return a number with this many decimals, or a dash for a missing value."""
    if value is None or math.isnan(value):
        return NONE
    return f"{value:.{digits}f}".replace("-", "−")


def df_words(value: float) -> str:
    """Return degrees of freedom as text, without decimals for whole numbers."""
    return f"{value:.0f}" if abs(value - round(value)) < 0.05 else f"{value:.1f}"


def against(p: float, alpha: float) -> str:
    """Return a comparison of p with alpha in words that make no further claim."""
    return f"{p_words(p)} {'is at most' if p <= alpha else 'exceeds'} α = {bounded(alpha, 2)}"


def error_rate_warning(test: str) -> str:
    """Return a warning if a test's error rate in simulated studies was too high, else nothing."""
    rates = _rates()
    row = None if rates is None else rates.of(test)
    if row is None or row.warning not in ("rejects_too_often", "covers_too_seldom"):
        return ""
    share = f"{100.0 * row.rate:.1f} %"
    if row.warning == "covers_too_seldom":
        return f"These intervals included the true value in {share} of simulated studies, not 95 %."
    return f"This test rejected in {share} of simulated studies without an effect, not in 5 %."


@cache
def _rates() -> ErrorRates | None:
    stored = files("app.science.statistics") / _RATES
    return error_rates_from_json(stored.read_text(encoding="utf-8")) if stored.is_file() else None


def mean_words(values: FloatArray) -> str:
    """Return the mean with its interval in brackets, or the mean alone if n is too small."""
    found = mean_interval(values)
    if found is None:
        return number(float(values.mean())) if values.size else number(None)
    return f"{number(found.mean)} {_ends(found)}"


def interval_words(values: FloatArray) -> str:
    """Return the interval of the mean, or a dash if n is too small."""
    found = mean_interval(values)
    return number(None) if found is None else _ends(found)


def mean_interval(values: FloatArray) -> MeanInterval | None:
    """Return Student's 95 % interval of the mean; None if n is too small or nothing varies."""
    try:
        found = interval_of(values)
    except TooFewData:
        return None
    return found if found.sd > 0.0 else None


def _ends(found: MeanInterval) -> str:
    return f"[{number(found.low)}, {number(found.high)}]"
