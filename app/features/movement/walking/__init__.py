"""How people walk, predicted: scenes, sets of walks, models fitted on them, and their answers.

Fits and questions run in two processes (`FittingDesk`, `Bench`), so that a page is answered while a
fit goes on.
"""

from app.features.movement.walking.bench import Bench
from app.features.movement.walking.desk import FittingDesk

__all__ = ["Bench", "FittingDesk"]
