"""Compute where feet are held during contacts, and the smooth transition before and after.

During a contact the sole of a foot stays at one place: the mean of the positions along which it
would slide, at the height of the ground there. The correction that moves the sole there is c(t).
Between two contacts c goes from the end of one to the start of the next along 3u^2 - 2u^3; on
either side of a contact the slope of c decays smoothly, so that the foot's speed is continuous at
the edge. Before the first contact and after the last c is constant.
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
    """Return the shift of each foot, (2, N, 3); zero if no foot ever touches the ground.

    Args:
        positions_m, world: joints (N, J, 3) and world_from_joint (N, J, 4) of the avatar.
        legs: the joints of the avatar's legs.
        contacts: the times at which the feet are held.
        ground: the ground under the avatar.
        settling_s: time in which a foot returns to its own speed before and after a contact.
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
    """Return where a foot touches the ground, (N, 3): below its ball, at the height of the sole.

    That height is the lower of ball and heel, each minus its median height above the foot's lowest
    point during contact. The lowest point itself could be used, but it is often a toe, and captures
    hardly measure how toes turn.
    """
    ball, ankle = leg.ball_m(positions_m, world), positions_m[:, leg.foot]
    lowest = leg.lowest_m(positions_m, world)
    heights = [y - np.median((y - lowest)[down]) for y in (ball[:, 1], ankle[:, 1])]
    return np.stack((ball[:, 0], np.minimum(*heights), ball[:, 2]), axis=1)


def _corrections(
    sole_m: FloatArray, intervals: list[tuple[int, int]], ground: Ground, settle: int
) -> FloatArray:
    """Return the shifts (N, 3) from a sole's position to where it is held, smooth in between."""
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
    """Continue a contact's slope (per frame) beyond its edge and let it decay, in place."""
    span = min(settle, len(shift) + 1)
    k = np.arange(1, span)[:, np.newaxis]
    shift[: span - 1] += slope * k * (1.0 - k / span) ** 2
