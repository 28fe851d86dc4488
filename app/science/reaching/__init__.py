"""How people reach: tempo and shape of a hand's movements as distributions, learnt from recordings.

After section 6 of Agethen, Gaisbauer and Rukzio (2018), "A Probabilistic Steering Parameter Model
for Deterministic Motion Planning Algorithms": suitability maps for reaching, with the machinery of
`app.science.walking`. From the bottom:

    records       the path of a hand, and a reach
    hands         the hands of a capture
    segmentation  from the path of a hand to reaches, and what is none
    agent         the simulation's own reach with every tempo and skew, and maps of recorded ones
    database      the maps of many reaches
    people        how people differ, kept apart from how one person's reaches differ
    model         the fitted model, from which the simulation draws people and movements
    evaluation    predictions of people who were left out, beside the assumed constants and a line

All lengths are metres, all times seconds.
"""

from app.science.reaching.agent import REACH_GRID, cut_agents, map_of
from app.science.reaching.database import LEAST_REACHES, reach_database
from app.science.reaching.evaluation import (
    ReachEvaluation,
    ReachScore,
    evaluate_reaching,
)
from app.science.reaching.hands import hand_tracks
from app.science.reaching.model import (
    FittedPerson,
    FittedReaching,
    ReachFitOptions,
    fitted_reaching,
    restored_reaching,
)
from app.science.reaching.people import Levels, levels_of
from app.science.reaching.records import (
    DIFFICULTY,
    DISTANCE,
    HandTrack,
    Reach,
    Reacher,
    ReachingError,
)
from app.science.reaching.segmentation import NoReach, ReachRules, reaches_of

__all__ = [
    "DIFFICULTY",
    "DISTANCE",
    "LEAST_REACHES",
    "REACH_GRID",
    "FittedPerson",
    "FittedReaching",
    "HandTrack",
    "Levels",
    "NoReach",
    "Reach",
    "ReachEvaluation",
    "ReachFitOptions",
    "ReachRules",
    "ReachScore",
    "Reacher",
    "ReachingError",
    "cut_agents",
    "evaluate_reaching",
    "fitted_reaching",
    "hand_tracks",
    "levels_of",
    "map_of",
    "reach_database",
    "reaches_of",
    "restored_reaching",
]
