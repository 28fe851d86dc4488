"""Tests of bodies built from a humanoid model: its joints and lengths, a person's masses."""

from dataclasses import replace
from math import dist
from typing import Any

import numpy as np
import pytest

from app.adapters.humanoids import read_humanoid
from app.science.avatar.body.body import BodyError, build_body
from app.science.avatar.body.figure import figure_of
from app.science.avatar.body.masses import body_masses
from app.science.avatar.body.parts import AXES_OF, FINGER_PARTS, PART_NAMES
from app.science.avatar.body.proportions import segment_lengths
from app.science.avatar.body.shapes import Capsule
from app.science.avatar.mjcf.hinges import hinges_of
from app.science.avatar.mjcf.model import avatar_model
from tests.science.avatar.bodies import loaded
from tests.science.avatar.configurations import whole_body
from tests.science.avatar.figures import HASH, STATURE_M, figure, model
from tests.support import humanoid_model
from tests.support.humanoid_files import humanoid_file
from tests.support.humanoid_model import Model, places

SCALE = STATURE_M / humanoid_model.STATURE_M
LACKING = [(), ("Little",), ("Little", "Ring"), ("Toes", "UpperChest", "Neck", "Shoulder")]


@pytest.mark.parametrize("lacking", LACKING)
def test_joints_lie_where_the_model_has_them(lacking: tuple[str, ...]) -> None:
    """Joints lie where the model has them, scaled to the person, in the body and the simulation."""
    own = figure(*lacking)
    body = build_body(STATURE_M, figure=own)
    assert set(body.parts) == set(own.places_m)
    _, data = loaded(model(own=own).mjcf)
    expected, hips = places(), places()["Hips"]
    for part, place in body.places_m().items():
        scaled_m = SCALE * (expected[part] - np.array((hips[0], 0.0, hips[2])))
        assert place == pytest.approx(scaled_m.tolist(), abs=2e-6)
        assert data.body(part).xpos == pytest.approx(scaled_m, abs=2e-6)


def test_lengths_are_the_models_own() -> None:
    """Segments keep the model's own proportions, here short arms, scaled to the person."""
    own = figure()
    usual = segment_lengths(humanoid_model.STATURE_M)
    assert own.segments_m["upper_arm"] == pytest.approx(0.93 * usual["upper_arm"], abs=1e-5)
    assert own.segments_m["thigh"] == pytest.approx(usual["thigh"], abs=1e-5)
    body = build_body(STATURE_M, figure=own)
    arm = body.proportions.segments_m["forearm"]
    assert arm == pytest.approx(0.93 * SCALE * usual["forearm"], abs=1e-5)


def test_arms_take_on_measured_lengths() -> None:
    """Bones and pieces of the arms are stretched along themselves; all else keeps its size."""
    own = figure().scaled(STATURE_M)
    lengths_m = {"upper_arm": 0.27, "forearm": 0.23}
    fitted = own.with_arms(lengths_m)
    body = build_body(STATURE_M, figure=fitted)
    places_m = body.places_m()
    for side in ("Left", "Right"):
        shoulder, elbow, wrist = (f"{side}{one}" for one in ("UpperArm", "LowerArm", "Hand"))
        assert dist(places_m[shoulder], places_m[elbow]) == pytest.approx(0.27, abs=1e-9)
        assert dist(places_m[elbow], places_m[wrist]) == pytest.approx(0.23, abs=1e-9)
        assert fitted.places_m[shoulder] == own.places_m[shoulder]
        for bone, end, name in (
            (shoulder, elbow, "upper_arm"),
            (elbow, wrist, "forearm"),
        ):
            ratio = lengths_m[name] / dist(own.places_m[bone], own.places_m[end])
            before, after = (np.array(one.pieces[bone].corners_m) for one in (own, fitted))
            assert np.ptp(after[:, 0]) == pytest.approx(ratio * np.ptp(before[:, 0]), rel=0.01)
            assert np.ptp(after[:, 1]) == pytest.approx(np.ptp(before[:, 1]), rel=0.01)
        assert fitted.pieces[wrist] == own.pieces[wrist]
        tip = f"{side}MiddleDistal"
        assert np.subtract(fitted.places_m[tip], fitted.places_m[wrist]) == pytest.approx(
            np.subtract(own.places_m[tip], own.places_m[wrist]), abs=1e-9
        )
    for part in ("Head", "LeftFoot", "RightShoulder"):
        assert fitted.places_m[part] == own.places_m[part]
    assert body.proportions.segments_m["upper_arm"] == 0.27


def test_shapes_reach_from_joint_to_joint() -> None:
    """Limb and finger shapes span the model's own joints, and the soles lie on the floor."""
    body = build_body(STATURE_M, figure=figure())
    places_m = body.places_m()
    for part, after in (
        ("LeftUpperArm", "LeftLowerArm"),
        ("RightLowerLeg", "RightFoot"),
        ("LeftThumbProximal", "LeftThumbIntermediate"),
    ):
        shape = body.parts[part].shapes[0]
        assert isinstance(shape, Capsule)
        assert shape.length_m == pytest.approx(dist(places_m[part], places_m[after]), rel=1e-9)
    geoms, data = loaded(model().mjcf)
    for part in ("LeftFoot", "RightToes"):
        geom = geoms.geom(f"{part}/0")
        assert data.geom(f"{part}/0").xpos[1] - geom.size[1] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("lacking", LACKING)
def test_masses_are_a_persons(lacking: tuple[str, ...]) -> None:
    """The part masses add up to the person's mass, and every hinge has a positive inertia."""
    body = build_body(STATURE_M, figure=figure(*lacking))
    masses = body_masses(body, 72.0)
    assert masses.total_kg == pytest.approx(72.0)
    assert min(hinge.inertia_kg_m2 for hinge in hinges_of(body, masses).values()) > 0.0
    plain = body_masses(build_body(STATURE_M, segments_m=dict(body.proportions.segments_m)), 72.0)
    if not lacking:
        assert masses.parts == plain.parts


def test_what_the_model_lacks_has_no_hinge() -> None:
    """A model with four fingers has no hinges for the fifth, even if the configuration does."""
    built = model(own=figure("Little"))
    found, _ = loaded(built.mjcf)
    names = {found.joint(row).name for row in range(found.njnt)}
    free = set(built.configuration.axes) - built.configuration.locked_axes
    assert names == {name for name in free if "Little" not in name}


def test_a_configuration_without_fingers_leaves_them_out() -> None:
    """A body has no fingers if the configuration has none, even if the model has them."""
    usual = whole_body()
    axes = {
        axis.name: usual.axes[axis.name]
        for part in PART_NAMES
        if part not in FINGER_PARTS
        for axis in AXES_OF[part]
    }
    built = avatar_model(replace(usual, axes=axes, humanoid=HASH), STATURE_M, figure=figure())
    assert not set(built.body.parts) & set(FINGER_PARTS)


def test_unusual_lengths_take_the_masses_of_the_nearest_plausible_length() -> None:
    """Forearms of half the usual length keep their joints, get plausible masses and add a note."""

    def shortened(document: dict[str, Any]) -> None:
        for node in document["nodes"]:
            if node.get("name") in {"LeftHand", "RightHand"}:
                node["matrix"][12:15] = [0.55 * one for one in node["matrix"][12:15]]

    own = figure_of(read_humanoid(humanoid_file(Model(edit=shortened))).humanoid)
    assert any("forearm" in note and "unusual" in note for note in own.notes)
    usual = segment_lengths(own.stature_m)["forearm"]
    assert own.segments_m["forearm"] == pytest.approx(0.7 * usual, rel=1e-3)
    body = build_body(STATURE_M, figure=own)
    apart = dist(body.places_m()["LeftHand"], body.places_m()["LeftLowerArm"])
    assert apart == pytest.approx(0.55 * 0.93 * SCALE * segment_lengths(1.7)["forearm"], rel=1e-3)


def test_a_model_and_measured_lengths_exclude_each_other() -> None:
    """A body cannot be built from both a model and measured lengths."""
    with pytest.raises(BodyError, match="either a model or measured lengths"):
        build_body(STATURE_M, figure=figure(), segments_m={"thigh": 0.43})


def test_the_model_must_be_the_one_that_the_configuration_names() -> None:
    """A model is required if the configuration names one, and rejected if it names none."""
    named = replace(whole_body(), humanoid=HASH)
    with pytest.raises(BodyError, match=HASH):
        avatar_model(named, STATURE_M)
    with pytest.raises(BodyError, match="names no model"):
        avatar_model(whole_body(), STATURE_M, figure=figure())
