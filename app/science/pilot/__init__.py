"""Simulated data sets of studies that were not run yet, and the power of tests on them.

    Course, drawn_courses       what moves a participant's level from block to block
    GradedItem, drawn_ratings   ratings of items by the graded response model
    drawn_visits                who stops, and which slot of the ledger everybody gets
    PowerPoint, power_point     the share of significant tests, with its band and its errors
    smallest_sufficient

Everything that goes in is an assumption, so nothing that comes out is a finding about people.
"""

from app.science.pilot.course import Course, Visits, drawn_courses, drawn_visits
from app.science.pilot.graded import GradedItem, drawn_ratings, expected_rating
from app.science.pilot.power import PowerPoint, Results, power_point, smallest_sufficient

__all__ = [
    "Course",
    "GradedItem",
    "PowerPoint",
    "Results",
    "Visits",
    "drawn_courses",
    "drawn_ratings",
    "drawn_visits",
    "expected_rating",
    "power_point",
    "smallest_sufficient",
]
