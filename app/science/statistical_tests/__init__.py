"""The registry of the statistical tests that a study can declare: their names and requirements.

`TESTS` loads no numpy and no scipy, because study files are checked while the server starts.
`StatisticalTest.load` imports the module that computes the test.
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
