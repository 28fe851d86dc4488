"""The simulated participant: how a person moves through the tasks and answers afterwards."""

from app.science.simulation.answers import (
    Aspect,
    SimulatedItem,
    agreement,
    simulated_answers,
)
from app.science.simulation.build import Build, draw_build
from app.science.simulation.finger_capsules import FingerCapsules, pointing
from app.science.simulation.fingers import (
    GESTURES_DEG,
    LoopedFingers,
    SimulatedFingers,
    gesture_angles,
)
from app.science.simulation.footing import Footing
from app.science.simulation.goal import Goal, GoalKind, SimulationError
from app.science.simulation.idle import idle_movement, relaxed_pose
from app.science.simulation.participant import SimulatedParticipant
from app.science.simulation.paths import skewed_jerk
from app.science.simulation.traits import (
    TEMPO_SPREAD,
    MovementTraits,
    ReachingPeople,
    ReachingPerson,
    difficulty_bits,
    draw_traits,
    shortest_time_s,
    usual_time_s,
)

__all__ = [
    "GESTURES_DEG",
    "TEMPO_SPREAD",
    "Aspect",
    "Build",
    "FingerCapsules",
    "Footing",
    "Goal",
    "GoalKind",
    "LoopedFingers",
    "MovementTraits",
    "ReachingPeople",
    "ReachingPerson",
    "SimulatedFingers",
    "SimulatedItem",
    "SimulatedParticipant",
    "SimulationError",
    "agreement",
    "difficulty_bits",
    "draw_build",
    "draw_traits",
    "gesture_angles",
    "idle_movement",
    "pointing",
    "relaxed_pose",
    "shortest_time_s",
    "simulated_answers",
    "skewed_jerk",
    "usual_time_s",
]
