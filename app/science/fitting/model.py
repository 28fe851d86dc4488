"""What a fit gives back."""

from dataclasses import dataclass

import numpy as np

from app.science.rig import BoolArray, RigMotion
from app.science.rotations import FloatArray


class FitError(ValueError):
    """Markers or bodies give no skeleton; the message says what is missing and what would do."""


@dataclass(frozen=True, eq=False)
class Fitted:
    """A skeleton fitted to markers or bodies.

    Attributes:
        motion: the rig's joints are called like the body's (`app.science.skeleton.JOINT_NAMES`),
            its rest pose is the T-pose facing -z, all rotations the identity. Joints past which
            nothing is marked (toes, hands without finger markers) keep their parent's rotation.
        unfitted: body joints that could not be had; what moves them is part of their parent.
        residual_m: rms distance between the rig's joints and the joint centres of each frame,
            which bones of constant length cannot all reach.
        first_frame: the frame of the capture with which `motion` begins.
        notes: what was trimmed, bridged or left out, each a sentence.
    """

    motion: RigMotion
    unfitted: tuple[str, ...]
    residual_m: float
    first_frame: int = 0
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Part:
    """A joint as it was seen, N frames.

    Attributes:
        centre_m: (N, 3), NaN where it could not be had.
        axes: (N, 3, 3) columns are the joint's x, y, z in the world, which in the T-pose are the
            world's; None where nothing tells, and the parent's hold.
        seen: (N,) false where a marker it rests on was bridged over a gap.
    """

    centre_m: FloatArray
    axes: FloatArray | None
    seen: BoolArray

    @property
    def there(self) -> BoolArray:
        """(N,) frames in which the joint has a place, and a rotation where it needs one."""
        there: BoolArray = np.all(np.isfinite(self.centre_m), axis=-1)
        if self.axes is not None:
            there = there & np.isfinite(self.axes).all(axis=(-1, -2))
        return there


Parts = dict[str, Part]
