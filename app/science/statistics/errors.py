"""What can be wrong with data before any test is made of them.

StatisticsError        the data cannot be analysed so; the message says what is needed instead
├── UnusableTable      a row of a table cannot be used: names its line, column and value
├── TooFewData         subjects, levels or values are missing for this analysis
└── ConstantData       nothing varies, so that there is nothing to test
"""


class StatisticsError(ValueError):
    """The data cannot be analysed so; says what was found and what is needed."""


class UnusableTable(StatisticsError):
    """A row of a table cannot be used; says in which line and column, and what stands there."""


class TooFewData(StatisticsError):
    """There are too few subjects, levels or values for this analysis."""


class ConstantData(StatisticsError):
    """Nothing varies, or nothing is left that chance could explain."""
