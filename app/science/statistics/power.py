"""The power of a planned study, and the number of subjects it needs for an effect of given size.

For one within-subjects factor of m levels, with f^2 = eta^2 / (1 - eta^2) of the partial eta
squared expected, correlation r between levels and sphericity epsilon, the F test's noncentrality is
n m f^2 epsilon / (1 - r), with (m - 1) epsilon and (n - 1)(m - 1) epsilon degrees of freedom. This
is the default of G*Power 3 and pingouin's. An eta squared *observed* in a study already includes r
(G*Power's options "as in SPSS" and "as in Cohen"), and must not be used with r > 0.

Faul, Erdfelder, Lang and Buchner 2007, Behavior Research Methods 39:175-191.
"""

from dataclasses import dataclass

from scipy.special import fdtri, ncfdtr

from app.science.statistics.errors import StatisticsError

_MOST_SUBJECTS = 100_000


@dataclass(frozen=True)
class Expected:
    """The expected effect and the planned test.

    Attributes:
        partial_eta_squared: between 0 and 1; .01, .06 and .14 are called small, medium, large.
        levels: the number of levels m, at least 2.
        correlation: the correlation between two levels over subjects, below 1.
        epsilon: the sphericity, 1 / (m - 1) to 1.
        alpha: the significance level of the test.
    """

    partial_eta_squared: float
    levels: int = 3
    correlation: float = 0.5
    epsilon: float = 1.0
    alpha: float = 0.05

    def __post_init__(self) -> None:
        """Raise StatisticsError for values out of range."""
        checks = (
            ("partial eta squared", self.partial_eta_squared, 0.0 < self.partial_eta_squared < 1.0),
            ("levels", self.levels, self.levels >= 2),
            ("correlation", self.correlation, -1.0 < self.correlation < 1.0),
            ("alpha", self.alpha, 0.0 < self.alpha < 1.0),
        )
        for name, value, fits in checks:
            if not fits:
                raise StatisticsError(f"{name} {value} is out of range.")
        least = 1.0 / (self.levels - 1)
        if not least <= self.epsilon <= 1.0:
            raise StatisticsError(f"epsilon {self.epsilon}; valid from {least:.3f} to 1.")


def rm_anova_power(n: int, expected: Expected) -> float:
    """Return the probability that the test of n subjects is significant, given the effect.

    Raises StatisticsError for n below 2.
    """
    if n < 2:
        raise StatisticsError(f"{n} subjects; at least 2 are needed.")
    eta, m = expected.partial_eta_squared, expected.levels
    df = (m - 1) * expected.epsilon
    df_error = (n - 1) * df
    squared = eta / (1.0 - eta)
    noncentrality = n * m * squared * expected.epsilon / (1.0 - expected.correlation)
    critical = float(fdtri(df, df_error, 1.0 - expected.alpha))
    return 1.0 - float(ncfdtr(df, df_error, noncentrality, critical))


def subjects_needed(power: float, expected: Expected) -> int:
    """Return the smallest n with at least this power, 0 to 1; raises StatisticsError beyond 1e5."""
    if not 0.0 < power < 1.0:
        raise StatisticsError(f"The power is {power}; give a number between 0 and 1.")
    low, high = 1, 2
    while rm_anova_power(high, expected) < power:
        if high >= _MOST_SUBJECTS:
            raise StatisticsError(
                f"More than {_MOST_SUBJECTS} subjects would be needed for a partial eta squared of"
                f" {expected.partial_eta_squared}."
            )
        low, high = high, 2 * high
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if rm_anova_power(middle, expected) >= power else (middle, high)
    return high
