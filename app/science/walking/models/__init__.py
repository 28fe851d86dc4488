"""Models of how people walk: fitting, sampling, prediction.

`fitted` chooses and fits a model to a `WalkDatabase`, `restored` rebuilds a stored one, and
`Predictor` predicts how long people take on a path.
"""

from app.science.walking.models.annealing import StaticFit
from app.science.walking.models.crps import covers, crps_s, iqr
from app.science.walking.models.fitting import FitOptions, FittedWalking, fitted, restored, space_of
from app.science.walking.models.prediction import Prediction, Predictor, predictor_for
from app.science.walking.models.reading_choice import ReadingScore, person_folds
from app.science.walking.models.sampling import HEADROOM, MixtureSampler, density_of
from app.science.walking.models.steering_models import ProbabilisticModel, SteeringModel

__all__ = [
    "HEADROOM",
    "FitOptions",
    "FittedWalking",
    "MixtureSampler",
    "Prediction",
    "Predictor",
    "ProbabilisticModel",
    "ReadingScore",
    "StaticFit",
    "SteeringModel",
    "covers",
    "crps_s",
    "density_of",
    "fitted",
    "iqr",
    "person_folds",
    "predictor_for",
    "restored",
    "space_of",
]
