"""Tests of masses, centres of mass and inertia of the body parts."""

from pathlib import Path

import numpy as np
import pytest

from app.science.avatar.body.body import Body, BodyError, build_body
from app.science.avatar.body.deleva import FEMALE, MALE, Population, Segment, segments_of
from app.science.avatar.body.inertial import Inertial, combined, of_shape, remainder
from app.science.avatar.body.masses import ESTIMATES, BodyMasses, body_masses
from app.science.avatar.body.parts import FINGER_PARTS, PART_NAMES, mirrored_name
from app.science.avatar.body.shapes import Box, Capsule

POPULATIONS: tuple[Population, ...] = ("male", "female", "average")


@pytest.mark.parametrize(("file", "table"), [("BSPmale", MALE), ("BSPfemale", FEMALE)])
def test_the_tables_are_de_levas(shared_data: Path, file: str, table: dict[str, Segment]) -> None:
    """Every number of the mass tables equals that of de Leva's published table."""
    lines = (shared_data / "models" / f"{file}_ZdeLeva.txt").read_text().splitlines()
    rows = {cells[0].strip(): cells for cells in (line.split("\t") for line in lines)}
    for name, row in table.items():
        published = tuple(float(cell) for cell in rows[name][2:])
        ours = (row.mass, row.center, row.sagittal, row.transverse, row.longitudinal)
        assert ours == published


def test_average_is_the_mean_of_men_and_women() -> None:
    """Average masses are the mean of men's and women's: thigh (.1416 + .1478) / 2 of the mass."""
    assert segments_of("average")["Thigh"].mass == pytest.approx(0.1447)


@pytest.mark.parametrize("population", POPULATIONS)
@pytest.mark.parametrize("total_kg", [1.0, 72.0, 500.0])
def test_the_parts_weigh_as_much_as_the_body(population: Population, total_kg: float) -> None:
    """The masses of the parts add up to the body's mass."""
    masses = body_masses(build_body(1.75), total_kg, population=population)
    assert masses.total_kg == pytest.approx(total_kg, rel=1e-14, abs=1e-12)


def test_relative_masses_are_the_published_ones() -> None:
    """The parts of a man have the published shares of his mass.

    Of 100 kg: thigh 14.16, shank 4.33, hand with fingers .61, head with neck 6.94.
    """
    parts = body_masses(build_body(1.75), 100.0, population="male").parts
    assert parts["LeftUpperLeg"].mass_kg == pytest.approx(14.16)
    assert parts["LeftLowerLeg"].mass_kg == pytest.approx(4.33)
    assert parts["Head"].mass_kg + parts["Neck"].mass_kg == pytest.approx(6.94)
    fingers = [parts[p].mass_kg for p in FINGER_PARTS if p.startswith("Left")]
    assert parts["LeftHand"].mass_kg + sum(fingers) == pytest.approx(0.61)


def test_the_upper_trunk_is_shared_in_equal_parts() -> None:
    """Upper chest and each shoulder weigh a third of the upper trunk (Karas 2020, 6.4.1)."""
    parts = body_masses(build_body(1.75), 100.0, population="male").parts
    for part in ("UpperChest", "LeftShoulder", "RightShoulder"):
        assert parts[part].mass_kg == pytest.approx(15.96 / 3.0)


# Segment of the table: its parts, its length at stature 1, and its radii about x, y, z.
_WHOLE = {
    "Upper trunk 2": (("UpperChest", "LeftShoulder", "RightShoulder"), 0.39 * 0.345, "tls"),
    "Middle trunk": (("Spine", "Chest"), 0.35 * 0.345, "tls"),
    "Head": (("Neck", "Head"), 0.125, "tls"),
    "Upper arm": (("LeftUpperArm",), 0.186, "lts"),
    "Hand 2": (("LeftHand", *(p for p in FINGER_PARTS if "Left" in p)), 0.108, "lst"),
    "Thigh": (("RightUpperLeg",), 0.245, "tls"),
    "Foot": (("RightFoot", "RightToes"), 0.152, "tsl"),
}


@pytest.mark.parametrize("name", _WHOLE)
@pytest.mark.parametrize("population", POPULATIONS)
def test_the_parts_of_a_segment_keep_its_inertia(name: str, population: Population) -> None:
    """A segment divided among parts keeps the radii of gyration of the table."""
    parts, length, letters = _WHOLE[name]
    body = build_body(1.0)
    whole = _together(body, body_masses(body, 70.0, population=population), parts)
    row = segments_of(population)[name]
    radius = {"s": row.sagittal, "t": row.transverse, "l": row.longitudinal}
    expected = [whole.mass_kg * (radius[letter] * length) ** 2 for letter in letters]
    assert whole.inertia_kg_m2[:3] == pytest.approx(expected, rel=1e-9)


def _together(body: Body, masses: BodyMasses, parts: tuple[str, ...]) -> Inertial:
    places = body.places_m()
    return combined([masses.parts[part].moved(places[part]) for part in parts])


def test_centres_of_mass_lie_where_the_table_says() -> None:
    """Centres of mass lie at the table's fractions of their segments.

    A man's upper arm: .5772 of the way to the elbow; hand: .3624 of the way to the fingertip.
    """
    body = build_body(1.0)
    masses = body_masses(body, 70.0, population="male")
    assert masses.parts["LeftUpperArm"].center_m == pytest.approx((-0.5772 * 0.186, 0.0, 0.0))
    fingers = tuple(p for p in FINGER_PARTS if p.startswith("Right"))
    hand = _together(body, masses, ("RightHand", *fingers)).center_m
    assert hand[0] - body.places_m()["RightHand"][0] == pytest.approx(0.3624 * 0.108)


@pytest.mark.parametrize("population", POPULATIONS)
@pytest.mark.parametrize(
    ("stature_m", "segments"),
    [(1.4, {}), (1.75, {}), (2.1, {}), (1.75, {"trunk": 0.36, "shoulders": 0.58, "hand": 0.24})],
)
def test_every_part_is_a_possible_rigid_body(
    population: Population, stature_m: float, segments: dict[str, float]
) -> None:
    """Mass and principal moments are positive, and no moment exceeds the sum of the other two."""
    body = build_body(stature_m, segments_m=segments)
    for part, found in body_masses(body, 72.0, population=population).parts.items():
        xx, yy, zz, xy, xz, yz = found.inertia_kg_m2
        moments = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        assert found.mass_kg > 0.0, part
        assert moments[0] > 0.0, part
        assert moments[2] <= (moments[0] + moments[1]) * (1.0 + 1e-9), part


def test_the_mass_of_a_missing_part_goes_to_the_part_above() -> None:
    """Mass, centre and inertia of the body stay the same when optional parts are missing."""
    absent = {*FINGER_PARTS, "Chest", "LeftShoulder", "RightToes", "Neck"}
    whole = build_body(1.75)
    less = build_body(1.75, parts=[part for part in PART_NAMES if part not in absent])
    all_of = _together(whole, body_masses(whole, 72.0), tuple(whole.parts))
    rest = _together(less, body_masses(less, 72.0), tuple(less.parts))
    assert rest.mass_kg == pytest.approx(all_of.mass_kg, abs=1e-12)
    assert rest.center_m == pytest.approx(all_of.center_m, abs=1e-12)
    assert rest.inertia_kg_m2 == pytest.approx(all_of.inertia_kg_m2, abs=1e-10)


def test_both_sides_weigh_the_same() -> None:
    """Left and right parts are mirror images in mass, centre of mass and inertia."""
    parts = body_masses(build_body(1.75), 72.0).parts
    for name, part in parts.items():
        twin = parts[mirrored_name(name)]
        x, y, z = part.center_m
        xx, yy, zz, xy, xz, yz = part.inertia_kg_m2
        assert twin.mass_kg == pytest.approx(part.mass_kg, rel=1e-12)
        assert twin.center_m == pytest.approx((-x, y, z), abs=1e-12)
        assert twin.inertia_kg_m2 == pytest.approx((xx, yy, zz, -xy, -xz, yz), abs=1e-12)


@pytest.mark.parametrize("total_kg", [0.0, -72.0, 7200.0, float("nan")])
def test_an_impossible_mass_is_rejected(total_kg: float) -> None:
    """A body mass outside of 1 to 500 kg is rejected."""
    with pytest.raises(BodyError, match="1 to 500 kg"):
        body_masses(build_body(1.75), total_kg)


def test_estimates_are_listed() -> None:
    """Each split that no table gives is listed as an estimate: trunk, neck, fingers and toes."""
    listed = " ".join(ESTIMATES)
    assert all(word in listed for word in ("Middle trunk", "neck", "fingers", "toes", "shoulders"))


def test_remainder_undoes_combined() -> None:
    """Subtracting one of two combined masses gives the other."""
    a = of_shape(Capsule((0.1, 0.0, 0.2), (0.4, 0.3, 0.0), 0.05), 2.0)
    b = of_shape(Box((-0.3, 0.2, 0.1), (0.1, 0.2, 0.3)), 5.0)
    left = remainder(combined([a, b]), [b])
    assert left.mass_kg == pytest.approx(a.mass_kg)
    assert left.center_m == pytest.approx(a.center_m)
    assert left.inertia_kg_m2 == pytest.approx(a.inertia_kg_m2)


def test_inertia_about_an_axis_is_steiners() -> None:
    """Inertia about a distant axis follows Steiner's theorem: 2/5 m r^2 + m d^2.

    Here a ball of 3 kg, radius .1 m, half a metre from the axis.
    """
    ball = of_shape(Capsule((0.5, 0.0, 0.0), (0.5, 0.0, 0.0), 0.1), 3.0)
    assert ball.about_axis((0.0, 0.0, 0.0), (0.0, 1.0, 0.0)) == pytest.approx(0.012 + 0.75)
    assert ball.about_axis((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)) == pytest.approx(0.012)
