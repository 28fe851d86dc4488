"""The tests that a study can declare as its primary one, each with its names and descriptions.

To add a test, write a module with its computation, a function from `Sample` to `Outcome`, and its
entry in `TESTS`. A study can then declare it, the editor and the preregistration page name it in
both languages, the results page runs it for every measure, and `reembody analyse` for every table.
"""

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import cast

from app.science.statistical_tests.sample import Direction, Outcome, Sample
from app.texts import Words


@dataclass(frozen=True)
class StatisticalTest:
    """A test of one within-subjects factor, the added latency.

    Attributes:
        key: the name of the test in study files, so it is never renamed.
        name: the name of the test in lists and fields.
        phrase: the test as named in an English sentence, such as "Friedman's test of the score
            agency".
        question: the question that it answers, as a heading.
        directions: the directions of the measure along the factor that a study may declare.
        fewest_conditions: the smallest number of levels of the factor that it accepts.
        needs_reference: whether it compares every level with a named reference level.
        assumptions: the conditions under which its p value is valid.
        effect_size: the effect size reported with p.
        source: the publication of the test.
        outcome: "module.function" below `app.science.statistical_tests`, imported when the test is
            run.
    """

    key: str
    name: Words
    phrase: str
    question: str
    directions: tuple[Direction, ...]
    fewest_conditions: int
    needs_reference: bool
    assumptions: str
    effect_size: str
    source: str
    outcome: str

    def load(self) -> Callable[[Sample], Outcome]:
        """Import the function that runs the test; it raises StatisticsError for invalid data."""
        module, _, function = self.outcome.rpartition(".")
        found = getattr(import_module(f"app.science.statistical_tests.{module}"), function)
        return cast("Callable[[Sample], Outcome]", found)


FRIEDMAN = StatisticalTest(
    key="friedman",
    name=Words(en="Friedman’s test", de="Friedman-Test"),
    phrase="Friedman's test",
    question="Do the latencies differ?",
    directions=("two_sided",),
    fewest_conditions=3,
    needs_reference=False,
    assumptions="Without an effect every order of a participant's values is equally likely.",
    effect_size="Kendall's W",
    source=(
        "Friedman 1937, J. Am. Stat. Assoc. 32:675; Kendall and Babington Smith 1939, Ann. Math. "
        "Stat. 10:275."
    ),
    outcome="outcomes.friedman_outcome",
)
PAGE_TREND = StatisticalTest(
    key="page_trend",
    name=Words(en="Page’s trend test", de="Trendtest nach Page"),
    phrase="Page's trend test",
    question="Is there a trend with latency?",
    directions=("rises", "falls"),
    fewest_conditions=3,
    needs_reference=False,
    assumptions="The order of the conditions is fixed beforehand.",
    effect_size="Page's L",
    source="Page 1963, J. Am. Stat. Assoc. 58:216.",
    outcome="outcomes.page_outcome",
)
RM_ANOVA = StatisticalTest(
    key="rm_anova",
    name=Words(
        en="Repeated-measures ANOVA (Greenhouse-Geisser)",
        de="Varianzanalyse mit Messwiederholung (Greenhouse-Geisser)",
    ),
    phrase="analysis of variance with repeated measures (Greenhouse-Geisser)",
    question="Do the means differ?",
    directions=("two_sided",),
    fewest_conditions=2,
    needs_reference=False,
    assumptions="Differences between conditions are normal; sphericity is corrected for.",
    effect_size="generalised eta squared",
    source=(
        "Winer, Brown and Michels 1991, ch. 7; Greenhouse and Geisser 1959, Psychometrika 24:95; "
        "Olejnik and Algina 2003, Psychol. Methods 8:434."
    ),
    outcome="outcomes.anova_outcome",
)
AGAINST_REFERENCE = StatisticalTest(
    key="against_reference",
    name=Words(
        en="Exact Wilcoxon tests against a reference condition",
        de="Exakte Wilcoxon-Tests gegen eine Bezugsbedingung",
    ),
    phrase="exact Wilcoxon signed-rank tests against the reference",
    question="Which latencies differ from the reference?",
    directions=("two_sided", "rises", "falls"),
    fewest_conditions=2,
    needs_reference=True,
    assumptions="Without an effect differences are symmetric around zero.",
    effect_size="matched rank-biserial correlation",
    source=(
        "Wilcoxon 1945, Biometrics Bull. 1:80; Holm 1979, Scand. J. Stat. 6:65; Kerby 2014, Compr. "
        "Psychol. 3:1; Efron 1987, J. Am. Stat. Assoc. 82:171."
    ),
    outcome="outcomes.reference_outcome",
)
TESTS: tuple[StatisticalTest, ...] = (FRIEDMAN, PAGE_TREND, RM_ANOVA, AGAINST_REFERENCE)


def statistical_test(key: str) -> StatisticalTest:
    """Return the test with this key; raises KeyError if there is none."""
    return {test.key: test for test in TESTS}[key]


def texts_of_tests() -> dict[str, Words]:
    """Return the names of the tests, by their keys in the text tables of the pages."""
    return {f"value.{test.key}": test.name for test in TESTS}
