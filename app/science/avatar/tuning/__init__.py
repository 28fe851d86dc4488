"""Finds gains for every axis of an avatar by relay experiments, and proves them on the body."""

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
    NOTHING,
    Followed,
    Spread,
    Tracking,
    follow_capture,
    track,
)
from app.science.avatar.tuning.tuner import tune

__all__ = [
    "HEURISTICS",
    "NOTHING",
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
