"""The remote avatar of the scripted headset: what it does with each pose, and what it touches."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from app.science.delay import DelayBuffer
from app.science.skeleton import Pose, Skeleton, body_part_segments, forward_kinematics
from app.science.tasks import SurfaceArrays, TaskLayout, touching_and_near

FloatArray = NDArray[np.float64]
Bools = NDArray[np.bool_]
RELEASE_MARGIN_M = 0.005
"""How far a part may go from a surface before its touch is over."""


class RemoteAvatar(Protocol):
    """The body that the participant sees as theirs."""

    def set_latency(self, latency_s: float) -> None:
        """Follow so much later from now on."""

    def show_boxes(self, layout: TaskLayout | None) -> None:
        """Put the boxes of a task into the room, or take all away."""

    def frame(self, t_s: float, pose: Pose) -> Pose:
        """Where the avatar is when the participant is in this pose, frame after frame."""

    def touches(self) -> tuple[Bools, Bools]:
        """What it touches at the last frame, and what is near enough to hold a touch.

        Two bool (S, 22), surfaces of the task by joints of the skeleton; (0, 22) without boxes.
        """


class DelayedCopy:
    """The participant's own movement, with every joint but the hips delayed."""

    def __init__(self, skeleton: Skeleton) -> None:
        self._skeleton, self._delay = skeleton, DelayBuffer(0.0)
        self._surfaces: SurfaceArrays | None = None
        self._pose: Pose | None = None

    def set_latency(self, latency_s: float) -> None:
        """Follow so much later from now on."""
        self._delay.set_delay(latency_s)

    def show_boxes(self, layout: TaskLayout | None) -> None:
        """What is judged from now on; a copy passes through everything."""
        self._surfaces = None if layout is None else SurfaceArrays.of(layout)

    def frame(self, t_s: float, pose: Pose) -> Pose:
        """The hips as they are, the joints as they were."""
        self._pose = Pose(pose.root_position_m, self._delay.push(t_s, pose.rotations))
        return self._pose

    def touches(self) -> tuple[Bools, Bools]:
        """By the distances of the body's capsules from the boxes."""
        if self._surfaces is None or self._pose is None:
            return no_touches()
        world = forward_kinematics(self._skeleton, self._pose.root_position_m, self._pose.rotations)
        parts = body_part_segments(self._skeleton, world)
        return touching_and_near(self._surfaces, parts.axes_m, parts.radii_m, RELEASE_MARGIN_M)


def no_touches() -> tuple[Bools, Bools]:
    """Nothing to touch."""
    nothing = np.zeros((0, 22), dtype=np.bool_)
    return nothing, nothing
