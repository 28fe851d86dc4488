"""From the record to tables, scores and figures.

This face loads neither pandas nor plotly: figures and tests are computed in processes of their own
(`Drawings`). What needs pandas has faces of its own: `tables`, `codebook`, `figures`, `questions`.
"""

from app.features.results.analysis.drawing import Drawings
from app.features.results.analysis.schemas import DashboardKind, Kind

__all__ = ["DashboardKind", "Drawings", "Kind"]
