"""Where feet are held while they stand, and how they come there and leave.

During a contact the sole of a foot stays at one place, the mean of where it would slide along, at
the height of the ground there. The correction that takes it there is c(t). Between two contacts c
goes from the end of one to the start of the next along 3u^2 - 2u^3; on either side of a contact its
slope runs out smoothly, so that the foot has one speed at the edge. Before the first contact and
after the last c stays.
"""

from itertools import pairwise

import numpy as np

from app.science.retargeting.contacts import Contacts
from app.science.retargeting.ground import Ground
from app.science.retargeting.legs import Leg, Legs
from app.science.rig import BoolArray
from app.science.rotations import FloatArray


def held_shifts(
    positions_m: FloatArray,
    world: FloatArray,
    legs: Legs,
    contacts: Contacts,
    ground: Ground,
    settling_s: float,
) -> FloatArray:
    """By how much each foot is moved, (2, N, 3); zero where no foot ever touches the ground.

    Args:
        positions_m, world: joints (N, J, 3) and world_from_joint (N, J, 4) of the avatar.
        legs: which joints its legs are.
        contacts: when the feet are held.
        ground: under the avatar.
        settling_s: how long a foot takes to take up its own speed again beside a contact.
    """
    settle = max(1, round(settling_s * contacts.rate_hz))
    shifts = np.zeros((2, len(positions_m), 3))
    for foot, leg in enumerate(legs.both):
        intervals = contacts.intervals(foot)
        if intervals:
            sole = _sole_m(leg, positions_m, world, contacts.down[:, foot])
            shifts[foot] = _corrections(sole, intervals, ground, settle)
    for foot in (0, 1):
        if not contacts.down[:, foot].any():
            shifts[foot, :, 1] = shifts[1 - foot, :, 1]
    return shifts


def _sole_m(leg: Leg, positions_m: FloatArray, world: FloatArray, down: BoolArray) -> FloatArray:
    """Where a foot touches the ground, (N, 3): below its ball, as low as its ball or heel is.

    Both lie above the lowest point of the foot by what is usual in contact. The lowest point
    itself would do, but it is often a toe, and captures hardly measure how toes turn.
    """
    ball, ankle = leg.ball_m(positions_m, world), positions_m[:, leg.foot]
    lowest = leg.lowest_m(positions_m, world)
    heights = [y - np.median((y - lowest)[down]) for y in (ball[:, 1], ankle[:, 1])]
    return np.stack((ball[:, 0], np.minimum(*heights), ball[:, 2]), axis=1)


def _corrections(
    sole_m: FloatArray, intervals: list[tuple[int, int]], ground: Ground, settle: int
) -> FloatArray:
    """(N, 3) from where a sole is to where it is held, smooth in between."""
    count = len(sole_m)
    shift = np.zeros_like(sole_m)
    for first, last in intervals:
        inside = slice(first, last + 1)
        x, _, z = sole_m[inside].mean(axis=0)
        shift[inside] = np.array((x, float(ground.height_m(x, z)), z)) - sole_m[inside]
    for (_, last), (first, _) in pairwise(intervals):
        u = (np.arange(last + 1, first) - last)[:, np.newaxis] / (first - last)
        way = shift[first] - shift[last]
        shift[last + 1 : first] = shift[last] + u * u * (3.0 - 2.0 * u) * way
    if intervals:
        shift[: intervals[0][0]] = shift[intervals[0][0]]
        shift[intervals[-1][1] + 1 :] = shift[intervals[-1][1]]
    bounds = [-1, *(f for pair in intervals for f in pair), count]
    for number, (first, last) in enumerate(intervals):
        before, after = bounds[2 * number], bounds[2 * number + 3]
        _settle(shift[before + 1 : first][::-1], shift[first] - shift[min(first + 1, last)], settle)
        _settle(shift[last + 1 : after], shift[last] - shift[max(last - 1, first)], settle)
    return shift


def _settle(shift: FloatArray, slope: FloatArray, settle: int) -> None:
    """Go on with a contact's slope (a frame) beyond its edge and let it run out, in place."""
    span = min(settle, len(shift) + 1)
    k = np.arange(1, span)[:, np.newaxis]
    shift[: span - 1] += slope * k * (1.0 - k / span) ** 2
