"""The data that a console needs to draw poses: body, boxes, and whether the reader is blinded."""

from collections.abc import Mapping
from contextlib import suppress
from typing import Literal

from pydantic import BaseModel
from sqlalchemy.orm import Session

from app.features.record.headset import Touch, headset_state, participant_info, worn_humanoid
from app.features.record.sessions import newest_calibration, plan_of, protocol_of_session
from app.models import StudySession
from app.platform.access import Caller, is_blind, session_by_id
from app.protocol import StudyProtocol
from app.science.skeleton import (
    JOINT_NAMES,
    PARENTS,
    Skeleton,
    SkeletonError,
    build_skeleton,
)
from app.science.tasks import SurfaceKind

DEFAULT_STATURE_M = 1.72
"""The stature that is drawn until the participant's is known."""
Limb = str | None
Vector = tuple[float, float, float]


class Touches(BaseModel):
    """The last few touches, oldest first, so that a console that missed some still gets them."""

    type: Literal["touches"] = "touches"
    touches: tuple[Touch, ...]


class SurfaceView(BaseModel):
    """A surface of the task: an axis-aligned block in the world frame, in metres."""

    key: str
    kind: SurfaceKind
    box: int | None
    center_m: Vector
    half_size_m: Vector


class WornBody(BaseModel):
    """The body that the avatar wears; `hash` is that of its model's file."""

    hash: str


class Setup(BaseModel):
    """The data that a console needs to draw poses; sent first, and again whenever they change.

    Joint j is at `offsets_m[j]` in its parent's frame (-1: the world); the rest pose is the T-pose
    facing -z, y up. `surfaces` are those of the current step's task. A `blinded` reader gets only
    the participant's figure and no touches, because both would reveal how far the avatar lags
    behind, and no `body`, because conditions may differ by it.
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
    body: WornBody | None = None


def setup_of(db: Session, caller: Caller, session_id: str) -> Setup:
    """Return the setup for drawing a session as `caller` may see it; raises NotFound."""
    session = session_by_id(db, session_id)
    protocol = protocol_of_session(db, session)
    state = headset_state(db, session)
    stature_m = participant_info(db, session).stature_m
    step = None if state.step_index is None else plan_of(db, session)[state.step_index]
    limb = None if step is None or step.limb is None else str(step.limb)
    blinded = is_blind(db, caller, protocol, session)
    named = None if step is None else step.body
    humanoid = None if blinded else worn_humanoid(db, session, named)
    return Setup(
        blinded=blinded,
        simulated=session.kind == "simulated",
        recording=state.recording,
        limb=limb,
        stature_m=stature_m or DEFAULT_STATURE_M,
        stature_known=stature_m is not None,
        joints=JOINT_NAMES,
        parents=PARENTS,
        offsets_m=_offsets_m(stature_m or DEFAULT_STATURE_M, _measured_m(db, session)),
        surfaces=_surfaces(protocol, limb),
        body=None if humanoid is None else WornBody(hash=humanoid),
    )


def _measured_m(db: Session, session: StudySession) -> Mapping[str, float]:
    """Return the measured lengths of a plain body; a body with a model keeps its own proportions.

    The configuration decides, not the condition: what a blinded reader sees must not tell which
    body is worn.
    """
    calibration = newest_calibration(db, session)
    if calibration is None or worn_humanoid(db, session, None) is not None:
        return {}
    measured: Mapping[str, float] = calibration.report.get("segments_m", {})
    return measured


def _offsets_m(stature_m: float, segments_m: Mapping[str, float]) -> tuple[Vector, ...]:
    offsets_m = _skeleton(stature_m, segments_m).offsets_m
    return tuple((float(x), float(y), float(z)) for x, y, z in offsets_m)


def _skeleton(stature_m: float, segments_m: Mapping[str, float]) -> Skeleton:
    """Return the skeleton that is drawn, without what no skeleton has: arms first, then stature."""
    for measured_m in (segments_m, {}):
        with suppress(SkeletonError):
            return build_skeleton(stature_m, measured_m)
    return build_skeleton(DEFAULT_STATURE_M)


def _surfaces(protocol: StudyProtocol, limb: Limb) -> tuple[SurfaceView, ...]:
    if limb is None:
        return ()
    return tuple(
        SurfaceView(
            key=one.key,
            kind=one.kind,
            box=one.box,
            center_m=one.center_m,
            half_size_m=one.half_size_m,
        )
        for one in protocol.tasks.layout(limb).surfaces
    )
