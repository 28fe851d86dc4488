"""Data types of a fit: its result, the joints it is assembled from, and its error."""

from dataclasses import dataclass

import numpy as np

from app.science.anatomy import Notice
from app.science.rig import BoolArray, RigMotion
from app.science.rotations import FloatArray


class FitError(ValueError):
    """No skeleton can be fitted; the message says what is missing and what would be sufficient."""


@dataclass(frozen=True, eq=False)
class Fitted:
    """A skeleton fitted to markers or bodies.

    Attributes:
        motion: the rig's joints have the names of the body's (`app.science.skeleton.JOINT_NAMES`);
            its rest pose is the T-pose facing -z, all rotations the identity. Joints beyond which
            nothing is marked (toes, hands without finger markers) have their parent's rotation.
        unfitted: joints of the body that could not be fitted; their movement is part of their
            parent's.
        residual_m: rms distance between the rig's joints and the joint centres of each frame, which
            bones of constant length cannot all reach.
        first_frame: the frame of the capture with which `motion` begins.
        notes: sentences on what was trimmed, bridged or left out, and the notices as text.
        notices: what anatomy does not allow, and how it was mended.
    """

    motion: RigMotion
    unfitted: tuple[str, ...]
    residual_m: float
    first_frame: int = 0
    notes: tuple[str, ...] = ()
    notices: tuple[Notice, ...] = ()


@dataclass(frozen=True, eq=False)
class Part:
    """A joint as measured in N frames.

    Attributes:
        centre_m: (N, 3) position of the joint, NaN where it is unknown.
        axes: (N, 3, 3) matrices with the joint's x, y, z in the world as columns, which in the
            T-pose are the world's; None where they cannot be determined and the parent's are used.
        seen: (N,) mask, false where a marker it is computed from was bridged over a gap.
    """

    centre_m: FloatArray
    axes: FloatArray | None
    seen: BoolArray

    @property
    def present(self) -> BoolArray:
        """Mask (N,) of the frames with a known position, and known axes unless `axes` is None."""
        present: BoolArray = np.all(np.isfinite(self.centre_m), axis=-1)
        if self.axes is not None:
            present = present & np.isfinite(self.axes).all(axis=(-1, -2))
        return present


Parts = dict[str, Part]
