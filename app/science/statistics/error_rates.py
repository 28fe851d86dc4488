"""How often each test rejects where nothing is, measured beforehand and shipped with the product.

`error_rates.json` beside this file is made by `./run bench error_rates --write`, from data sets of
`error_rates`. Each row tells of one test or interval in one scenario: on how many data sets it was
tried, how often it could not be made, and its rate. A page that shows the test warns where the rate
is out of bounds, which are 4 to 6.5 % for tests at 5 %, and 93.5 % for intervals of 95 %.

Rejecting too seldom is no error of the kind that reviewers fear: it costs power. An exact test of
few distinct values does so by necessity, because no sharper threshold exists.
"""

import json
import math
from dataclasses import dataclass
from typing import Any, Literal

Kind = Literal["rejection", "coverage"]
Warned = Literal["", "rejects_too_often", "rejects_too_seldom", "covers_too_seldom"]
LEVEL = 0.05
FEWEST_REJECTIONS, MOST_REJECTIONS, LEAST_COVERAGE = 0.04, 0.065, 0.935


@dataclass(frozen=True)
class ErrorRate:
    """One test or interval in one scenario.

    Attributes:
        test: its name in the product, for instance `friedman_exact`.
        scenario: `level` (participants differ in level) or `reactions` (also in their reactions).
        measure: what it was tried on: `item`, `measure`, `scale`.
        kind: what `rate` counts: rejections at 5 %, or intervals of 95 % that held the truth.
        exact: whether the test promises not to exceed 5 % in this scenario.
        participants: of each data set; 0 for all sizes together.
        sets: data sets on which it could be made.
        failed: on which it could not, not counted in `sets`.
        rate: 0 to 1.
    """

    test: str
    scenario: str
    measure: str
    kind: Kind
    exact: bool
    participants: int
    sets: int
    failed: int
    rate: float

    @property
    def standard_error(self) -> float:
        """Of the rate, by the number of data sets."""
        return math.sqrt(self.rate * (1.0 - self.rate) / self.sets) if self.sets else math.nan

    @property
    def warning(self) -> Warned:
        """What a page must say beside the test; empty if nothing."""
        if not self.sets:
            return ""
        if self.kind == "coverage":
            return "covers_too_seldom" if self.rate < LEAST_COVERAGE else ""
        if self.rate > MOST_REJECTIONS:
            return "rejects_too_often"
        return "rejects_too_seldom" if self.rate < FEWEST_REJECTIONS else ""

    @property
    def keeps_its_promise(self) -> bool:
        """Not above 5 % by more than three standard errors, if it is exact."""
        tolerance = 3.0 * math.sqrt(LEVEL * (1.0 - LEVEL) / max(self.sets, 1))
        return not self.exact or self.rate <= LEVEL + tolerance


@dataclass(frozen=True)
class ErrorRates:
    """The table.

    Attributes:
        seed: of all data sets.
        design: what they were like, as in `NullDesign`.
        rows: one a test, scenario and number of participants.
    """

    seed: int
    design: dict[str, Any]
    rows: tuple[ErrorRate, ...]

    def of(self, test: str, scenario: str = "level", participants: int = 0) -> ErrorRate | None:
        """The row of a test; None if it was not measured."""
        asked = (test, scenario, participants)
        for row in self.rows:
            if (row.test, row.scenario, row.participants) == asked:
                return row
        return None

    def near(self, test: str, participants: int, scenario: str = "level") -> ErrorRate | None:
        """The row of a test with the number of participants nearest to the study's.

        Which is the one to warn by: what fails with 12 may hold with 24. None if it was not
        measured.
        """
        rows = [
            row
            for row in self.rows
            if (row.test, row.scenario) == (test, scenario) and row.participants
        ]
        return min(rows, key=lambda row: abs(row.participants - participants), default=None)


def error_rates_from_json(text: str) -> ErrorRates:
    """Read `error_rates.json`."""
    stored = json.loads(text)
    rows = tuple(ErrorRate(**row) for row in stored["rows"])
    return ErrorRates(stored["seed"], stored["design"], rows)
