"""Prepare the arrays from which compiled code converts a body's poses to angles."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import AXES_OF, AXIS_NAMES, PARENT_OF, PART_NAMES, SIDES, Letter
from app.science.rotations import FloatArray

IndexArray = npt.NDArray[np.int64]
# Part above, hinge, letters of the axes of the hinge's bend and of the bone itself.
_BENDS: tuple[tuple[str, str, Letter, Letter], ...] = (
    ("UpperArm", "LowerArm", "Y", "X"),
    ("UpperLeg", "LowerLeg", "X", "Y"),
)


@dataclass(frozen=True, eq=False)
class TargetPlan:
    """Arrays that describe D driven parts, in the order of the body, for the compiled code.

    Attributes:
        rows: (D,) the parts' rows in `PART_NAMES`.
        folded: (D, K) rows of the part itself and of the undriven parts between it and the next
            driven part above, upwards; padded with -1.
        columns: (D,) each part's first column in `AXIS_NAMES`.
        counts: (D,) each part's number of axes.
        frames: (D, 3, 3) each part's axes as columns, completed to three so that they are
            right-handed.
        hands: (D,) 1 for a right-handed frame, -1 for a left-handed one.
        bends: (H, 2) the bone above each elbow or knee, and the part below, as indices from 0 to D
            - 1.
        bend_frames: (H, 3, 3) axes of each bend as columns: the axis of the bend, the one across,
            the bone's own.
        wrists: (W, 2) columns of the wrist's and the forearm's turn about the forearm.
    """

    rows: IndexArray
    folded: IndexArray
    columns: IndexArray
    counts: IndexArray
    frames: FloatArray
    hands: FloatArray
    bends: IndexArray
    bend_frames: FloatArray
    wrists: IndexArray


def plan_targets(parts: Collection[str], locked: Collection[str]) -> TargetPlan:
    """Return the plan for a body with these parts; `locked` names the axes that cannot turn."""
    driven = [part for part in PART_NAMES if part in parts and AXES_OF[part]]
    frames = np.array([_frame(part) for part in driven])
    bends = [
        (f"{side}{above}", f"{side}{hinge}", bend, bone)
        for side in SIDES
        for above, hinge, bend, bone in _BENDS
        if {f"{side}{above}", f"{side}{hinge}"} <= set(driven)
        # An elbow that turns about its third axis can bend in any plane.
        and (hinge == "LowerLeg" or f"{side}{hinge}Z" in locked)
    ]
    return TargetPlan(
        rows=_indices([PART_NAMES.index(part) for part in driven]),
        folded=_folded(driven),
        columns=_indices([AXIS_NAMES.index(AXES_OF[part][0].name) for part in driven]),
        counts=_indices([len(AXES_OF[part]) for part in driven]),
        frames=frames,
        hands=np.round(np.linalg.det(frames)),
        bends=_indices([(driven.index(above), driven.index(hinge)) for above, hinge, *_ in bends]),
        bend_frames=np.array(
            [_bend_frame(hinge, bend, bone) for _, hinge, bend, bone in bends]
        ).reshape(-1, 3, 3),
        wrists=_indices(
            [
                (AXIS_NAMES.index(f"{side}HandX"), AXIS_NAMES.index(f"{side}LowerArmX"))
                for side in SIDES
                if {f"{side}Hand", f"{side}LowerArm"} <= set(driven)
            ]
        ),
    )


def _indices(values: object) -> IndexArray:
    result = np.array(values, dtype=np.int64)
    return result if result.size else np.zeros((0, 2), dtype=np.int64)


def _folded(driven: list[str]) -> IndexArray:
    chains = [[part, *_undriven_above(part, frozenset(driven))] for part in driven]
    longest = max(len(chain) for chain in chains)
    return _indices(
        [
            [PART_NAMES.index(part) for part in chain] + [-1] * (longest - len(chain))
            for chain in chains
        ]
    )


def _undriven_above(part: str, driven: frozenset[str]) -> list[str]:
    """Return the undriven parts between a part and the next driven part, or the hips, above it."""
    result: list[str] = []
    above = PARENT_OF[part]
    while above is not None and above != "Hips" and above not in driven:
        result.append(above)
        above = PARENT_OF[above]
    return result


def _frame(part: str) -> FloatArray:
    columns = [np.array(axis.direction) for axis in AXES_OF[part]]
    if len(columns) == 1:
        columns.append(np.roll(columns[0], 1))
    if len(columns) == 2:
        columns.append(np.cross(columns[0], columns[1]))
    return np.stack(columns, axis=-1)


def _bend_frame(hinge: str, bend: Letter, bone: Letter) -> FloatArray:
    axes = {axis.letter: np.array(axis.direction) for axis in AXES_OF[hinge]}
    across = np.cross(axes[bone], axes[bend])
    return np.stack((axes[bend], across, axes[bone]), axis=-1)
