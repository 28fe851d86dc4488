"""Fit skeletons to data without one: markers on the skin, or rigid bodies strapped to a person."""

from app.science.fitting.fit import fit_skeleton
from app.science.fitting.model import FitError, Fitted

__all__ = ["FitError", "Fitted", "fit_skeleton"]
