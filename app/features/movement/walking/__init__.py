"""Predict how people walk: scenes, sets of walks, models fitted to them, and predictions.

Fits and predictions run in two worker processes (`FittingDesk`, `Bench`), so that pages get answers
during a fit.
"""

from app.features.movement.walking.bench import Bench
from app.features.movement.walking.desk import FittingDesk

__all__ = ["Bench", "FittingDesk"]
