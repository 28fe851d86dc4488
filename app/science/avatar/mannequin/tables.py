"""The forms of men and women, as sections through trunk, head, limbs and feet.

All lengths are in millimetres for a person 1.75 m tall and scale with the stature;
heights follow the joints, so that they fit people of measured proportions. The average form, that
of the neutral body, is the mean of both, as in the tables of masses.

We estimated the forms by eye and from our own bodies, for a mannequin, not for anthropometry. No
published number of ours depends on them.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from app.science.avatar.body import Population
from app.science.rotations import FloatArray

TABLE_STATURE_MM: Final = 1750.0

# Sections of the trunk from the legs up to the jaw: heights at front, side and back; half the
# breadth, depth in front of and behind the joints; squareness (2 is an ellipse); share by which
# front and back are hollow in the middle.
_TRUNK_MALE = (
    (838, 902, 826, 168, 92, 108, 2.6, 0.26, 0.28),
    (862, 914, 856, 171, 99, 123, 2.5, 0.12, 0.20),
    (900, 932, 898, 170, 102, 127, 2.4, 0.03, 0.13),
    (940, 954, 942, 167, 103, 120, 2.35, 0, 0.08),
    (985, 989, 986, 160, 103, 106, 2.3, 0, 0.05),
    (1030, 1030, 1030, 152, 104, 95, 2.3, 0, 0.05),
    (1076, 1076, 1076, 147, 105, 89, 2.3, 0, 0.06),
    (1122, 1122, 1122, 148, 108, 91, 2.3, 0, 0.06),
    (1170, 1168, 1170, 153, 113, 98, 2.3, 0, 0.06),
    (1218, 1214, 1218, 160, 118, 105, 2.35, 0.01, 0.06),
    (1264, 1258, 1264, 167, 120, 110, 2.4, 0.03, 0.06),
    (1306, 1298, 1306, 172, 116, 112, 2.45, 0.03, 0.06),
    (1340, 1334, 1342, 176, 107, 111, 2.5, 0.03, 0.06),
    (1368, 1372, 1376, 180, 95, 107, 2.5, 0.02, 0.06),
    (1392, 1416, 1412, 180, 83, 99, 2.5, 0.02, 0.05),
    (1412, 1452, 1446, 172, 72, 89, 2.5, 0.03, 0.04),
    (1424, 1474, 1472, 132, 62, 78, 2.3, 0.03, 0.03),
    (1433, 1489, 1493, 96, 57, 70, 2.15, 0.02, 0.02),
    (1444, 1506, 1510, 71, 54, 64, 2.05, 0, 0),
    (1460, 1518, 1524, 60, 53, 61, 2, 0, 0),
    (1480, 1530, 1538, 57, 54, 61, 2, 0, 0),
)  # fmt: skip
_TRUNK_FEMALE = (
    (838, 902, 826, 172, 90, 112, 2.6, 0.26, 0.28),
    (862, 914, 856, 178, 96, 128, 2.5, 0.12, 0.22),
    (900, 932, 898, 180, 99, 134, 2.4, 0.03, 0.14),
    (940, 954, 942, 176, 100, 124, 2.35, 0, 0.08),
    (985, 989, 986, 166, 99, 106, 2.3, 0, 0.05),
    (1030, 1030, 1030, 149, 97, 91, 2.25, 0, 0.05),
    (1076, 1076, 1076, 136, 94, 82, 2.2, 0, 0.06),
    (1122, 1122, 1122, 132, 95, 82, 2.2, 0, 0.06),
    (1170, 1168, 1170, 137, 100, 89, 2.2, 0, 0.06),
    (1218, 1214, 1218, 145, 107, 96, 2.25, 0.02, 0.06),
    (1264, 1258, 1264, 151, 110, 101, 2.3, 0.05, 0.06),
    (1306, 1298, 1306, 155, 106, 103, 2.35, 0.05, 0.06),
    (1340, 1334, 1342, 158, 98, 101, 2.4, 0.04, 0.06),
    (1368, 1372, 1376, 161, 86, 97, 2.45, 0.03, 0.06),
    (1392, 1416, 1412, 162, 75, 90, 2.45, 0.02, 0.05),
    (1412, 1452, 1446, 156, 65, 81, 2.45, 0.02, 0.04),
    (1424, 1474, 1472, 120, 56, 71, 2.3, 0.02, 0.03),
    (1433, 1488, 1491, 87, 51, 64, 2.15, 0.02, 0.02),
    (1444, 1504, 1508, 64, 48, 58, 2.05, 0, 0),
    (1460, 1516, 1522, 53, 47, 55, 2, 0, 0),
    (1480, 1528, 1536, 51, 48, 55, 2, 0, 0),
)  # fmt: skip

# Sections of the head from below the jaw to the crown, the same columns without hollows.
_HEAD = (
    (1496, 1538, 1552, 56, 60, 64, 2),
    (1508, 1545, 1566, 58, 76, 72, 2),
    (1519, 1551, 1579, 62, 91, 82, 2.02),
    (1531, 1560, 1591, 66, 98, 90, 2.05),
    (1550, 1574, 1604, 70, 98, 96, 2.1),
    (1575, 1592, 1618, 73, 98, 100, 2.15),
    (1600, 1612, 1632, 75, 98, 102, 2.15),
    (1627, 1634, 1647, 77, 98, 103, 2.15),
    (1648, 1652, 1660, 77.5, 99, 103, 2.15),
    (1668, 1670, 1675, 77, 97, 102, 2.1),
    (1690, 1690, 1692, 74, 92, 98, 2.05),
    (1711, 1710, 1710, 67, 82, 89, 2),
    (1729, 1727, 1727, 55, 66, 73, 2),
    (1742, 1740, 1740, 37, 44, 49, 2),
    (1748, 1747, 1747, 18, 21, 24, 2),
)

# Sections of an arm: upwards, downwards, forwards, backwards; position along upper arm (0 to 1)
# and forearm (1 to 2).
_ARM = (
    (-0.08, 40, 62, 55, 60), (0.04, 40, 58, 54, 58), (0.14, 43, 52, 52, 56),
    (0.27, 45, 47, 51, 52), (0.42, 45, 45, 50, 48), (0.58, 44, 44, 49, 46),
    (0.74, 43, 42, 45, 44), (0.86, 41, 40, 43, 43), (0.94, 40, 39, 42, 43),
    (1.0, 39, 39, 42, 44), (1.06, 39, 39, 43, 43), (1.14, 40, 40, 45, 43),
    (1.26, 41, 40, 46, 42), (1.42, 38, 37, 43, 39), (1.58, 33, 33, 39, 35),
    (1.74, 27, 27, 34, 31), (1.86, 23.5, 23.5, 31, 29), (1.945, 22, 22, 30, 28.5),
)  # fmt: skip
# Sections of a leg: inwards, outwards, forwards, backwards; along thigh (0 to 1), shank (1 to 2).
_LEG = (
    (0.16, 80, 95, 90, 104), (0.24, 79, 92, 90, 97), (0.34, 76, 88, 88, 90),
    (0.46, 72, 82, 84, 83), (0.58, 67, 76, 79, 76), (0.70, 62, 69, 73, 68),
    (0.81, 57, 62, 67, 61), (0.90, 54, 57, 63, 56), (0.96, 53, 55, 61, 53),
    (1.01, 52, 54, 60, 51), (1.06, 51, 53, 57, 52), (1.13, 50, 53, 51, 57),
    (1.21, 51, 54, 47, 64), (1.31, 51, 54, 45, 68), (1.43, 48, 51, 43, 64),
    (1.56, 43, 45, 40, 55), (1.69, 38, 39, 37, 46), (1.80, 34.5, 35, 35, 40),
    (1.875, 33, 34, 34, 38),
)  # fmt: skip
# Sections of a foot from the heel (0) to the tip of the toes (1): inwards, outwards, height.
_FOOT = (
    (0.018, 18, 20, 40), (0.05, 25, 27, 58), (0.095, 29, 31, 75), (0.15, 31, 33, 88),
    (0.205, 32, 34, 94), (0.26, 33, 34, 96), (0.315, 33, 34, 95), (0.37, 33.5, 35, 91),
    (0.43, 35, 36, 84), (0.51, 38, 39, 73), (0.60, 41, 44, 60), (0.685, 44, 48, 47),
    (0.765, 45, 49, 37), (0.84, 44, 46, 30), (0.905, 40, 38, 26), (0.955, 32, 27, 23),
    (0.985, 20, 15, 19),
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Form:
    """The form of one population at a stature: the tables above, in metres.

    Attributes:
        trunk: (R, 9) sections of the trunk.
        head: (R, 7) sections of the head.
        arm: (R, 5), leg: (R, 5), foot: (R, 4): sections of the limbs.
        hand: factor on the thickness of hands and fingers.
        bust_m, chest_m: how far the breasts, and the chest muscles, stand out.
        brow_m: how far the brow stands out.
    """

    trunk: FloatArray
    head: FloatArray
    arm: FloatArray
    leg: FloatArray
    foot: FloatArray
    hand: float
    bust_m: float
    chest_m: float
    brow_m: float


def form_of(population: Population, stature_m: float) -> Form:
    """Return the form of a population at a stature."""
    male = {"male": 1.0, "female": 0.0, "average": 0.5}[population]
    unit = stature_m / TABLE_STATURE_MM
    trunk = _mixed(_TRUNK_MALE, _TRUNK_FEMALE, male)
    trunk[:, :6] *= unit
    head = np.array(_HEAD, dtype=np.float64)
    head[:, 3] *= _between(1.02, 0.98, male)
    head[:, :6] *= unit
    arm, leg, foot = (np.array(table, dtype=np.float64) for table in (_ARM, _LEG, _FOOT))
    arm[:, 1:] *= _between(1.05, 0.91, male) * unit
    leg[:, 1:] *= unit
    above = leg[:, 0] <= 1.0
    leg[above, 1:] *= _between(0.98, 1.01, male)
    leg[~above, 1:] *= _between(1.02, 0.95, male)
    foot[:, 1:] *= unit
    foot[:, 1:3] *= _between(1.02, 0.96, male)
    return Form(
        trunk,
        head,
        arm,
        leg,
        foot,
        hand=_between(1.03, 0.94, male),
        bust_m=_between(0.0, 22.0, male) * unit,
        chest_m=_between(6.0, 0.0, male) * unit,
        brow_m=_between(4.5, 2.0, male) * unit,
    )


def _mixed(
    men: tuple[tuple[float, ...], ...], women: tuple[tuple[float, ...], ...], male: float
) -> FloatArray:
    mixed: FloatArray = male * np.array(men) + (1.0 - male) * np.array(women)
    return mixed


def _between(men: float, women: float, male: float) -> float:
    return male * men + (1.0 - male) * women
