"""Build plotly figures for a dashboard from the valid rows of the tables; no SQL.

Every builder returns a `Drawing`: a figure with its title, its caption and the rows in it, or,
where there is too little to draw, one plain sentence on what is missing.
"""

from app.features.results.analysis.figures.achieved import achieved_drawing
from app.features.results.analysis.figures.body_map import joint_error_body_drawing
from app.features.results.analysis.figures.by_demographics import demographics_drawings
from app.features.results.analysis.figures.completions import completions_drawing, learning_drawing
from app.features.results.analysis.figures.contact_map import contact_map_drawing
from app.features.results.analysis.figures.contacts import contacts_drawing
from app.features.results.analysis.figures.crossings import crossings_drawings
from app.features.results.analysis.figures.drawing import Drawing
from app.features.results.analysis.figures.embodiment import embodiment_drawings
from app.features.results.analysis.figures.exclusions import exclusions_drawing
from app.features.results.analysis.figures.joint_error_blocks import joint_error_blocks_drawing
from app.features.results.analysis.figures.joint_error_course import joint_error_course_drawing
from app.features.results.analysis.figures.joint_errors import (
    joint_error_drawing,
    joint_error_map_drawing,
)
from app.features.results.analysis.figures.likert import likert_drawings
from app.features.results.analysis.figures.progress import progress_drawing, progress_time_drawing
from app.features.results.analysis.figures.quality import alarms_drawing, quality_drawing
from app.features.results.analysis.figures.registry import FIGURES, Figure, Rows, orders_of

__all__ = [
    "FIGURES",
    "Drawing",
    "Figure",
    "Rows",
    "achieved_drawing",
    "alarms_drawing",
    "completions_drawing",
    "contact_map_drawing",
    "contacts_drawing",
    "crossings_drawings",
    "demographics_drawings",
    "embodiment_drawings",
    "exclusions_drawing",
    "joint_error_blocks_drawing",
    "joint_error_body_drawing",
    "joint_error_course_drawing",
    "joint_error_drawing",
    "joint_error_map_drawing",
    "learning_drawing",
    "likert_drawings",
    "orders_of",
    "progress_drawing",
    "progress_time_drawing",
    "quality_drawing",
]
