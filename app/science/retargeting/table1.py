"""Reproduce the paper's Table 1: the T-pose of the Unreal mannequin, joint by joint.

The T-pose is computed from the printed initial angles with `t_pose`, and the resulting angles are
compared with the printed ones. The table prints hundredths of a degree and its input is rounded to
those too, so agreement within 0.01 degrees is all it can show.

One row does not agree: for the pelvis 84.87 is printed where 85.50 is computed. The rows below it
agree with 85.50, since their angles follow from it. The row is flagged as an inconsistency of the
source; nothing is tuned to it.

Source: Degen et al. (2022), "Methodical approach to integrate human movement diversity ...", J.
Transportation Technologies 12:296-309, Table 1.
"""

from dataclasses import dataclass

import numpy as np

from app.science.retargeting.axes import UNREAL
from app.science.retargeting.coordinates import from_rotator, to_rotator
from app.science.retargeting.mannequin import INITIAL_DEG, MANNEQUIN_MAP, mannequin
from app.science.retargeting.t_pose import UNREAL_LOCAL_AXES, t_pose
from app.science.rotations import FloatArray, Vector, geodesic_angle

TOLERANCE_DEG = 0.01
_PRINTED: dict[str, Vector] = {
    "pelvis": (-90.00, 84.87, -90.00),
    "spine_01": (0.00, 0.00, 15.89),
    "spine_02": (0.00, 0.00, -9.59),
    "spine_03": (0.00, 0.00, -3.03),
    "neck_01": (0.00, 0.00, 3.48),
    "head": (0.00, 0.00, -2.25),
    "clavicle_l": (108.72, -61.85, -101.54),
    "upperarm_l": (4.72, 8.71, 26.87),
    "lowerarm_l": (-6.44, 0.00, 0.00),
    "hand_l": (-76.35, 0.00, 0.00),
    "clavicle_r": (108.72, -61.85, 78.46),
    "upperarm_r": (4.72, 8.71, 26.87),
    "lowerarm_r": (-6.44, 0.00, 0.00),
    "hand_r": (-76.35, 0.00, 0.00),
    "thigh_l": (8.75, 0.00, 4.50),
    "calf_l": (-5.62, 0.00, 0.00),
    "foot_l": (-0.51, 0.89, 0.69),
    "thigh_r": (8.75, 0.00, -175.50),
    "calf_r": (-5.62, 0.00, 0.00),
    "foot_r": (-0.51, 0.89, 0.69),
    "ball_l": (0.00, -0.01, 91.88),
    "ball_r": (0.00, -0.01, 91.88),
}
_INCONSISTENT = frozenset({"pelvis"})


@dataclass(frozen=True)
class Table1Row:
    """One joint of the table; angles are Unreal's roll, pitch and yaw in the parent, degrees.

    Attributes:
        joint: name of the joint in the mannequin.
        initial, printed, computed: the initial pose, the T-pose as printed, as computed here.
        difference_deg: angle of the rotation from the printed to the computed one. It is the
            measure of agreement, as three angles can differ by much where rotations hardly differ.
        largest_angle_difference_deg: the largest difference of roll, pitch and yaw individually.
        inconsistent_in_source: whether the row contradicts the rest of the printed table.
    """

    joint: str
    initial: Vector
    printed: Vector
    computed: Vector
    difference_deg: float
    largest_angle_difference_deg: float
    inconsistent_in_source: bool

    @property
    def agrees(self) -> bool:
        """Whether printed and computed rotation agree within the rounding, `TOLERANCE_DEG`."""
        return self.difference_deg <= TOLERANCE_DEG


def check_table1() -> tuple[Table1Row, ...]:
    """Compute the rows of the table and compare them with the printed ones, in their order."""
    rig = mannequin()
    pose = t_pose(rig, MANNEQUIN_MAP, UNREAL, local_axes=UNREAL_LOCAL_AXES)
    printed = np.array([_PRINTED[name] for name in rig.names])
    computed = to_rotator(pose.local_rotations)
    turn_deg = np.degrees(geodesic_angle(from_rotator(printed), pose.local_rotations))
    return tuple(
        Table1Row(
            joint=name,
            initial=INITIAL_DEG[name],
            printed=_PRINTED[name],
            computed=_vector(computed[row]),
            difference_deg=float(turn_deg[row]),
            largest_angle_difference_deg=float(np.max(np.abs(computed[row] - printed[row]))),
            inconsistent_in_source=name in _INCONSISTENT,
        )
        for row, name in enumerate(rig.names)
    )


def _vector(angles: FloatArray) -> Vector:
    roll, pitch, yaw = angles.tolist()
    return roll, pitch, yaw
