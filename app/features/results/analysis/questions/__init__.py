"""Statistical tests of a study's measures in sentences and tables, and the values they test.

The tests themselves (`answers_of` in `answers`) are not imported here: an export only needs the
values, and would take a second longer to start.
"""

from app.features.results.analysis.questions.wide import WideColumn, wide_table

__all__ = ["WideColumn", "wide_table"]
