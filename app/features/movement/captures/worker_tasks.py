"""The tasks of the worker process for captures: previews, verifications and retargeted files.

Everything that a task needs is in its arguments, which are hashable: the same call returns the same
bytes. The verification of a walk is JSON, thinned for drawing.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from app.adapters.captures import writer_of
from app.features.movement.captures.opening import (
    Mapped,
    Store,
    on_avatar,
    open_stored,
    rig_on_avatar,
)
from app.features.movement.captures.preview import encode, points_of, skeleton_points, step_for
from app.features.movement.captures.schemas import (
    AvatarWalkerView,
    ExportFormat,
    LegAnglesView,
    Shown,
    ToePathView,
    VerificationView,
    WalkerView,
    WalkStrideView,
)
from app.features.movement.captures.source import Cannot, Source
from app.science.retargeting import (
    REFERENCE_JOINT_MAP,
    AvatarFigures,
    JointMap,
    LegAngles,
    Retargeted,
    Verification,
    Walk,
    example_walk,
    named_stature_m,
    verify,
)
from app.science.rig import RigError, RigMotion
from app.science.rotations import FloatArray

MAX_DRAWN_POINTS = 3000
"""Maximum number of points of a line; a screen shows fewer."""
_METRE_DIGITS, _DEGREE_DIGITS = 5, 3
"""Rounding to 0.01 mm and 0.001 degrees, which is far finer than a line can show."""


def verification_json(mapped: Mapped, avatars: tuple[str, ...], *, lock_feet: bool) -> bytes:
    """Return the verification on avatars such as "165cm", as a `VerificationView`; raise Cannot."""
    moved = {name: on_avatar(mapped, name, lock_feet=lock_feet) for name in avatars}
    return _verified(mapped.moving, dict(mapped.joint_map), moved, lock_feet=lock_feet)


def generated_verification_json(avatars: tuple[str, ...], *, lock_feet: bool) -> bytes:
    """Return the same of the generated walk, which needs no capture; raise Cannot."""
    source = example_walk()
    moved = {
        name: rig_on_avatar(source, REFERENCE_JOINT_MAP, name, lock_feet=lock_feet)
        for name in avatars
    }
    return _verified(source, REFERENCE_JOINT_MAP, moved, lock_feet=lock_feet)


def _verified(
    source: RigMotion, joint_map: JointMap, moved: Mapping[str, Retargeted], *, lock_feet: bool
) -> bytes:
    try:
        found = verify(
            source,
            joint_map,
            [(name, one.motion, REFERENCE_JOINT_MAP) for name, one in moved.items()],
        )
    except RigError as error:
        raise Cannot(str(error)) from None
    step = step_for(source.frame_count, source.rate_hz, 1, MAX_DRAWN_POINTS)
    view = VerificationView(
        frames=source.frame_count,
        rate_hz=source.rate_hz,
        lock_feet=lock_feet,
        times_s=_thinned(np.arange(source.frame_count) / source.rate_hz, step),
        leg_angles=[_angles(one, step) for one in found.source.angles],
        source=_walker("source", found.source.walk, step),
        avatars=[_avatar(one, moved[one.name], found, step) for one in found.avatars],
        lifts_agree=found.lifts_agree,
        largest_timing_difference_s=found.largest_timing_difference_s,
        unmapped_body_joints=[name for name in REFERENCE_JOINT_MAP if name not in joint_map],
    )
    return view.model_dump_json().encode()


def _walker(name: str, walk: Walk, step: int) -> WalkerView:
    return WalkerView(
        name=name,
        leg_length_m=walk.leg_length_m,
        thigh_share=walk.thigh_share,
        toe_paths=[
            ToePathView(
                side=foot.side,
                forward_m=_thinned(foot.forward_m, step),
                height_m=_thinned(foot.height_m, step),
                start_height_m=foot.start_height_m,
            )
            for foot in walk.feet
        ],
        strides=[
            WalkStrideView(
                side=one.side,
                lift_s=one.lift_s,
                contact_s=one.contact_s,
                length_m=one.length_m,
                height_m=one.height_m,
                contact_height_m=one.contact_height_m,
            )
            for one in walk.strides
        ],
        mean_stride_length_m=walk.mean_stride_length_m,
        mean_step_length_m=walk.mean_step_length_m,
        mean_step_height_m=walk.mean_step_height_m,
        foot_slide_m_s=walk.slide_m_s,
    )


def _avatar(
    figures: AvatarFigures, moved: Retargeted, found: Verification, step: int
) -> AvatarWalkerView:
    walks = moved.walks
    locked = None if walks is None else walks.locked
    before = None if walks is None or locked is None else walks.slide_before_m_s
    length_ratio = height_ratio = None
    if walks is not None:
        # Over the same spans of time, so that corresponding strides are compared.
        avatar, source = walks.avatar, walks.source
        length_ratio = _ratio(avatar.mean_stride_length_m, source.mean_stride_length_m)
        height_ratio = _ratio(avatar.mean_step_height_m, source.mean_step_height_m)
    return AvatarWalkerView(
        **_walker(figures.name, figures.walk, step).model_dump(),
        stature_m=named_stature_m(figures.name) or 0.0,
        leg_ratio=figures.leg_ratio,
        length_ratio=length_ratio,
        height_ratio=height_ratio,
        lifts_agree=_lifts(figures.walk) == _lifts(found.source.walk),
        slide_m_s=figures.slide_m_s,
        slide_before_m_s=before,
        lowered_m=None if locked is None else locked.lowered_m,
        out_of_reach=None if locked is None else locked.out_of_reach,
        floor=moved.floor,
        notices=list(moved.notices),
    )


def _lifts(walk: Walk) -> tuple[int, int]:
    sides = [one.side for one in walk.strides]
    return sides.count("left"), sides.count("right")


def _ratio(avatar_m: float | None, source_m: float | None) -> float | None:
    return avatar_m / source_m if avatar_m is not None and source_m else None


def _angles(angles: LegAngles, step: int) -> LegAnglesView:
    return LegAnglesView(
        side=angles.side,
        hip_deg=_degrees(angles.hip_rad, step),
        knee_deg=_degrees(angles.knee_rad, step),
        ankle_deg=_degrees(angles.ankle_rad, step),
    )


def _degrees(values_rad: FloatArray, step: int) -> list[float]:
    return _thinned(np.degrees(values_rad), step, _DEGREE_DIGITS)


def _thinned(values: FloatArray, step: int, digits: int = _METRE_DIGITS) -> list[float]:
    return [float(value) for value in np.round(values[::step], digits)]


def recorded_positions(store: Store, source: Source, shown: Shown) -> bytes:
    """Return positions for a preview, as recorded or of the skeleton; raise Cannot."""
    opened = open_stored(store, source)
    if shown == "recorded":
        return encode(points_of(opened.capture.motion))
    return encode(skeleton_points(opened.moving, start_s=opened.start_s))


def retargeted_positions(
    mapped: Mapped, avatar: str, *, lock_feet: bool, rotations: bool = False
) -> bytes:
    """Return positions, and rotations if asked, of an avatar's joints for a preview.

    Raises Cannot.
    """
    motion = on_avatar(mapped, avatar, lock_feet=lock_feet).motion
    points = skeleton_points(motion)
    return encode(replace(points, rotations=motion.rotations) if rotations else points)


def write_retargeted(
    mapped: Mapped, avatar: str, format_: ExportFormat, to: Path, *, lock_feet: bool
) -> None:
    """Write the movement on an avatar to a file in this format; raise Cannot."""
    motion = on_avatar(mapped, avatar, lock_feet=lock_feet).motion
    with to.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(writer_of(format_).write(motion))
