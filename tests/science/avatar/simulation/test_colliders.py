"""Tests of convex pieces as colliders: at walls, next to each other, switched at run time."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.adapters.humanoids import HumanoidFileError, read_humanoid
from app.science.avatar.body.body import BodyError
from app.science.avatar.body.figure import figure_of
from app.science.avatar.body.humanoid import HumanoidError
from app.science.avatar.body.parts import AXES, PART_NAMES
from app.science.avatar.configuration.configuration import Hips
from app.science.avatar.configuration.model_options import ColliderKind
from app.science.avatar.mjcf.gains import default_configuration
from app.science.avatar.mjcf.hinge_table import SimulationError
from app.science.avatar.mjcf.model import AvatarModel, avatar_model
from app.science.avatar.mjcf.scene import Scene, SceneBox
from app.science.avatar.simulation.following import Follower
from app.science.avatar.simulation.simulation import PhysicsAvatar
from app.science.rotations import identity, normalise
from app.science.skeleton import JOINT_COUNT
from tests.science.avatar.bodies import loaded
from tests.science.avatar.figures import EMPTY, STATURE_M, figure, model
from tests.science.avatar.simulated import angles, target_angles
from tests.support.humanoid_files import humanoid_file
from tests.support.humanoid_model import Model
from tests.support.repetitions import usually

STEP_S = 0.002
WALL = Scene((SceneBox("wall", (-0.8, 1.4, -0.31), (0.5, 0.6, 0.01)),), floor=False)
ARM = ("LeftUpperArm", "LeftLowerArm", "LeftHand")


def touching(body: PhysicsAvatar) -> set[str]:
    """Return the names of the shapes that touch anything."""
    rows = body.data.contact.geom[: body.data.ncon].ravel().tolist()
    return {body.model.geom(row).name for row in rows}


def press(body: PhysicsAvatar, seconds: float = 0.8) -> set[str]:
    """Swing the left arm forward and return the shapes that touch anything at the end."""
    for _ in range(round(seconds / STEP_S)):
        body.set_targets(angles(LeftUpperArmY=1.2))
        body.step_to(body.time_s + STEP_S)
    return touching(body)


@pytest.mark.parametrize("hips", ["carried", "welded"])
def test_a_hand_of_skin_stops_at_a_wall(hips: Hips) -> None:
    """A hand with a mesh collider at 2 m/s enters a wall by at most 5 mm and never passes it."""
    body = PhysicsAvatar(model("mesh", scene=WALL, hips=hips).mjcf)
    reach_m = abs(body.data.body("LeftMiddleProximal").xpos[0]) - 0.129 * STATURE_M
    deepest_m, fastest, before_m = 0.0, 0.0, 0.0
    touched: set[str] = set()
    for step in range(1, 600):
        body.set_targets(angles(LeftUpperArmY=min(step * STEP_S * 2.2 / reach_m, 1.5)))
        body.step_to(step * STEP_S)
        touched |= touching(body)
        place_m = float(body.data.body("LeftMiddleProximal").xpos[2])
        if not touched:
            fastest = max(fastest, (before_m - place_m) / STEP_S)
        before_m = place_m
        deepest_m = max([deepest_m, *(one.penetration_m for one in body.contacts())])
        assert float(body.data.body("LeftMiddleDistal").xpos[2]) > WALL.boxes[0].center_m[2]
    assert fastest > 1.9
    assert "LeftHand/mesh" in touched
    assert not any(name.endswith("/0") for name in touched)
    assert 0.0005 < deepest_m <= 0.005


def test_colliders_are_chosen_part_by_part_while_it_runs() -> None:
    """Parts switch between simple shapes, meshes and no collider while the simulation runs."""
    body = PhysicsAvatar(model(scene=WALL, both=True).mjcf)
    assert {body.switches.collider(part) for part in body.parts} == {"simple"}
    simple = press(body)
    assert "LeftHand/0" in simple
    assert not any(name.endswith("/mesh") for name in simple)
    for part in ARM:
        body.switches.use_collider(part, "mesh")
    mixed = press(body)
    assert "LeftHand/mesh" in mixed
    assert not mixed & {f"{part}/0" for part in ARM}
    for part in body.parts:
        body.switches.use_collider(part, "mesh")
    assert all(name.endswith("/mesh") for name in press(body) - {"wall"})
    assert body.health.restored == 0
    for part in body.parts:
        body.switches.use_collider(part, "none")
    assert not press(body)


def test_a_part_that_passes_through_keeps_its_kind() -> None:
    """Switching a part's collisions off and on keeps its collider kind."""
    body = PhysicsAvatar(model("mesh", scene=WALL).mjcf)
    for part in body.parts:
        body.switches.set_collider(part, on=False)
    body.switches.use_collider("LeftHand", "simple")
    assert not press(body, 0.1)
    for part in body.parts:
        body.switches.set_collider(part, on=True)
    assert body.switches.collider("LeftHand") == "simple"
    assert body.switches.collider("LeftLowerArm") == "mesh"
    body.switches.set_self_collision(on=False)
    masks = body.model.geom_contype
    assert masks[body.model.geom("LeftHand/mesh").id] == 0
    assert masks[body.model.geom("LeftHand/0").id] == 1
    assert masks[body.model.geom("LeftLowerArm/mesh").id] == 1


@pytest.mark.parametrize("kind", ["simple", "mesh", "none"])
def test_parts_are_built_with_their_own_colliders(kind: ColliderKind) -> None:
    """A part with a collider kind of its own touches with that kind only."""
    rest: ColliderKind = "mesh" if kind != "mesh" else "simple"
    body = PhysicsAvatar(model(rest, LeftHand=kind).mjcf)
    assert body.switches.collider("LeftHand") == kind
    assert body.switches.collider("RightHand") == rest
    masks = body.model.geom_contype
    for part, chosen in (("LeftHand", kind), ("RightHand", rest)):
        assert (masks[body.model.geom(f"{part}/0").id] > 0) == (chosen == "simple")
        assert (masks[body.model.geom(f"{part}/mesh").id] > 0) == (chosen == "mesh")


def test_without_a_model_a_part_may_touch_nothing_and_be_switched_on() -> None:
    """A body without a humanoid model can start with collider `none` and switch it to `simple`."""
    usual = default_configuration()
    built = avatar_model(replace(usual, colliders="none"), STATURE_M, scene=WALL)
    body = PhysicsAvatar(built.mjcf)
    for part in ARM:
        body.switches.use_collider(part, "simple")
    assert "LeftHand/0" in press(body)


def test_pieces_need_a_model() -> None:
    """The collider `mesh` is rejected without a humanoid model, at the start and at run time."""
    for mesh in ({"colliders": "mesh"}, {"part_colliders": {"Head": "mesh"}}):
        configuration = replace(default_configuration(), **mesh)
        with pytest.raises(BodyError, match="Upload a humanoid model"):
            avatar_model(configuration, STATURE_M)
    body = PhysicsAvatar(avatar_model(default_configuration(), STATURE_M).mjcf)
    with pytest.raises(SimulationError, match="no convex piece of LeftHand"):
        body.switches.use_collider("LeftHand", "mesh")
    with pytest.raises(SimulationError, match="LeftWing"):
        body.switches.use_collider("LeftWing", "simple")


def test_a_part_without_skin_keeps_its_simple_shapes() -> None:
    """A part without a mesh is listed as a fallback and touches with its simple shapes."""
    whole = figure()
    pieces = {part: one for part, one in whole.pieces.items() if part != "LeftHand"}
    built = model("mesh", own=replace(whole, pieces=pieces), scene=WALL)
    assert built.fallback_parts == ("LeftHand",)
    body = PhysicsAvatar(built.mjcf)
    assert body.switches.collider("LeftHand") == "simple"
    assert body.model.geom_contype[body.model.geom("LeftHand/0").id] > 0


def test_a_model_is_the_same_to_the_byte() -> None:
    """The MJCF of an avatar with meshes is deterministic, to the byte."""
    assert model("mesh").mjcf == model("mesh").mjcf
    assert model("mesh").mjcf != model().mjcf


def test_pieces_change_no_mass_and_no_hinge() -> None:
    """Mesh colliders change neither masses nor inertias nor hinge armatures."""
    plain, _ = loaded(model().mjcf)
    skin, _ = loaded(model("mesh").mjcf)
    assert np.array_equal(plain.body_mass, skin.body_mass)
    assert np.array_equal(plain.body_inertia, skin.body_inertia)
    assert np.array_equal(plain.dof_armature, skin.dof_armature)


def followed(built: AvatarModel) -> PhysicsAvatar:
    """Let an avatar follow two seconds of a made-up movement and return it."""
    body = PhysicsAvatar(built.mjcf)
    follower = Follower(body, target_angles(built))
    hips = np.array((0.0, built.body.places_m()["Hips"][1], 0.0))
    rest = np.tile(identity(), (JOINT_COUNT, 1))
    follower.start(hips, rest)
    for frame in range(1, 181):
        sway = 0.3 * np.sin(frame / 20 + np.arange(JOINT_COUNT))
        turns = normalise(np.stack((np.ones(JOINT_COUNT), sway, 0.3 * sway, -0.5 * sway), axis=1))
        turns[0] = identity()
        state = follower.frame(frame / 90.0, hips, turns).state
        assert np.isfinite(state.rotations).all()
    return body


@pytest.mark.parametrize("lacking", [("Little",), ("Little", "Ring"), ("Toes", "UpperChest")])
@pytest.mark.parametrize("kind", ["simple", "mesh"])
def test_models_that_lack_parts_follow(lacking: tuple[str, ...], kind: ColliderKind) -> None:
    """Models without some fingers or toes follow a movement without NaN and without a reset."""
    body = followed(model(kind, own=figure(*lacking), scene=Scene()))
    assert body.health.restored == 0
    assert body.time_s == pytest.approx(2.0)


@settings(max_examples=usually(8, at_length=25), deadline=None, derandomize=True)
@given(st.integers(0, 10_000))
def test_odd_bodies_stand(seed: int) -> None:
    """Bodies with bones of half to one and a half times the length are rejected or stay stable.

    One side of the body has simple shapes and the other meshes.
    """
    rng = np.random.default_rng(seed)

    def stretched(document: dict[str, Any]) -> None:
        by = dict(zip(PART_NAMES, rng.uniform(0.5, 1.5, len(PART_NAMES)), strict=True))
        for node in document["nodes"]:
            if node.get("name") in by:
                factor = by[node["name"].replace("Right", "Left")]
                node["matrix"][12:15] = [factor * one for one in node["matrix"][12:15]]

    try:
        own = figure_of(read_humanoid(humanoid_file(Model(edit=stretched))).humanoid)
    except (HumanoidFileError, HumanoidError):
        return
    body = PhysicsAvatar(model(own=own, scene=Scene(), both=True).mjcf)
    for part in PART_NAMES:
        body.switches.use_collider(part, "mesh" if part.startswith("Right") else "simple")
    for frame in range(1, 46):
        body.set_targets(np.full(len(AXES), 0.2 * np.sin(frame / 10)))
        body.step_to(frame / 90.0)
    assert np.isfinite(body.data.qpos).all()
    assert body.health.restored == 0


def test_random_poses_never_explode() -> None:
    """200 random poses and 20 teleports among meshes and walls cause no failure or reset."""
    rng = np.random.default_rng(8)
    body = PhysicsAvatar(model("mesh", scene=replace(WALL, floor=True)).mjcf)
    for frame in range(1, 201):
        if frame % 10 == 0:
            place = rng.uniform((-1.0, 0.5, -1.0), (1.0, 1.5, 1.0))
            body.set_hips(place, normalise(rng.normal(size=4)))
        body.set_targets(rng.uniform(-np.pi, np.pi, len(AXES)))
        body.step_to(frame / 90.0)
        assert np.isfinite(body.data.qpos).all()
    assert body.health.restored == 0
    assert body.time_s == pytest.approx(200 / 90.0, abs=STEP_S)


def test_a_body_without_a_humanoid_model_has_no_meshes() -> None:
    """A body without a humanoid model has no meshes and default contact detection."""
    text = avatar_model(default_configuration(), STATURE_M, scene=EMPTY).mjcf
    assert "mesh" not in text
    assert "midphase" not in text
