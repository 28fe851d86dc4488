"""Segment parameters of men and women: relative mass, centre of mass, radii of gyration.

Source: de Leva (1996), "Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters", Journal
of Biomechanics 29(9), 1223-1230, table 4. Mass as a fraction of the body's; centre of mass as a
fraction of the segment's length from its proximal end (for the head: from the top); radii of
gyration about the segment's own centre of mass, as fractions of its length, about its sagittal
(front to back), transverse (left to right) and longitudinal axes.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

Population = Literal["male", "female", "average"]


@dataclass(frozen=True)
class Segment:
    """The parameters of one body segment, a row of the table.

    All values are fractions; see the module docstring.
    """

    mass: float
    center: float
    sagittal: float
    transverse: float
    longitudinal: float


MALE: Mapping[str, Segment] = MappingProxyType(
    {
        "Head": Segment(0.0694, 0.5976, 0.362, 0.376, 0.312),
        "Upper trunk 2": Segment(0.1596, 0.5066, 0.505, 0.320, 0.465),
        "Middle trunk": Segment(0.1633, 0.4502, 0.482, 0.383, 0.468),
        "Lower trunk": Segment(0.1117, 0.6115, 0.615, 0.551, 0.587),
        "Upper arm": Segment(0.0271, 0.5772, 0.285, 0.269, 0.158),
        "Forearm": Segment(0.0162, 0.4574, 0.276, 0.265, 0.121),
        "Hand 2": Segment(0.0061, 0.3624, 0.288, 0.235, 0.184),
        "Thigh": Segment(0.1416, 0.4095, 0.329, 0.329, 0.149),
        "Shank": Segment(0.0433, 0.4395, 0.251, 0.246, 0.102),
        "Foot": Segment(0.0137, 0.4415, 0.257, 0.245, 0.124),
    }
)
FEMALE: Mapping[str, Segment] = MappingProxyType(
    {
        "Head": Segment(0.0668, 0.5894, 0.330, 0.359, 0.318),
        "Upper trunk 2": Segment(0.1545, 0.5050, 0.466, 0.314, 0.449),
        "Middle trunk": Segment(0.1465, 0.4512, 0.433, 0.354, 0.415),
        "Lower trunk": Segment(0.1247, 0.4920, 0.433, 0.402, 0.444),
        "Upper arm": Segment(0.0255, 0.5754, 0.278, 0.260, 0.148),
        "Forearm": Segment(0.0138, 0.4559, 0.261, 0.257, 0.094),
        "Hand 2": Segment(0.0056, 0.3427, 0.244, 0.208, 0.154),
        "Thigh": Segment(0.1478, 0.3612, 0.369, 0.364, 0.162),
        "Shank": Segment(0.0481, 0.4352, 0.267, 0.263, 0.092),
        "Foot": Segment(0.0129, 0.4014, 0.299, 0.279, 0.139),
    }
)
PAIRED = ("Upper arm", "Forearm", "Hand 2", "Thigh", "Shank", "Foot")
"""Segments that a body has on both sides."""


def segments_of(population: Population) -> Mapping[str, Segment]:
    """Return the parameters of a population; `average` is the mean of men and women."""
    if population == "male":
        return MALE
    if population == "female":
        return FEMALE
    return {
        name: Segment(*(_mean(a, b) for a, b in zip(_row(MALE[name]), _row(row), strict=True)))
        for name, row in FEMALE.items()
    }


def mass_fractions(population: Population) -> dict[str, float]:
    """Return each segment's share of the body's mass; the shares of the whole body add up to one.

    The published ones add up to 1.0000 for men and .9999 for women, by rounding.
    """
    rows = segments_of(population)
    whole = sum(row.mass * (2 if name in PAIRED else 1) for name, row in rows.items())
    return {name: row.mass / whole for name, row in rows.items()}


def _row(segment: Segment) -> tuple[float, float, float, float, float]:
    return (
        segment.mass, segment.center, segment.sagittal, segment.transverse, segment.longitudinal,
    )  # fmt: skip


def _mean(a: float, b: float) -> float:
    return (a + b) / 2.0
