"""Convert any captured movement to a track on the floor: skeletons, rigid bodies, markers."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from app.science.retargeting import propose_joint_map
from app.science.rig import BodyMotion, MarkerMotion, RigMotion
from app.science.walking.recording.centre_of_mass import NEEDED
from app.science.walking.recording.tracks import (
    TORSO_DEPTH_M,
    Walker,
    track_of_belt,
    track_of_markers,
    track_of_rig,
)
from app.science.walking.records import Track, WalkingError

PELVIS = (("LASI", "RASI", "LPSI", "RPSI"), ("LFWT", "RFWT", "LBWT", "RBWT"))
"""Names of the four pelvis markers in the two usual marker sets."""


@dataclass(frozen=True)
class TrackingOptions:
    """Options that select which part of a capture is used as the person's position.

    Attributes:
        joint_map: the joint map of a skeleton; None to derive it from the joints' names.
        point: the tracked point of a skeleton; None for the centre of mass if all joints it needs
            are present, else the hips.
        body: the rigid body worn on the belt; None if there is only one.
        torso_depth_m, off_skin_m: the measures of the person at the belt.
        markers: the markers whose mean is tracked; None for the four of the pelvis.
    """

    joint_map: Mapping[str, str] | None = None
    point: Literal["centre of mass", "hips"] | None = None
    body: str | None = None
    torso_depth_m: float = TORSO_DEPTH_M
    off_skin_m: float = 0.0
    markers: tuple[str, ...] | None = None


DEFAULT_OPTIONS = TrackingOptions()


def track_of_motion(
    motion: RigMotion | BodyMotion | MarkerMotion,
    walker: Walker,
    options: TrackingOptions = DEFAULT_OPTIONS,
) -> Track:
    """Make a track of a captured movement.

    Raises:
        WalkingError: the capture contains several bodies or no pelvis and none is named, a name is
            not in it, or the person was not seen for too long.
    """
    if isinstance(motion, RigMotion):
        joint_map = options.joint_map or propose_joint_map(motion.rig).joint_map
        whole = all(joint in joint_map for joint in NEEDED)
        return track_of_rig(
            motion, joint_map, walker, options.point or ("centre of mass" if whole else "hips")
        )
    if isinstance(motion, BodyMotion):
        if options.body is None and len(motion.names) != 1:
            raise WalkingError(
                f"Several bodies were tracked, {', '.join(motion.names)}: name the one on the belt."
            )
        return track_of_belt(
            motion,
            options.body or motion.names[0],
            walker,
            torso_depth_m=options.torso_depth_m,
            off_skin_m=options.off_skin_m,
        )
    return track_of_markers(motion, options.markers or _pelvis(motion), walker)


def _pelvis(motion: MarkerMotion) -> tuple[str, ...]:
    for names in PELVIS:
        if all(name in motion.names for name in names):
            return names
    raise WalkingError(
        f"No pelvis markers ({', '.join(PELVIS[0])}) are among {', '.join(motion.names)}: name the"
        " markers whose mean is to be tracked."
    )
