"""Any capture as the movement of a rehearsing participant."""

from pathlib import Path

from app.adapters.captures import CaptureError
from app.adapters.captures.files import read_capture_file
from app.science.retargeting import movement_in_place, propose_joint_map
from app.science.rig import RigError, RigMotion
from app.science.skeleton import Movement, Skeleton, SkeletonError


class UnusableCapture(ValueError):
    """The capture cannot be used as movement; says why and what to do."""


def captured_movement(path: Path, skeleton: Skeleton) -> Movement:
    """The capture's movement on a skeleton, in place and facing -z; markers get a skeleton first.

    Raises:
        UnusableCapture: the file cannot be read, or no body can be made of it.
    """
    try:
        source = skeleton_motion(path)
        joint_map = propose_joint_map(source.rig).joint_map
        return movement_in_place(source, joint_map, skeleton)
    except (CaptureError, RigError, SkeletonError, OSError) as error:
        raise UnusableCapture(f"{path} cannot be used: {error}") from error


def skeleton_motion(path: Path) -> RigMotion:
    """The movement of the capture's own skeleton, or of one fitted to its markers or bodies.

    Raises:
        UnusableCapture: no skeleton can be fitted.
        CaptureError, OSError: see `read_capture_file`.
    """
    motion = read_capture_file(path).motion
    if isinstance(motion, RigMotion):
        return motion
    from app.science.fitting import FitError, fit_skeleton  # most captures bring a skeleton

    try:
        return fit_skeleton(motion).motion
    except FitError as error:
        raise UnusableCapture(f"{path} cannot be used: {error}") from error
