"""The codebook: one description of every exported column.

The tables are built from it: each table has exactly the columns of its codebook entries, in their
order. So no column can be exported without a description.
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
from app.features.results.analysis.codebook.trackers import COMPANION_POSE

__all__ = [
    "CODEBOOK",
    "COMPANION_POSE",
    "TABLES",
    "Column",
    "ColumnType",
    "codebook",
    "codebook_frame",
    "columns_of",
    "data_dictionary",
]
