"""Mixed models: of a continuous measure, of ordinal answers, and of carry-over between periods.

`build_design` turns `factor`s and `covariate`s into columns, `fit_mixed_model` fits by REML and
`term_tests` tests with Satterthwaite's degrees of freedom; ordinal answers are tested by
`cumulative_term_tests`. This is separate from `statistics` because it loads SciPy's optimisers.
"""

from app.science.statistics.mixed.carry_over import carry_over
from app.science.statistics.mixed.cumulative_tests import cumulative_term_tests
from app.science.statistics.mixed.design import build_design
from app.science.statistics.mixed.model import fit_mixed_model
from app.science.statistics.mixed.term_tests import TermTest, contrasts, term_test, term_tests
from app.science.statistics.mixed.terms import covariate, factor

__all__ = [
    "TermTest",
    "build_design",
    "carry_over",
    "contrasts",
    "covariate",
    "cumulative_term_tests",
    "factor",
    "fit_mixed_model",
    "term_test",
    "term_tests",
]
