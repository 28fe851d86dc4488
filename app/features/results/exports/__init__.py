"""Export a study as tidy CSV files with a codebook.

Importing this package does not load pandas: files are made in worker processes (`ExportQueue`).
Code that writes an export in its own process imports `writing`.
"""

from app.features.results.exports.export_queue import ExportQueue
from app.features.results.exports.names import safe_name

__all__ = ["ExportQueue", "safe_name"]
