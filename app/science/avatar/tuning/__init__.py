"""Find gains for every axis of an avatar by relay experiments, and test them on the whole body."""

from app.science.avatar.tuning.assessment import Assessment, assess
from app.science.avatar.tuning.curves import RelayCurve, StepCurve, relay_curve, step_curve
from app.science.avatar.tuning.disturbance import RETURNED_RAD, Disturbance, Response, disturb
from app.science.avatar.tuning.heuristics import HEURISTICS
from app.science.avatar.tuning.plant import Pose
from app.science.avatar.tuning.relay import NoOscillation, RelaySettings
from app.science.avatar.tuning.results import (
    AxisTuning,
    Experiment,
    Phase,
    TuningCancelled,
    TuningError,
    TuningJournal,
    TuningOptions,
    TuningProgress,
    TuningReport,
)
from app.science.avatar.tuning.step_response import StepFigures
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
    "RETURNED_RAD",
    "Assessment",
    "AxisTuning",
    "Disturbance",
    "Experiment",
    "Followed",
    "NoOscillation",
    "Phase",
    "Pose",
    "RelayCurve",
    "RelaySettings",
    "Response",
    "Spread",
    "StepCurve",
    "StepFigures",
    "Tracking",
    "TuningCancelled",
    "TuningError",
    "TuningJournal",
    "TuningOptions",
    "TuningProgress",
    "TuningReport",
    "assess",
    "disturb",
    "follow_capture",
    "relay_curve",
    "step_curve",
    "track",
    "tune",
]
