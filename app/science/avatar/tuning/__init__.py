"""Find gains for every axis of an avatar by relay experiments, and test them on the whole body."""

from app.science.avatar.tuning.assessment import Assessment, assess
from app.science.avatar.tuning.heuristics import HEURISTICS
from app.science.avatar.tuning.results import (
    AxisTuning,
    TuningCancelled,
    TuningError,
    TuningOptions,
    TuningProgress,
    TuningReport,
)
from app.science.avatar.tuning.tracking import (
    EMPTY_SPACE,
    Followed,
    Spread,
    Tracking,
    follow_capture,
    track,
)
from app.science.avatar.tuning.tuner import tune

__all__ = [
    "EMPTY_SPACE",
    "HEURISTICS",
    "Assessment",
    "AxisTuning",
    "Followed",
    "Spread",
    "Tracking",
    "TuningCancelled",
    "TuningError",
    "TuningOptions",
    "TuningProgress",
    "TuningReport",
    "assess",
    "follow_capture",
    "track",
    "tune",
]
