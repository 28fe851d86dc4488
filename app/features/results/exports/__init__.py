"""Export a study as tidy CSV files with a codebook.

Importing this package does not load pandas: files are made in worker processes (`ExportDesk`).
Code that writes an export in its own process imports `writing`.
"""

from app.features.results.exports.desk import ExportDesk
from app.features.results.exports.names import safe_name

__all__ = ["ExportDesk", "safe_name"]
