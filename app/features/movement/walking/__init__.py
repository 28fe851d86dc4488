"""Predict how people walk: scenes, sets of walks, models fitted to them, and predictions.

Fits and predictions run in two worker processes (`FitQueue`, `PredictionQueue`), so that pages get
answers during a fit.
"""

from app.features.movement.walking.fit_queue import FitQueue
from app.features.movement.walking.prediction_queue import PredictionQueue

__all__ = ["FitQueue", "PredictionQueue"]
