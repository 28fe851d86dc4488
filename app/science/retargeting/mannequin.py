"""The stock mannequin of Unreal Engine 4, the avatar of the paper's Table 1.

Its offsets are those of the engine's reference skeleton. Bones lie along their joints' own x axis,
in the negative direction in the left leg and the right arm. The initial angles are the paper's:
roll, pitch and yaw of each joint in its parent as Unreal prints them. Table 1 depends on the
directions of bones only, not on their lengths.

Sources: the Unreal Engine 4 mannequin's reference skeleton (offsets); Degen et al. (2022), Table 1.
"""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from app.science.retargeting.coordinates import from_rotator
from app.science.rig import Rig
from app.science.rotations import Vector

_CM_PER_M = 100.0

# Joint, parent, position in the parent in cm, printed initial angles in degrees.
_JOINTS: tuple[tuple[str, str, Vector, Vector], ...] = (
    ("pelvis", "", (0.0, 0.0, 0.0), (90.00, 89.79, 90.00)),
    ("spine_01", "pelvis", (10.808878, 0.851415, 0.0), (0.00, 0.00, 7.15)),
    ("spine_02", "spine_01", (18.875349, -3.801159, 0.0), (0.00, 0.00, -14.06)),
    ("spine_03", "spine_02", (13.407329, -0.420477, 0.0), (0.00, 0.00, -2.78)),
    ("neck_01", "spine_03", (16.558783, 0.355318, 0.0), (0.00, 0.00, 23.51)),
    ("head", "neck_01", (9.283613, -0.364157, 0.0), (0.00, 0.00, -15.35)),
    ("clavicle_l", "spine_03", (11.883688, 2.732088, -3.781983), (108.72, -61.85, -101.54)),
    ("upperarm_l", "clavicle_l", (15.784872, 0.0, 0.0), (7.67, -40.30, 17.02)),
    ("lowerarm_l", "upperarm_l", (30.339930, 0.0, 0.0), (-3.61, 10.40, 30.36)),
    ("hand_l", "lowerarm_l", (26.975143, 0.0, 0.0), (-76.36, -2.50, 0.41)),
    ("clavicle_r", "spine_03", (11.883688, 2.732102, 3.782003), (108.72, -61.85, 78.46)),
    ("upperarm_r", "clavicle_r", (-15.784872, 0.0, 0.0), (7.67, -40.30, 17.02)),
    ("lowerarm_r", "upperarm_r", (-30.339930, 0.0, 0.0), (-3.61, 10.40, 30.36)),
    ("hand_r", "lowerarm_r", (-26.975143, 0.0, 0.0), (-76.36, -2.50, 0.41)),
    ("thigh_l", "pelvis", (-1.448829, 0.531424, -9.005810), (8.56, 7.03, 1.52)),
    ("calf_l", "thigh_l", (-42.572037, 0.0, 0.0), (-5.74, -1.79, 7.61)),
    ("foot_l", "calf_l", (-40.196690, 0.0, 0.0), (-0.42, -3.70, -8.06)),
    ("thigh_r", "pelvis", (-1.448829, 0.531424, 9.005810), (8.56, 7.03, -178.48)),
    ("calf_r", "thigh_r", (42.572037, 0.0, 0.0), (-5.74, -1.79, 7.61)),
    ("foot_r", "calf_r", (40.196690, 0.0, 0.0), (-0.42, -3.70, -8.06)),
    ("ball_l", "foot_l", (-10.453837, 16.577854, 0.080156), (0.00, -0.01, 91.88)),
    ("ball_r", "foot_r", (10.453837, -16.577854, 0.080156), (0.00, -0.01, 91.88)),
)
INITIAL_DEG: Mapping[str, Vector] = MappingProxyType({name: deg for name, _, _, deg in _JOINTS})
"""Roll, pitch and yaw of each joint in its parent, as printed."""
_SIDES = (("Left", "l"), ("Right", "r"))
_SIDED = (
    ("Shoulder", "clavicle"),
    ("UpperArm", "upperarm"),
    ("LowerArm", "lowerarm"),
    ("Hand", "hand"),
    ("UpperLeg", "thigh"),
    ("LowerLeg", "calf"),
    ("Foot", "foot"),
    ("Toes", "ball"),
)

MANNEQUIN_MAP: Mapping[str, str] = MappingProxyType(
    {
        "Hips": "pelvis",
        "Spine": "spine_01",
        "Chest": "spine_02",
        "UpperChest": "spine_03",
        "Neck": "neck_01",
        "Head": "head",
        **{f"{side}{ours}": f"{name}_{s}" for side, s in _SIDES for ours, name in _SIDED},
    }
)
"""Body joint -> joint of the mannequin."""


def mannequin() -> Rig:
    """Return the mannequin in its initial pose, in Unreal's axes (`axes.UNREAL`), metres."""
    names = tuple(name for name, _, _, _ in _JOINTS)
    parents = tuple(names.index(parent) if parent else -1 for _, parent, _, _ in _JOINTS)
    offsets = np.array([offset for _, _, offset, _ in _JOINTS]) / _CM_PER_M
    return Rig(names, parents, offsets, from_rotator(np.array(list(INITIAL_DEG.values()))))
