"""Bring a lab's trackers into the headset's world, by a tracker that is fixed to the headset.

The person looks around. How fast headset and tracker turn shows the delay between them, and their
poses show where the tracking system's world lies in the headset's and how the tracker sits on the
head. From then on the alignment is watched, and fitted again after a recentre and against drift.
No clock is read, and nothing is random: time is part of the samples.
"""

from app.science.alignment.delay import LONGEST_DELAY_S, DelayFit, estimate_delay
from app.science.alignment.fit import fit_alignment, refit_alignment, refit_world
from app.science.alignment.looking import Looking, looking_around
from app.science.alignment.poses import AlignmentError, PoseStream, Problem
from app.science.alignment.results import REACH_M, Alignment, Mount, Quality
from app.science.alignment.watching import (
    STEP_S,
    WINDOW_S,
    Change,
    Jump,
    Watched,
    find_jump,
    follow,
    start_watching,
    watch,
)

__all__ = [
    "LONGEST_DELAY_S",
    "REACH_M",
    "STEP_S",
    "WINDOW_S",
    "Alignment",
    "AlignmentError",
    "Change",
    "DelayFit",
    "Jump",
    "Looking",
    "Mount",
    "PoseStream",
    "Problem",
    "Quality",
    "Watched",
    "estimate_delay",
    "find_jump",
    "fit_alignment",
    "follow",
    "looking_around",
    "refit_alignment",
    "refit_world",
    "start_watching",
    "watch",
]
