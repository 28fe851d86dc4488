"""Doubt walks whose speeds or steps nobody has: they are often in another unit than was said.

A table in feet that is read as metres gives walks that are 3.28 times as long, and as fast. Nothing
in a single number contradicts that: people do walk 2 m/s when they hurry. As a rule of all walks of
a table it is not plausible, since people who are not told otherwise walk at 1.2 to 1.5 m/s, and
take up to a second longer than that because they start and stop.

The rules are wide, since a doubt is about a unit and not about a person: slow patients and fast
walkers pass. Preferred speeds and steps: Bohannon and Andrews 2011 (means of .94 to 1.43 m/s by age
and sex); steps of .4 to .9 m are the usual range of such studies.
"""

from collections.abc import Sequence

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.recording.segmentation import smoothed
from app.science.walking.records import Track, Walk

USUAL_M_S, STARTING_S = 1.35, 0.9
"""Speed of usual walks, and the time that starting and stopping add to a walk."""
LEAST_PACE, MOST_PACE = 0.3, 1.65
"""Median time of a usual walk over the time taken: below and above, the unit or rate is doubted."""
LEAST_STEP_M, MOST_STEP_M = 0.2, 1.1
"""Median length of a step outside of which the unit is doubted."""
_LEAST_S = 3.0
_STRIDES_HZ = (0.5, 1.5)
_SWAY_S = 0.6
_CLEAR = 0.5


def doubts_about(walks: Sequence[Walk]) -> list[str]:
    """Return what cannot be true of the walks of one table as a rule, as sentences.

    Args:
        walks: the walks of one file.
    """
    if not walks:
        return []
    found = []
    lengths_m = np.array([walk.length_m for walk in walks])
    durations_s = np.array([walk.duration_s for walk in walks])
    resting = np.array([(walk.begins_still + walk.ends_still) / 2.0 for walk in walks])
    pace = float(np.median((lengths_m / USUAL_M_S + STARTING_S * resting) / durations_s))
    if not LEAST_PACE <= pace <= MOST_PACE:
        speed_m_s = float(np.median(lengths_m / durations_s))
        found.append(
            f"Half of the walks go {speed_m_s:.2f} m/s or {'more' if pace > 1.0 else 'less'}, which"
            f" is {pace:.1f} times as fast as people usually walk such distances"
        )
    steps_m = [step for walk in walks if (step := step_length_m(walk)) is not None]
    if steps_m and not LEAST_STEP_M <= (typical_m := float(np.median(steps_m))) <= MOST_STEP_M:
        found.append(
            f"Their steps are {typical_m:.2f} m long in the median, where people take steps of .4"
            " to .9 m"
        )
    return found


def extent_of(tracks: Sequence[Track]) -> str:
    """Say how far tracks without a walk reach, and how long: what somebody stood still in.

    Args:
        tracks: one or more tracks; their widest extent along an axis, and their longest time.
    """
    widest_m = max(float(np.ptp(track.xy_m, axis=0).max()) for track in tracks)
    longest_s = max(float(track.times_s[-1] - track.times_s[0]) for track in tracks)
    return f"within {widest_m:.3g} m for up to {longest_s:.3g} s"


def step_length_m(walk: Walk) -> float | None:
    """Estimate the length of a step from the sway from side to side, whose period is a stride.

    A step is half of a stride. None for walks under three seconds, and where no frequency of a
    stride stands out.
    """
    if walk.duration_s < _LEAST_S:
        return None
    rate_hz = (len(walk.times_s) - 1) / walk.duration_s
    line = smoothed(walk.xy_m, rate_hz, _SWAY_S)
    ahead = np.gradient(line, axis=0)
    ahead /= np.maximum(np.linalg.norm(ahead, axis=1, keepdims=True), 1e-9)
    off = walk.xy_m - line
    aside: FloatArray = off[:, 1] * ahead[:, 0] - off[:, 0] * ahead[:, 1]
    power = np.abs(np.fft.rfft(aside * np.hanning(len(aside)), 8 * len(aside))) ** 2
    hz = np.fft.rfftfreq(8 * len(aside), 1.0 / rate_hz)
    low, high = _STRIDES_HZ
    within = (hz >= low) & (hz <= high)
    at = int(np.argmax(np.where(within, power, 0.0)))
    near = within & (np.abs(hz - hz[at]) <= 1.5 / walk.duration_s)
    if power[near].sum() < _CLEAR * power[hz >= low].sum() or power[at] <= 0.0:
        return None
    return walk.length_m / walk.duration_s / float(hz[at]) / 2.0
