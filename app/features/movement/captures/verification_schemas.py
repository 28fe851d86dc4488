"""The paper's verification as it travels to a page: one movement on avatars of several statures.

Degen et al. (2022) show that a walk keeps its characteristics whatever the avatar's dimensions:
the toe's path over the ground, its lifts, and steps that grow with the legs. Series are thinned for
drawing and share `times_s`.
"""

from typing import Literal

from pydantic import BaseModel

Side = Literal["left", "right"]


class LegAnglesView(BaseModel):
    """Angles of one leg in degrees over time; figure 8 of the paper.

    Forward and bent are positive; 0 is a straight hip, a straight knee, an ankle at right angles.
    """

    side: Side
    hip_deg: list[float]
    knee_deg: list[float]
    ankle_deg: list[float]


class ToePathView(BaseModel):
    """The way of one foot's ball (the toe joint) in metres; figure 9 of the paper.

    `forward_m` is along the walk, `height_m` above the ground; `start_height_m` in the first frame.
    """

    side: Side
    forward_m: list[float]
    height_m: list[float]
    start_height_m: float


class WalkStepView(BaseModel):
    """One lift of a foot, from leaving the ground to the next contact.

    `length_m` is the ball's way forward, `height_m` from its lowest to its highest place,
    `contact_height_m` above the ground as it comes down.
    """

    side: Side
    lift_s: float
    contact_s: float
    length_m: float
    height_m: float
    contact_height_m: float


class WalkerView(BaseModel):
    """How one body, the source or an avatar, does the movement.

    `leg_length_m` is thigh plus shin, `thigh_share` the thigh's part of it. Means are null without
    a whole step. `foot_slide_m_s` is the mean speed of its feet over the ground while they are
    down, null where none is.
    """

    name: str
    leg_length_m: float
    thigh_share: float
    toe_paths: list[ToePathView]
    steps: list[WalkStepView]
    mean_step_length_m: float | None
    mean_step_height_m: float | None
    foot_slide_m_s: float | None


class AvatarWalkerView(WalkerView):
    """How an avatar does it, beside the source.

    `leg_ratio` is its leg length over the source's, `length_ratio` and `height_ratio` the same of
    mean steps (null without steps). `lifts_agree`: it lifts each foot as often as the source.
    Slides are speeds of its feet while the *source's* are down: `slide_m_s` as shown here,
    `slide_before_m_s` before the feet were locked, null where they are not. With locked feet
    `lowered_m` is by how much the hips came down at most, and `out_of_reach` counts frames in which
    a foot could not be held.
    """

    stature_m: float
    leg_ratio: float
    length_ratio: float | None
    height_ratio: float | None
    lifts_agree: bool
    slide_m_s: float | None
    slide_before_m_s: float | None
    lowered_m: float | None
    out_of_reach: int | None


class VerificationView(BaseModel):
    """The source and every avatar.

    `lifts_agree`: every avatar lifts each foot as often as the source.
    `largest_timing_difference_s`: between the same lift or contact of any two bodies; null where
    they do not agree. `unmapped_body_joints` keep their T-pose on every avatar.
    """

    frames: int
    rate_hz: float
    lock_feet: bool
    times_s: list[float]
    leg_angles: list[LegAnglesView]
    source: WalkerView
    avatars: list[AvatarWalkerView]
    lifts_agree: bool
    largest_timing_difference_s: float | None
    unmapped_body_joints: list[str]
