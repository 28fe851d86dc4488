"""Tidy CSV with a codebook.

This face loads no pandas: files are made in a process of their own (`ExportDesk`). Whoever writes
an export itself uses `writing`.
"""

from app.features.results.exports.desk import ExportDesk
from app.features.results.exports.names import safe_name

__all__ = ["ExportDesk", "safe_name"]
