"""Figures for a dashboard: valid rows of the tables in, plotly figures out; no SQL.

Every builder gives a `Drawing`: a figure with its title and caption, or, where there is too little
to draw, one plain sentence on what is missing.
"""

from app.features.analysis.figures.completions import completions_drawing
from app.features.analysis.figures.contacts import contacts_drawing
from app.features.analysis.figures.drawing import Drawing
from app.features.analysis.figures.embodiment import embodiment_drawings
from app.features.analysis.figures.joint_errors import (
    joint_error_drawing,
    joint_error_map_drawing,
)
from app.features.analysis.figures.progress import progress_drawing

__all__ = [
    "Drawing",
    "completions_drawing",
    "contacts_drawing",
    "embodiment_drawings",
    "joint_error_drawing",
    "joint_error_map_drawing",
    "progress_drawing",
]
