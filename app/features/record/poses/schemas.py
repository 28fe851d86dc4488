"""What a console is told in JSON beside the poses."""

from typing import Literal

from pydantic import BaseModel

from app.features.record.headset import Touch
from app.science.tasks.names import SurfaceKind

Vector = tuple[float, float, float]


class Touches(BaseModel):
    """The last few touches, the oldest first: who has missed some finds them here again."""

    type: Literal["touches"] = "touches"
    touches: tuple[Touch, ...]


class SurfaceView(BaseModel):
    """A block of the task's place: world frame, metres."""

    key: str
    kind: SurfaceKind
    box: int | None
    center_m: Vector
    half_size_m: Vector


class Setup(BaseModel):
    """What poses are drawn with; told first, and again whenever it has changed.

    Joint j stands at `offsets_m[j]` in its parent's frame (-1: the world); the rest pose is the
    T-pose facing -z, y up. `surfaces` are those of the present step's task. Who is `blinded` gets
    the participant's figure only, and no touches: both would tell by how much the avatar lags.
    """

    type: Literal["setup"] = "setup"
    blinded: bool
    simulated: bool
    recording: bool
    limb: Literal["hand", "foot"] | None
    stature_m: float
    stature_known: bool
    joints: tuple[str, ...]
    parents: tuple[int, ...]
    offsets_m: tuple[Vector, ...]
    surfaces: tuple[SurfaceView, ...]
