"""What a simulated avatar tells of itself."""

from dataclasses import dataclass

from app.science.rotations import FloatArray


@dataclass(frozen=True, eq=False)
class AvatarState:
    """The avatar at one moment.

    Attributes:
        time_s: steps taken times 2 ms.
        root_position_m: (3,) the hips' joint in the world.
        rotations: (22, 4) local rotations wxyz as in `skeleton`; row 0 is world_from_hips.
        angles_rad: (91,) in the order of `AXIS_NAMES`; NaN where the model has no hinge.
        command_rad: (91,) likewise, the targets in force before any added latency.
    """

    time_s: float
    root_position_m: FloatArray
    rotations: FloatArray
    angles_rad: FloatArray
    command_rad: FloatArray


@dataclass(frozen=True)
class Health:
    """What happened since the beginning.

    Attributes:
        restored: frames after which the simulation had failed and was put back.
        ignored_inputs: frames with a value that was not finite.
        limited_targets: frames in which a target moved faster than `simulation.MAX_SPEED_RAD_S`.
        teleports: times the hips were put elsewhere.
    """

    restored: int
    ignored_inputs: int
    limited_targets: int
    teleports: int
