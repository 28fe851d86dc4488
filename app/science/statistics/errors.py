"""Errors of data that cannot be analysed.

StatisticsError        the data cannot be analysed this way; the message says what is needed
├── UnusableTable      a row of a table is invalid: names its line, column and value
├── TooFewData         there are too few subjects, levels or values for this analysis
└── ConstantData       nothing varies, so that there is nothing to test
"""


class StatisticsError(ValueError):
    """The data cannot be analysed this way; the message says what was found and what is needed."""


class UnusableTable(StatisticsError):
    """A row of a table is invalid; the message names line, column and value."""


class TooFewData(StatisticsError):
    """There are too few subjects, levels or values for this analysis."""


class ConstantData(StatisticsError):
    """Nothing varies, or no random variation is left to test against."""
