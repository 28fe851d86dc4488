"""The messages of the socket that shows the headset a companion: another person in its room.

The headset says whether it shows them; while it does, the server sends the newest pose as a binary
message. Nothing on this socket is acknowledged or sent again: only the newest is of use.
"""

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter

from app.wire.batch import VALUES_PER_FRAME
from app.wire.messages import Message

POSE_MAGIC = b"RLC1"


class CompanionSeen(Message):
    """The client's message on every change: whether the participant sees the companion now."""

    type: Literal["companion_seen"] = "companion_seen"
    seen: bool


class CompanionState(Message):
    """The server's message on every change: who the companion is.

    `chosen`: somebody shall be shown; if not, the other fields have no meaning. `stature_m`: of
    their body. `model`: content hash of the body's model, fetched as the avatar's own bodies are;
    null for a plain body. `in_tasks`: they are seen during tasks at the boxes, too.
    """

    type: Literal["companion_state"] = "companion_state"
    chosen: bool
    stature_m: float = 0.0
    model: str | None = None
    in_tasks: bool = False


def companion_pose(values: Sequence[float] | NDArray[np.float32]) -> bytes:
    """Return the binary message of a pose: `POSE_MAGIC`, then little-endian float32.

    Args:
        values: the place of the hips in the participant's room (m), then the rotation w, x, y, z
            of each of the 22 joints in its parent's frame: `VALUES_PER_FRAME` numbers.
    """
    pose = np.asarray(values, dtype="<f4")
    if pose.shape != (VALUES_PER_FRAME,):
        raise ValueError(f"A pose has {VALUES_PER_FRAME} values, not {pose.shape}.")
    return POSE_MAGIC + pose.tobytes()


COMPANION_SEEN: TypeAdapter[CompanionSeen] = TypeAdapter(CompanionSeen)
