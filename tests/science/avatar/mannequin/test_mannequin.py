"""Tests of the figures made by code: closed skins with smooth weights around a person's joints."""

from itertools import pairwise

import numpy as np
import pytest

from app.science.avatar.body import (
    AXES_OF,
    FINGERS,
    PARENT_OF,
    PART_NAMES,
    Population,
    proportions,
)
from app.science.avatar.mannequin import Mannequin, make_mannequin
from app.science.rotations import FloatArray, from_rotation_vector, identity, matrices, multiply

STATURE_M = 1.75
LITTLE = {"upper_arm": 0.8, "forearm": 0.8, "thigh": 0.8, "shank": 0.85, "hand": 0.8, "trunk": 1.1}
BROAD = {"shoulders": 1.2, "hips": 1.25, "foot": 1.15, "head": 1.1, "thigh": 1.1, "forearm": 1.2}
PEOPLE: dict[str, tuple[Population, float, dict[str, float]]] = {
    "neutral": ("average", STATURE_M, {}),
    "female": ("female", STATURE_M, {}),
    "child": ("average", 1.1, LITTLE),
    "tall": ("male", 2.05, BROAD),
}


@pytest.fixture(params=PEOPLE, scope="module")
def figure(request: pytest.FixtureRequest) -> Mannequin:
    """Return the figure of each of several people."""
    population, stature_m, factors = PEOPLE[request.param]
    usual = proportions(stature_m).segments_m
    segments = {name: factor * usual[name] for name, factor in factors.items()}
    return make_mannequin(proportions(stature_m, segments), population)


def volume_m3(points: FloatArray, triangles: np.ndarray) -> float:
    """Return the volume that a closed surface encloses, by the divergence theorem."""
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


def windings(figure: Mannequin, places: FloatArray) -> FloatArray:
    """Return how often the skin winds around places: 1 inside, 0 outside.

    Source: Van Oosterom and Strackee (1983), the solid angle of a plane triangle.
    """
    found = []
    for place in places:
        a, b, c = (figure.points_m[figure.triangles[:, n]] - place for n in range(3))
        la, lb, lc = (np.linalg.norm(edge, axis=1) for edge in (a, b, c))
        above = np.einsum("ij,ij->i", a, np.cross(b, c))
        below = (
            la * lb * lc
            + np.einsum("ij,ij->i", a, b) * lc
            + np.einsum("ij,ij->i", b, c) * la
            + np.einsum("ij,ij->i", c, a) * lb
        )
        found.append(float(2.0 * np.arctan2(above, below).sum() / (4.0 * np.pi)))
    return np.array(found)


def posed(figure: Mannequin, angles_deg: dict[str, float]) -> FloatArray:
    """Return the skin with some axes turned, by linear blend skinning."""
    places = {part: np.array(place) for part, place in figure.body.places_m().items()}
    turned, moved = {}, {}
    for part in PART_NAMES:
        turn = identity()
        for axis in AXES_OF[part]:
            angle = np.radians(angles_deg.get(axis.name, 0.0))
            turn = multiply(turn, from_rotation_vector(np.array(axis.direction) * angle))
        above = PARENT_OF[part]
        if above is None:
            turned[part], moved[part] = turn, places[part]
        else:
            turned[part] = multiply(turned[above], turn)
            offset = matrices(turned[above]) @ (places[part] - places[above])
            moved[part] = moved[above] + offset
    turns = matrices(np.array([turned[part] for part in PART_NAMES]))
    joints = np.array([places[part] for part in PART_NAMES])
    there = np.array([moved[part] for part in PART_NAMES])
    skin = np.zeros_like(figure.points_m)
    for influence in range(figure.parts.shape[1]):
        led = figure.parts[:, influence]
        own = np.einsum("nij,nj->ni", turns[led], figure.points_m - joints[led]) + there[led]
        skin += figure.weights[:, influence, np.newaxis] * own
    return skin


def test_the_skin_is_one_closed_surface(figure: Mannequin) -> None:
    """Every edge belongs to two triangles that run along it in opposite directions."""
    edges = np.concatenate([figure.triangles[:, [n, (n + 1) % 3]] for n in range(3)])
    forward = set(map(tuple, edges.tolist()))
    assert len(forward) == len(edges)
    assert forward == {(end, start) for start, end in forward}
    assert len(figure.triangles) <= 12_000
    # A sphere's Euler characteristic: one piece without handles.
    assert len(figure.points_m) - len(edges) // 2 + len(figure.triangles) == 2
    assert set(np.unique(figure.triangles)) == set(range(len(figure.points_m)))


def test_the_body_has_a_persons_height_and_volume(figure: Mannequin) -> None:
    """The soles are at zero, the crown at the top of the head, the volume is a slim person's."""
    heights = figure.points_m[:, 1]
    top = figure.body.places_m()["Head"][1] + figure.body.ends_m["Head"][1]
    assert heights.min() == pytest.approx(0.0, abs=1e-9)
    assert heights.max() == pytest.approx(top, abs=1e-9)
    litres = 1000.0 * volume_m3(figure.points_m, figure.triangles)
    assert 10.5 < litres / figure.body.stature_m**3 < 16.0


def test_every_joint_lies_inside_the_skin(figure: Mannequin) -> None:
    """The skin winds exactly once around every joint of the 52 parts."""
    places = np.array(list(figure.body.places_m().values()))
    assert windings(figure, places) == pytest.approx(np.ones(len(PART_NAMES)), abs=1e-6)


def test_left_and_right_are_the_same(figure: Mannequin) -> None:
    """Points, normals and weights of one side are the other's mirror image, to the last bit."""
    mirror = np.array((-1.0, 1.0, 1.0))
    assert (figure.points_m[figure.mirrored] == figure.points_m * mirror).all()
    assert (figure.normals[figure.mirrored] == figure.normals * mirror).all()
    aside = figure.points_m[:, 0] != 0.0
    assert (figure.weights[figure.mirrored][aside] == figure.weights[aside]).all()
    # No limb reaches over the middle, so neither leg is inside the other.
    right = np.unique(figure.triangles[(figure.points_m[figure.triangles, 0] > 0.0).any(axis=1)])
    assert figure.points_m[right, 0].min() == 0.0


def test_weights_are_few_and_add_up(figure: Mannequin) -> None:
    """A point follows at most four parts, weights add up to one, and every part leads some skin."""
    assert figure.weights.shape == figure.parts.shape == (len(figure.points_m), 4)
    assert figure.weights.sum(axis=1) == pytest.approx(1.0, abs=1e-12)
    assert (figure.weights >= 0.0).all()
    assert (np.diff(figure.weights, axis=1) <= 0.0).all()
    counts = np.bincount(figure.parts[:, 0], minlength=len(PART_NAMES))
    assert counts.min() >= 8


def test_neighbouring_points_follow_neighbouring_parts(figure: Mannequin) -> None:
    """Along no edge of the skin does a part's weight jump by more than four fifths."""
    shares = np.zeros((len(figure.points_m), len(PART_NAMES)))
    for influence in range(4):
        np.add.at(
            shares,
            (np.arange(len(shares)), figure.parts[:, influence]),
            figure.weights[:, influence],
        )
    edges = np.concatenate([figure.triangles[:, [n, (n + 1) % 3]] for n in range(3)])
    assert np.abs(shares[edges[:, 0]] - shares[edges[:, 1]]).max() < 0.8


def test_fingers_are_apart(figure: Mannequin) -> None:
    """Beyond the webs no finger touches another: their nearest points are apart."""
    strongest = np.array(PART_NAMES)[figure.parts[:, 0]]
    tips = {
        finger: figure.points_m[
            np.isin(strongest, [f"Right{finger}{part}" for part in ("Intermediate", "Distal")])
        ]
        for finger in FINGERS
    }
    for one, other in pairwise(FINGERS[1:]):
        between = np.linalg.norm(tips[one][:, np.newaxis] - tips[other][np.newaxis], axis=2)
        assert between.min() > 0.0004 * figure.body.stature_m, (one, other)


BENT: dict[str, dict[str, float]] = {
    "elbow": {"LeftLowerArmY": 120.0},
    "arms down": {"LeftUpperArmZ": -80.0, "RightUpperArmZ": -80.0},
    "knee": {"LeftLowerLegX": 120.0},
    "hip": {"LeftUpperLegX": 90.0, "RightUpperLegX": 90.0},
    "fist": {
        f"Left{finger}{segment}Z": angle
        for finger in FINGERS[1:]
        for segment, angle in (("Proximal", 80.0), ("Intermediate", 95.0), ("Distal", 60.0))
    },
    "trunk": dict.fromkeys(("SpineX", "ChestX", "UpperChestX", "NeckX", "HeadX"), 20.0),
}


@pytest.mark.parametrize("bent", BENT)
def test_bent_joints_do_not_collapse(figure: Mannequin, bent: str) -> None:
    """A bent figure keeps its volume within 5 %, and the skin near a bent joint its distance."""
    skin = posed(figure, BENT[bent])
    rest = volume_m3(figure.points_m, figure.triangles)
    assert volume_m3(skin, figure.triangles) == pytest.approx(rest, rel=0.05)
    lengths = [
        np.linalg.norm(points[figure.triangles[:, 0]] - points[figure.triangles[:, 1]], axis=1)
        for points in (figure.points_m, skin)
    ]
    assert np.percentile(lengths[1] / lengths[0], 0.5) > 0.3
    assert (lengths[1] / lengths[0]).max() < 4.0


def test_all_people_have_the_same_triangles() -> None:
    """Bodies of different forms and sizes have the same triangles, tones and point numbers."""
    one, other = (make_mannequin(proportions(1.2), "female"), make_mannequin(proportions(1.9)))
    assert (one.triangles == other.triangles).all()
    assert (one.tones == other.tones).all()
    assert len(one.points_m) == len(other.points_m)


def test_a_figure_grows_with_the_stature() -> None:
    """A figure of twice the stature is twice as large in every direction."""
    small, large = make_mannequin(proportions(1.0)), make_mannequin(proportions(2.0))
    assert large.points_m == pytest.approx(2.0 * small.points_m, abs=1e-9)
    assert large.weights == pytest.approx(small.weights, abs=1e-9)
