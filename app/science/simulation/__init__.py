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
from app.science.simulation.traits import MovementTraits

__all__ = [
    "GESTURES_DEG",
    "Aspect",
    "Build",
    "FingerCapsules",
    "Footing",
    "Goal",
    "GoalKind",
    "LoopedFingers",
    "MovementTraits",
    "SimulatedFingers",
    "SimulatedItem",
    "SimulatedParticipant",
    "SimulationError",
    "agreement",
    "draw_build",
    "gesture_angles",
    "idle_movement",
    "pointing",
    "relaxed_pose",
    "simulated_answers",
]
