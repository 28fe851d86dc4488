"""Tests of the vectors of physics and inverse kinematics that the browser must match too."""

import re

import mujoco
import numpy as np
import pytest

from app.science.avatar.ik import GOAL_PARTS, REST_POSE_RAD, InverseKinematics
from app.science.avatar.ik.chain import Chain
from app.science.rotations import FloatArray
from tests.science.avatar.ik import bodies
from tests.science.avatar.ik.vector_files import FOLDER, Json, goals_from, make_all, read, samples

ALIKE = 1e-9
OF_OTHERS = {"edits", "followed", "limb_yield", "responses", "tried"}
CASES = [pytest.param(case, id=case["name"]) for case in read("ik")["cases"]]


@pytest.fixture(scope="module")
def model() -> mujoco.MjModel:
    """Return the model that is stored with the vectors."""
    return mujoco.MjModel.from_xml_string((FOLDER / "body.xml").read_text())


def test_the_files_are_what_the_script_makes() -> None:
    """The stored vector files equal what the script makes today; `OF_OTHERS` have their own."""
    made = make_all()
    assert {path.stem for path in FOLDER.glob("*.json")} == {*made, *OF_OTHERS}
    for name, vector in made.items():
        _assert_alike(read(name), vector)


def test_the_stored_model_has_todays_structure() -> None:
    """Today's model has the elements, attributes, bodies and axes of the stored one.

    Their numbers may differ.
    """
    assert _kind((FOLDER / "body.xml").read_text()) == _kind(bodies.mjcf())


@pytest.mark.parametrize("case", CASES)
def test_angles_are_those_of_the_vector(case: Json, model: mujoco.MjModel) -> None:
    """Every frame's goals give the vector's angles, with all other axes at rest."""
    solver = InverseKinematics(model)
    solved = [
        solver.solve(goals_from(frame, waist=case["waist"])).angles_rad
        for frame in read("ik")["frames"]
    ]
    columns = [solver.axis_names.index(name) for name in case["axes"]]
    found = np.array(solved)
    assert _apart(found[:, columns], case["angles_rad"]) <= ALIKE
    others = [at for at in range(len(solver.axis_names)) if at not in columns]
    at_rest = [REST_POSE_RAD.get(solver.axis_names[at], 0.0) for at in others]
    assert _apart(found[:, others], [at_rest] * len(found)) == 0.0


def test_the_cases_contain_unreachable_and_untracked_goals() -> None:
    """In some frames of the vectors one hand is out of reach, and in others one is not tracked."""
    for case in read("ik")["cases"]:
        errors = np.array(case["position_errors_m"], dtype=np.float64)
        left, right = (errors[:, GOAL_PARTS.index(f"{side}Hand")] for side in ("Left", "Right"))
        assert np.sum(left > 0.2) >= 10
        assert np.sum(np.isnan(right)) == 10


def test_hands_press_against_the_wall(model: mujoco.MjModel) -> None:
    """Contacts matter to the trajectory: it differs if the front wall does not collide."""
    vector = read("trajectory")
    touching = [sample["ncon"] for sample in vector["samples"]]
    assert sum(count > 0 for count in touching) >= 30
    wall = model.geom("front").id
    solid = model.geom_conaffinity[wall]
    model.geom_conaffinity[wall] = 0
    through = samples(model, vector)
    model.geom_conaffinity[wall] = solid
    assert _apart([s["qpos"] for s in through], [s["qpos"] for s in vector["samples"]]) > 0.05


def test_the_chain_of_the_vectors_model_moves_41_axes(model: mujoco.MjModel) -> None:
    """The vectors' model moves 41 axes.

    Nine of the spine, six of neck and head, eight of each arm, five of each leg.
    """
    assert len(Chain(model).moving) == 9 + 6 + 2 * 8 + 2 * 5


def _kind(mjcf: str) -> list[str]:
    """Return the text of an MJCF without its numbers."""
    return re.sub(r"-?\d+(\.\d+)?(e-?\d+)?( -?\d+(\.\d+)?(e-?\d+)?)*(?=\")", "#", mjcf).splitlines()


def _apart(found: object, expected: object) -> float:
    values: list[FloatArray] = [np.array(one, dtype=np.float64) for one in (found, expected)]
    return float(np.max(np.abs(values[0] - values[1])))


def _assert_alike(found: object, expected: object, path: str = "") -> None:
    """Assert that two JSON values are equal up to the last digits of their numbers."""
    if isinstance(expected, dict) and isinstance(found, dict):
        assert found.keys() == expected.keys(), path
        for key in expected:
            _assert_alike(found[key], expected[key], f"{path}.{key}")
    elif isinstance(expected, list) and isinstance(found, list):
        assert len(found) == len(expected), path
        for index, (one, other) in enumerate(zip(found, expected, strict=True)):
            _assert_alike(one, other, f"{path}[{index}]")
    elif isinstance(expected, float) and isinstance(found, float):
        assert found == pytest.approx(expected, abs=ALIKE, rel=0.0), path
    else:
        assert found == expected, path
