"""Extract from a humanoid model what its body needs: joints, lengths, and a convex piece per part.

Lengths are measured between the points that the mass tables use, and named as in
`proportions.SEGMENT_NAMES`; the head, and the trunk of a model without a neck joint, get the length
expected for the stature. A length that no person can have is rejected. An unusual one, as many
drawn characters have, is replaced for the masses by the nearest that a person may have, with a
note; joints and pieces stay where the model has them.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import dist
from types import MappingProxyType

import numpy as np

from app.science.avatar.body.hulls import Piece, piece_of
from app.science.avatar.body.humanoid import Humanoid, HumanoidError
from app.science.avatar.body.parts import FINGERS, PARENT_OF, PART_NAMES, SIDES
from app.science.avatar.body.proportions import MAX_RATIO, MIN_RATIO, BodyError, segment_lengths
from app.science.rotations import FloatArray, Vector, v_add, v_length, v_scale, v_subtract

_SHORTEST, _LONGEST = 0.3, 3.0
_DIGITS = 6
_JUST_INSIDE = 1e-4
"""Relative margin to the permitted range, as lengths are rounded and scaled afterwards."""
_KNUCKLES = 0.446
"""Distance from the wrist to the middle knuckle, as a fraction of the hand's length: `fingers`."""


@dataclass(frozen=True)
class UnusualLength:
    """A length that is unusual for the stature, beside the usual one and its range.

    `name`: one of `proportions.SEGMENT_NAMES`; all lengths in metres.
    """

    name: str
    length_m: float
    usual_m: float
    low_m: float
    high_m: float


@dataclass(frozen=True)
class Figure:
    """Measurements of a model in the T-pose; frames as in `app.science.avatar.body.parts`.

    Attributes:
        stature_m: the stature of the model itself.
        places_m: part -> position of its joint above the floor, in the order of `PART_NAMES`.
        segments_m: lengths by the names of `proportions.SEGMENT_NAMES`, as far as they could be
            measured.
        pieces: part -> its convex piece; parts whose skin encloses no volume are absent.
        notes: remarks for the user, each a sentence.
    """

    stature_m: float
    places_m: Mapping[str, Vector]
    segments_m: Mapping[str, float]
    pieces: Mapping[str, Piece]
    notes: tuple[str, ...] = ()

    @property
    def absent(self) -> tuple[str, ...]:
        """Return the body parts that the model lacks."""
        return tuple(part for part in PART_NAMES if part not in self.places_m)

    @property
    def without_piece(self) -> tuple[str, ...]:
        """Return the parts whose skin is too small for a convex piece."""
        return tuple(part for part in self.places_m if part not in self.pieces)

    def finger_count(self, side: str) -> int:
        """Return the number of fingers of the left or right hand."""
        return sum(f"{side}{finger}Proximal" in self.places_m for finger in FINGERS)

    def unusual_lengths(self) -> tuple[UnusualLength, ...]:
        """Return the lengths of the model that are unusual for a person of its stature.

        They are measured again, where joints and pieces are: `segments_m` has the nearest length
        that a person may have.
        """
        skins = {part: np.array(piece.corners_m) for part, piece in self.pieces.items()}
        expected = segment_lengths(self.stature_m)
        return tuple(
            UnusualLength(name, length, usual, MIN_RATIO * usual, MAX_RATIO * usual)
            for name, length in _measured(self.places_m, skins)
            if _is_unusual(length, usual := expected[name])
        )

    def scaled(self, stature_m: float) -> "Figure":
        """Return the figure scaled to a person's stature."""
        factor = stature_m / self.stature_m
        return Figure(
            stature_m,
            {part: v_scale(place, factor) for part, place in self.places_m.items()},
            {name: length * factor for name, length in self.segments_m.items()},
            {part: piece.scaled(factor) for part, piece in self.pieces.items()},
            self.notes,
        )

    def with_arms(self, lengths_m: Mapping[str, float]) -> "Figure":
        """Return the figure with arms of these lengths on both sides, from joint to joint.

        `lengths_m`: by `upper_arm` and `forearm`; an arm keeps what is left out. The bones and
        their pieces are stretched or compressed along themselves; hands and fingers keep their
        size and move with the wrists.
        """
        places, pieces = dict(self.places_m), dict(self.pieces)
        for name, length_m in lengths_m.items():
            for start, end in ((f"{side}{one}" for one in _BONES[name]) for side in SIDES):
                bone = v_subtract(self.places_m[end], self.places_m[start])
                ratio = length_m / v_length(bone)
                moved = v_scale(bone, ratio - 1.0)
                for part in places:
                    if _is_carried_by(part, end):
                        places[part] = v_add(places[part], moved)
                if start in pieces:
                    direction = v_scale(bone, 1.0 / v_length(bone))
                    pieces[start] = pieces[start].stretched(direction, ratio)
        return replace(
            self,
            places_m=MappingProxyType(places),
            segments_m=MappingProxyType({**self.segments_m, **lengths_m}),
            pieces=MappingProxyType(pieces),
        )


def figure_of(humanoid: Humanoid) -> Figure:
    """Measure a humanoid model.

    Raises:
        HumanoidError: its stature, or one of its lengths, is impossible for a person.
    """
    stature = round(humanoid.stature_m, _DIGITS)
    try:
        expected = segment_lengths(stature)
    except BodyError as error:
        raise HumanoidError(f"The model is not a human body: {error}") from error
    notes = list(humanoid.notes)
    segments: dict[str, float] = {}
    skins = {part: own.vertices_m for part, own in humanoid.parts.items()}
    places = {part: own.place_m for part, own in humanoid.parts.items()}
    for name, length in _measured(places, skins):
        ratio = length / expected[name]
        if not _SHORTEST <= ratio <= _LONGEST:
            raise HumanoidError(
                f"The {_WORDS[name]} of a model {stature:g} m tall cannot be {length:.3f} m;"
                f" about {expected[name]:.3f} m is expected. Check the bones between which it was"
                f" measured: {_BETWEEN[name]}."
            )
        counted = _counted(length, expected[name])
        if _is_unusual(length, expected[name]):
            notes.append(
                f"The {_WORDS[name]} of {length:.3f} m is unusual: usual for {stature:.2f} m are"
                f" {MIN_RATIO * expected[name]:.3f} to {MAX_RATIO * expected[name]:.3f} m. Masses"
                f" are computed with {counted:.3f} m."
            )
        segments[name] = round(counted, _DIGITS)
    pieces = {part: piece_of(own.vertices_m) for part, own in humanoid.parts.items()}
    return Figure(
        stature,
        MappingProxyType({part: _rounded(own.place_m) for part, own in humanoid.parts.items()}),
        MappingProxyType(segments),
        MappingProxyType({part: one for part, one in pieces.items() if one is not None}),
        tuple(notes),
    )


_BETWEEN: Mapping[str, str] = {
    "upper_arm": "UpperArm and LowerArm",
    "forearm": "LowerArm and Hand",
    "hand": "Hand and the fingertips",
    "thigh": "UpperLeg and LowerLeg",
    "shank": "LowerLeg and Foot",
    "foot": "the skin of Foot and Toes",
    "trunk": "Hips and Neck",
    "shoulders": "LeftUpperArm and RightUpperArm",
    "hips": "LeftUpperLeg and RightUpperLeg",
}
_WORDS = {name: name.replace("_", " ") for name in _BETWEEN} | {
    "shoulders": "breadth of the shoulders",
    "hips": "breadth of the hips",
}
_BONES = {
    "upper_arm": ("UpperArm", "LowerArm"),
    "forearm": ("LowerArm", "Hand"),
    "thigh": ("UpperLeg", "LowerLeg"),
    "shank": ("LowerLeg", "Foot"),
}


def _counted(length: float, expected: float) -> float:
    """Return the nearest length that a person may have, of whom another one is expected."""
    least, most = MIN_RATIO + _JUST_INSIDE, MAX_RATIO - _JUST_INSIDE
    return min(max(length / expected, least), most) * expected


def _is_unusual(length: float, expected: float) -> bool:
    return abs(_counted(length, expected) - length) > _JUST_INSIDE * length


def _measured(
    places: Mapping[str, Vector], skins: Mapping[str, FloatArray]
) -> Iterator[tuple[str, float]]:
    """Yield the name and the measured length of each segment, the mean of both sides.

    `skins`: part -> (N, 3) points of its skin, in the part's own frame.
    """
    for name, (start, end) in _BONES.items():
        yield name, _mean(dist(places[f"{s}{start}"], places[f"{s}{end}"]) for s in SIDES)
    for name, part in (("shoulders", "UpperArm"), ("hips", "UpperLeg")):
        yield name, places[f"Right{part}"][0] - places[f"Left{part}"][0]
    if "Neck" in places:
        yield "trunk", places["Neck"][1] - places["Hips"][1]
    hands = [length for side in SIDES for length in _hand(places, skins, side)]
    if hands:
        yield "hand", _mean(iter(hands))
    feet = [length for side in SIDES for length in _foot(places, skins, side)]
    if feet:
        yield "foot", _mean(iter(feet))


def _hand(
    places: Mapping[str, Vector], skins: Mapping[str, FloatArray], side: str
) -> Iterator[float]:
    """Yield the length of a hand, measured on its skin, or else estimated from its middle knuckle.

    Yield nothing for a hand without skin and middle finger.
    """
    outwards = -1.0 if side == "Left" else 1.0
    wrist = places[f"{side}Hand"][0]
    names = [f"{side}Hand", *(part for part in PART_NAMES if _is_finger(part, side))]
    reaches = [
        float((outwards * (skins[name][:, 0] + places[name][0] - wrist)).max())
        for name in names
        if len(skins.get(name, ()))
    ]
    if reaches:
        yield max(reaches)
    elif f"{side}MiddleProximal" in places:
        knuckle = places[f"{side}MiddleProximal"][0]
        yield outwards * (knuckle - wrist) / _KNUCKLES


def _foot(
    places: Mapping[str, Vector], skins: Mapping[str, FloatArray], side: str
) -> Iterator[float]:
    soles = [
        skins[name][:, 2] + places[name][2]
        for name in (f"{side}Foot", f"{side}Toes")
        if len(skins.get(name, ()))
    ]
    if soles:
        along = np.concatenate(soles)
        yield float(along.max() - along.min())


def _is_carried_by(part: str, joint: str) -> bool:
    """Return whether the part is this one, or carried by it."""
    above: str | None = part
    while above is not None and above != joint:
        above = PARENT_OF[above]
    return above is not None


def _is_finger(part: str, side: str) -> bool:
    return any(part.startswith(f"{side}{finger}") for finger in FINGERS)


def _mean(lengths: Iterator[float]) -> float:
    values = list(lengths)
    return sum(values) / len(values)


def _rounded(place: Vector) -> Vector:
    x, y, z = (round(value, _DIGITS) + 0.0 for value in place)
    return (x, y, z)
