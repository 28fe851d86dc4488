"""Turn the stored record of a study into tables, scores, tests and figures.

Importing this package loads neither pandas nor plotly: figures and tests are computed in worker
processes (`Drawings`). Code that needs pandas imports the subpackages `tables`, `codebook`,
`figures` and `questions` directly.
"""

from app.features.results.analysis.drawing import Drawings
from app.features.results.analysis.preparation import FigurePreparation
from app.features.results.analysis.schemas import DashboardKind, Kind

__all__ = ["DashboardKind", "Drawings", "FigurePreparation", "Kind"]
