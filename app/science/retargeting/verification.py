"""The paper's verification: one person's walk on avatars of several sizes.

The same movement is retargeted to each avatar, and its character must be preserved: as many lifts
of each foot, at the same times, longer and higher steps for longer legs, and no foot slide. Each
avatar's lifts are detected from its own movement, so that disagreement is possible.

The paper's own numbers (130, 165, 190 cm: 110, 150, 165 cm forward; 16, 20, 22 cm up) come from
avatars and a person whose leg lengths are not published. One scale per avatar fits both within 5 cm
and 0.5 cm, so the results can be checked for consistency, but not for equality.

Source: Degen et al. (2022), section 4, figures 8 and 9.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from app.science.retargeting.gait import Walk, walk_figures
from app.science.retargeting.ground import Flat, Ground
from app.science.retargeting.joint_map import JointMap
from app.science.retargeting.leg_angles import LegAngles, leg_angles
from app.science.retargeting.legs import SIDES, Side, legs_of
from app.science.rig import RigError, RigMotion

_FLAT = Flat()


@dataclass(frozen=True, eq=False)
class LegFigures:
    """Measures of the source: leg angles over time (the paper's figure 8) and its walk."""

    angles: tuple[LegAngles, LegAngles]
    walk: Walk


@dataclass(frozen=True, eq=False)
class AvatarFigures:
    """Measures of one avatar's walk, to compare with the source's.

    Attributes:
        name: the name as it was given.
        leg_ratio: the avatar's leg length over the source's.
        walk: lifts, steps and slide from its own contacts.
        slide_m_s: mean horizontal speed of its feet while the *source's* are down, the measure by
            which retargeting and foot locking are judged; None without contact.
    """

    name: str
    leg_ratio: float
    walk: Walk
    slide_m_s: float | None


@dataclass(frozen=True, eq=False)
class Verification:
    """Result of checking whether a walk keeps its character on every avatar.

    Attributes:
        source: the figures of the captured person.
        avatars: the figures of the avatars, in the given order.
        lifts_agree: every avatar lifts each foot as often as the source.
        largest_timing_difference_s: between the same lift, or the following contact, of any two of
            the bodies; None where the numbers of lifts disagree, 0 where there is no lift.
    """

    source: LegFigures
    avatars: tuple[AvatarFigures, ...]
    lifts_agree: bool
    largest_timing_difference_s: float | None


def verify(
    source: RigMotion,
    source_map: JointMap,
    avatars: Sequence[tuple[str, RigMotion, JointMap]],
    ground: Ground = _FLAT,
) -> Verification:
    """Compare a captured walk with the same walk on each avatar.

    Args:
        source: the captured movement.
        source_map: the joint map of the capture.
        avatars: (name, movement after the transfer, joint map) for each.
        ground: the ground under the avatars; the source's is flat.

    Raises:
        RigError: legs are not mapped, or an avatar has a different number of frames than the
            source.
    """
    walk = walk_figures(source, legs_of(source.rig, source_map))
    figures = []
    for name, motion, joint_map in avatars:
        if motion.frame_count != source.frame_count:
            raise RigError(
                f"{name} has {motion.frame_count} frames, but its source has {source.frame_count}."
            )
        legs = legs_of(motion.rig, joint_map)
        same = walk_figures(motion, legs, ground, contacts=walk.contacts)
        own = walk_figures(motion, legs, ground)
        ratio = legs.length_m / walk.leg_length_m
        figures.append(AvatarFigures(name, ratio, own, same.slide_m_s))
    difference = _timing_difference_s([walk, *(figure.walk for figure in figures)])
    return Verification(
        source=LegFigures(leg_angles(source, source_map), walk),
        avatars=tuple(figures),
        lifts_agree=difference is not None,
        largest_timing_difference_s=difference,
    )


def lift_times_s(walk: Walk, side: Side) -> tuple[tuple[float, float], ...]:
    """Return the lift and contact time of each whole lift of a foot."""
    return tuple((one.lift_s, one.contact_s) for one in walk.strides if one.side == side)


def _timing_difference_s(walks: list[Walk]) -> float | None:
    largest = 0.0
    for side in SIDES:
        times = [lift_times_s(walk, side) for walk in walks]
        if len({len(of_one) for of_one in times}) > 1:
            return None
        for same_lift in zip(*times, strict=True):
            for same_event in zip(*same_lift, strict=True):
                largest = max(largest, max(same_event) - min(same_event))
    return largest
