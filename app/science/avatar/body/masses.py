"""Compute the mass, centre of mass and inertia of each body part.

De Leva's segments (see `deleva`) are placed along the bones and divided among the 52 parts so that
the parts of a segment together keep its mass, its centre of mass and its radii of gyration. The
mass of a part that a model lacks is added, at its position, to the part above; so the whole body
keeps its inertia.

The mass of the upper trunk is divided equally between upper chest and shoulders (Karas 2020,
section 6.4.1). Everything that the tables do not contain is estimated by us and listed in
`ESTIMATES`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import fsum, sqrt
from types import MappingProxyType

from app.science.avatar.body.body import Body
from app.science.avatar.body.deleva import Population, Segment, mass_fractions, segments_of
from app.science.avatar.body.inertial import Inertial, combined, of_shape, remainder
from app.science.avatar.body.parts import PART_NAMES, SIDES
from app.science.avatar.body.proportions import BodyError, Proportions
from app.science.avatar.body.shapes import fingers_of, shapes_of
from app.science.rotations import Vector, v_add, v_subtract

ESTIMATES: tuple[str, ...] = (
    ("Trunk, landmarks from the hip joints up to the head's joint: navel at .26, lower end of the"
    " breastbone at .61, seventh cervical vertebra at 1."),
    "Lower trunk: all of it belongs to the hips.",
    ("Middle trunk: its lower half is the Spine's, its upper half the Chest's; their centres lie a"
    " quarter of the segment below and above its own."),
    ("Upper trunk: the shoulders' shares lie beside the upper chest's, at the same height, .39 of"
    " the way to the shoulder joint, or nearer where a narrow trunk demands it."),
    ("Head: it ends at its joint, where the tables have the angle of the jaw; .12 of it is the"
    " neck's, in the middle of its bone, with the inertia of its capsule."),
    ("Hand: .20 of it is the fingers', shared by the volumes of their capsules, with the inertia of"
    " these; more would leave the palm less inertia than the tables have."),
    ("Foot: .12 of it is the toes', with the inertia of their box; its centre of mass lies at half"
    " the height of its box."),
)  # fmt: skip
"""What de Leva's tables do not contain and is estimated instead."""

_NAVEL, _BREASTBONE = 0.26, 0.61
_SHOULDER_SHARE_AT = 0.39
_NECK_SHARE, _FINGERS_SHARE, _TOES_SHARE = 0.12, 0.20, 0.12
_LIGHTEST_KG, _HEAVIEST_KG = 1.0, 500.0
# Which of a segment's axes lie along x, y, z in the T-pose: trunk and legs are upright, an arm
# lies along x and its elbow bends about y, a hand lies flat, a foot points forward.
_STANDING = ("transverse", "longitudinal", "sagittal")
_ARM = ("longitudinal", "transverse", "sagittal")
_HAND = ("longitudinal", "sagittal", "transverse")
_FOOT = ("transverse", "sagittal", "longitudinal")


@dataclass(frozen=True)
class BodyMasses:
    """Mass and inertia of every present part, each in the part's own frame."""

    population: Population
    parts: Mapping[str, Inertial]

    @property
    def total_kg(self) -> float:
        """Return the mass of the whole body."""
        return fsum(part.mass_kg for part in self.parts.values())


def body_masses(
    body: Body,
    total_kg: float,
    *,
    population: Population = "average",
    relative: Mapping[str, float] | None = None,
) -> BodyMasses:
    """Distribute a body's mass among its parts.

    Args:
        body: the body, whose lengths scale the radii of gyration.
        total_kg: 1 to 500 kg.
        population: supplies the relative masses.
        relative: part -> its share of the mass, if it differs; the other parts share the rest as
            the population has it. Centres of mass stay, and radii of gyration, too.

    Raises:
        BodyError: the mass is out of range.
    """
    if not _LIGHTEST_KG <= total_kg <= _HEAVIEST_KG:
        raise BodyError(
            f"A mass of {total_kg} kg is outside {_LIGHTEST_KG:g} to {_HEAVIEST_KG:g} kg: give the"
            " mass of the whole body in kilograms."
        )
    usual = _MassDistribution(body.proportions, total_kg, population).parts()
    whole = _with_shares(usual, relative or {}, total_kg)
    places = body.proportions.places_m()
    inertials_by_part: dict[str, list[Inertial]] = {part: [] for part in body.parts}
    for part in PART_NAMES:
        carrier = body.carrier_of(part)
        inertials_by_part[carrier].append(
            whole[part].moved(v_subtract(places[part], places[carrier]))
        )
    parts = {part: combined(pieces) for part, pieces in inertials_by_part.items()}
    return BodyMasses(population, MappingProxyType(parts))


def _with_shares(
    whole: Mapping[str, Inertial], relative: Mapping[str, float], total_kg: float
) -> Mapping[str, Inertial]:
    if not relative:
        return whole
    given = fsum(relative.values())
    rest_kg = fsum(one.mass_kg for part, one in whole.items() if part not in relative)
    if rest_kg > 0.0:
        others = (1.0 - given) * total_kg / rest_kg
        per_share_kg = total_kg
    else:
        others, per_share_kg = 0.0, total_kg / given
    return {
        part: one.scaled(
            relative[part] * per_share_kg / one.mass_kg if part in relative else others
        )
        for part, one in whole.items()
    }


class _MassDistribution:
    """Computes the inertial properties of all parts of a complete body from its segments.

    It works in the world frame of the T-pose; `parts` converts the results to the parts' frames.
    """

    def __init__(self, bones: Proportions, total_kg: float, population: Population) -> None:
        self._bones = bones
        self._places = bones.places_m()
        self._rows = segments_of(population)
        self._kg = {name: share * total_kg for name, share in mass_fractions(population).items()}
        self._parts: dict[str, Inertial] = {}

    def parts(self) -> dict[str, Inertial]:
        """Return the inertial properties of every part, each in the part's own frame."""
        self._trunk()
        self._head()
        for side in SIDES:
            self._limb(side, "Upper arm", ("UpperArm", "LowerArm"), _ARM)
            self._limb(side, "Forearm", ("LowerArm", "Hand"), _ARM)
            self._limb(side, "Thigh", ("UpperLeg", "LowerLeg"), _STANDING)
            self._limb(side, "Shank", ("LowerLeg", "Foot"), _STANDING)
            self._hand(side)
            self._foot(side)
        return {
            part: inertial.moved(v_subtract((0.0, 0.0, 0.0), self._places[part]))
            for part, inertial in self._parts.items()
        }

    def _segment(
        self, name: str, proximal: Vector, distal: Vector, along: tuple[str, str, str]
    ) -> Inertial:
        row = self._rows[name]
        center = _between(proximal, distal, row.center)
        span = v_subtract(distal, proximal)
        length = sqrt(span[0] ** 2 + span[1] ** 2 + span[2] ** 2)
        x, y, z = (self._kg[name] * (getattr(row, axis) * length) ** 2 for axis in along)
        return Inertial(self._kg[name], center, (x, y, z, 0.0, 0.0, 0.0))

    def _limb(
        self, side: str, name: str, ends: tuple[str, str], along: tuple[str, str, str]
    ) -> None:
        start, end = (self._places[f"{side}{part}"] for part in ends)
        self._parts[f"{side}{ends[0]}"] = self._segment(name, start, end, along)

    def _trunk(self) -> None:
        foot = _between(self._places["LeftUpperLeg"], self._places["RightUpperLeg"], 0.5)
        top = self._places["Head"]
        navel, breastbone = _between(foot, top, _NAVEL), _between(foot, top, _BREASTBONE)
        self._parts["Hips"] = self._segment("Lower trunk", navel, foot, _STANDING)
        middle = self._segment("Middle trunk", breastbone, navel, _STANDING)
        quarter = (breastbone[1] - navel[1]) / 4.0
        self._share(middle, {"Spine": (0.0, -quarter, 0.0), "Chest": (0.0, quarter, 0.0)})
        upper = self._segment("Upper trunk 2", top, breastbone, _STANDING)
        offset_x = self._shoulder_share_m(self._rows["Upper trunk 2"], breastbone, top)
        self._share(
            upper,
            {
                "UpperChest": (0.0, 0.0, 0.0),
                "LeftShoulder": (-offset_x, 0.0, 0.0),
                "RightShoulder": (offset_x, 0.0, 0.0),
            },
        )

    def _shoulder_share_m(self, row: Segment, low: Vector, top: Vector) -> float:
        # The inertia of two thirds of the mass at this distance must be less than the segment's.
        length = top[1] - low[1]
        most = sqrt(0.6) * min(row.sagittal, row.longitudinal) * length
        return min(_SHOULDER_SHARE_AT * self._places["RightUpperArm"][0], most)

    def _share(self, segment: Inertial, offsets: Mapping[str, Vector]) -> None:
        """Divide a segment into equal parts that together keep its mass, centre and inertia."""
        count = len(offsets)
        squares = [sum(offset[axis] ** 2 for offset in offsets.values()) for axis in range(3)]
        mass = segment.mass_kg / count
        own = [
            segment.inertia_kg_m2[axis] / count
            - mass / count * (squares[(axis + 1) % 3] + squares[(axis + 2) % 3])
            for axis in range(3)
        ]
        for part, (x, y, z) in offsets.items():
            cx, cy, cz = segment.center_m
            center = (cx + x, cy + y, cz + z)
            self._parts[part] = Inertial(mass, center, (own[0], own[1], own[2], 0.0, 0.0, 0.0))

    def _head(self) -> None:
        top = self._tip("Head")
        head = self._segment("Head", top, self._places["Head"], _STANDING)
        neck = self._shaped("Neck", _NECK_SHARE * head.mass_kg)
        self._parts["Neck"], self._parts["Head"] = neck, remainder(head, [neck])

    def _hand(self, side: str) -> None:
        hand = f"{side}Hand"
        x, y, z = self._places[hand]
        outwards = -1.0 if side == "Left" else 1.0
        tip = (x + outwards * self._bones.segments_m["hand"], y, z)
        whole = self._segment("Hand 2", self._places[hand], tip, _HAND)
        volumes = {
            part: shapes_of(self._bones, part)[0].volume_m3
            for finger in fingers_of(hand)
            for part in finger
        }
        density = _FINGERS_SHARE * whole.mass_kg / fsum(volumes.values())
        fingers = {part: self._shaped(part, density * own) for part, own in volumes.items()}
        self._parts.update(fingers)
        self._parts[hand] = remainder(whole, list(fingers.values()))

    def _foot(self, side: str) -> None:
        part, toes_part = f"{side}Foot", f"{side}Toes"
        x, y, z = self._places[part]
        box = shapes_of(self._bones, part)[0].center_m
        heel = (x, y + box[1], z + self._bones.heel_m)
        tip = (x, y + box[1], z + self._bones.heel_m - self._bones.segments_m["foot"])
        whole = self._segment("Foot", heel, tip, _FOOT)
        toes = self._shaped(toes_part, _TOES_SHARE * whole.mass_kg)
        self._parts[toes_part], self._parts[part] = toes, remainder(whole, [toes])

    def _shaped(self, part: str, mass_kg: float) -> Inertial:
        shape = shapes_of(self._bones, part)[0]
        return of_shape(shape, mass_kg).moved(self._places[part])

    def _tip(self, part: str) -> Vector:
        return v_add(self._places[part], self._bones.ends_m[part])


def _between(a: Vector, b: Vector, fraction: float) -> Vector:
    x, y, z = (p + fraction * (q - p) for p, q in zip(a, b, strict=True))
    return (x, y, z)
