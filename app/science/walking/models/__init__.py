"""Models of how people walk: fitting, sampling, prediction.

`fitted` chooses and fits a model to a `WalkDatabase`, `restored` rebuilds a stored one, and
`Predictor` predicts how long people take on a path.
"""

from app.science.walking.models.annealing import StaticFit
from app.science.walking.models.crps import covers, crps_s, iqr
from app.science.walking.models.fitting import (
    FitOptions,
    FittedWalking,
    NobodyWalks,
    fitted,
    restored,
    space_of,
)
from app.science.walking.models.prediction import (
    Prediction,
    Predictor,
    TooFewArriveError,
    predictor_for,
)
from app.science.walking.models.reading_choice import ReadingScore, person_folds, ranked_readings
from app.science.walking.models.sampling import HEADROOM, MixtureSampler, density_of
from app.science.walking.models.steering_models import ProbabilisticModel, SteeringModel
from app.science.walking.models.travel_time_model import (
    MIXED,
    WITHOUT,
    TravelTimeModel,
    baseline_models,
    each_left_out,
    models_without_each,
    timed_walks_of,
    travel_time_model,
)

__all__ = [
    "HEADROOM",
    "MIXED",
    "WITHOUT",
    "FitOptions",
    "FittedWalking",
    "MixtureSampler",
    "NobodyWalks",
    "Prediction",
    "Predictor",
    "ProbabilisticModel",
    "ReadingScore",
    "StaticFit",
    "SteeringModel",
    "TooFewArriveError",
    "TravelTimeModel",
    "baseline_models",
    "covers",
    "crps_s",
    "density_of",
    "each_left_out",
    "fitted",
    "iqr",
    "models_without_each",
    "person_folds",
    "predictor_for",
    "ranked_readings",
    "restored",
    "space_of",
    "timed_walks_of",
    "travel_time_model",
]
