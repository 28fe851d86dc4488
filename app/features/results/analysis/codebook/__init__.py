"""Every exported column, described exactly once.

The codebook is not written beside the tables, it makes them: a table has the columns of its
entries, in their order. So no column can be exported without a description.
"""

from app.features.results.analysis.codebook.book import (
    CODEBOOK,
    TABLES,
    codebook,
    codebook_frame,
    columns_of,
    data_dictionary,
)
from app.features.results.analysis.codebook.column import Column, ColumnType

__all__ = [
    "CODEBOOK",
    "TABLES",
    "Column",
    "ColumnType",
    "codebook",
    "codebook_frame",
    "columns_of",
    "data_dictionary",
]
