"""What a test is asked about, and what all tests say alike."""

from dataclasses import dataclass

from app.features.results.analysis.questions.measures import Measure
from app.features.results.analysis.questions.words import bounded, number, p_words
from app.science.statistics import Comparison, FloatArray, complete_rows

WILCOXON_SOURCE = (
    "Wilcoxon 1945, Biometrics Bull. 1:80; Holm 1979, Scand. J. Stat. 6:65; Kerby 2014, Compr. "
    "Psychol. 3:1; Efron 1987, J. Am. Stat. Assoc. 82:171."
)


@dataclass(frozen=True, eq=False)
class Asked:
    """One measure at one limb.

    `table`: (n, L) participants x latencies, NaN where there is no value.
    """

    measure: Measure
    limb: str
    table: FloatArray
    alpha: float

    @property
    def complete(self) -> FloatArray:
        """The participants with every latency."""
        return complete_rows(self.table)[0]

    @property
    def name(self) -> str:
        """As a paper names it."""
        return f"{self.measure.title}, {self.limb} task"


def apa_of(one: Comparison) -> str:
    """A comparison in a line for a paper."""
    return (
        f"{one.a} vs. {one.b} ms: W = {number(one.test.w, 1)}, n = {one.test.n}, "
        f"{p_words(one.test.p)}, Holm-adjusted {p_words(one.p_holm)}, rank-biserial r = "
        f"{bounded(one.test.rank_biserial, 2)}"
    )


def listwise(asked: Asked) -> str:
    """How many are left out of tests that need every latency; nothing where nobody is."""
    left = len(asked.table) - len(asked.complete)
    return f"{left} participants without every latency are left out." if left else ""
