"""Constrain the lengths of a fitted skeleton by the proportions of people.

Markers fix a segment only as well as they mark its ends: a marker on the wrong place of an arm
makes one segment too long and the next too short, and no residual shows it, since a bone of any
constant length fits. The stature follows from the segments (`anatomy.stature_from`). Then, for
thigh, shank, upper arm and forearm,

- sides that differ by more than people's do both get the length that is nearer to the proportion;
- a length outside 0.7 to 1.3 times its proportion is replaced by the proportion;
- one outside 0.4 to 2 times its proportion is refused: its markers are not where their labels say.

Rotations stay as they are; joints further out move with the new lengths.
"""

from dataclasses import replace

import numpy as np

from app.science.anatomy import (
    PAIRED,
    PUBLISHED,
    Notice,
    plausible_m,
    segment_lengths,
    sides_agree,
    stature_from,
)
from app.science.fitting.model import FitError
from app.science.rig import Rig, RigMotion

_SHORTEST, _LONGEST = 0.4, 2.0


def constrained(motion: RigMotion) -> tuple[RigMotion, tuple[Notice, ...]]:
    """Return the movement with lengths that people have, and what was changed.

    Raises:
        FitError: a length is so far from people's that the markers must be wrong.
    """
    places, _ = motion.rig.rest_world()
    lengths = segment_lengths(dict(zip(motion.rig.names, places, strict=True)))
    stature = stature_from(lengths)
    if stature is None:
        return motion, ()
    notices: list[Notice] = []
    wanted: dict[str, float] = {}
    for segment, (_, lower) in PAIRED.items():
        found = {
            side: lengths[f"{side.lower()} {segment}"]
            for side in ("Left", "Right")
            if f"{side.lower()} {segment}" in lengths
        }
        chosen, notice = _chosen(segment, found, stature)
        if notice is not None:
            notices.append(notice)
            wanted |= {f"{side}{lower}": length for side, length in chosen.items()}
    return (_with_lengths(motion, wanted) if wanted else motion), tuple(notices)


def _chosen(
    segment: str, found: dict[str, float], stature_m: float
) -> tuple[dict[str, float], Notice | None]:
    """Return the length of each side, and a notice if it differs from the one found."""
    expected = PUBLISHED[segment] * stature_m
    low, high = plausible_m(segment, stature_m)
    sides = (f"{100.0 * length:.1f} cm {side.lower()}" for side, length in found.items())
    told = f"{segment} {', '.join(sides)}"
    valid = f"{100.0 * low:.0f} to {100.0 * high:.0f} cm for a stature of {stature_m:.2f} m"
    for side, length in found.items():
        if not _SHORTEST * expected <= length <= _LONGEST * expected:
            raise FitError(
                _refusal(
                    segment, side, told, valid, "markers at its ends are not where they belong"
                )
            )
    best = min(found.values(), key=lambda length: abs(length - expected), default=expected)
    if len(found) == 2 and not sides_agree(*found.values()):
        length = best if low <= best <= high else expected
        what = f"The {segment}s differ by more than people's do: both were made {_cm(length)} long."
        notice = Notice("sides", "mended", what, told, valid, _REMEDY)
        return dict.fromkeys(found, length), notice
    if all(low <= length <= high for length in found.values()):
        return found, None
    what = f"The {segment} does not fit the other segments: it was made {_cm(expected)} long."
    return dict.fromkeys(found, expected), Notice("length", "mended", what, told, valid, _REMEDY)


_REMEDY = "Check where the markers at the ends of this segment were placed."


def _refusal(segment: str, side: str, told: str, valid: str, why: str) -> str:
    notice = Notice(
        "length",
        "refused",
        f"No skeleton can be fitted: the {side.lower()} {segment} is no person's, so {why}.",
        told,
        valid,
        "Check the labels of these markers, the unit, and export again.",
    )
    return notice.sentence


def _with_lengths(motion: RigMotion, lengths_m: dict[str, float]) -> RigMotion:
    """Return the movement with other lengths of the bones that end at these joints."""
    offsets = motion.rig.offsets_m.copy()
    for joint, length in lengths_m.items():
        row = motion.rig.index(joint)
        offsets[row] *= length / float(np.linalg.norm(offsets[row]))
    rig: Rig = replace(motion.rig, offsets_m=offsets)
    return replace(motion, rig=rig)


def _cm(metres: float) -> str:
    return f"{100.0 * metres:.1f} cm"
