"""The registry of the tests that a study can declare: what they are called, and what they need.

`TESTS` loads no numpy and no scipy, because a study file is checked while the server starts.
`StatisticalTest.load` imports the module that computes.
"""

from app.science.statistical_tests.registry import (
    TESTS,
    StatisticalTest,
    statistical_test,
    texts_of_tests,
)
from app.science.statistical_tests.sample import Direction, Outcome, Sample

__all__ = [
    "TESTS",
    "Direction",
    "Outcome",
    "Sample",
    "StatisticalTest",
    "statistical_test",
    "texts_of_tests",
]
