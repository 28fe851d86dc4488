"""Tests of properties of the inverse kinematics that hold for all goals."""

import mujoco
import numpy as np
import pytest
from scipy.optimize import least_squares

from app.science.avatar.ik import (
    GOAL_PARTS,
    Goals,
    IkError,
    InverseKinematics,
    Solution,
    Weights,
    goals_of,
)
from app.science.avatar.ik.chain import Chain
from app.science.avatar.ik.solver import rotation_between
from app.science.rotations import FloatArray, geodesic_angle
from tests.science.avatar.ik import bodies

HIPS_M = np.array((0.2, 0.93, -0.4))
HIPS = bodies.turned_hips(0.7)
LEFT_HAND = GOAL_PARTS.index("LeftHand")


@pytest.fixture
def chain() -> Chain:
    """Return the kinematic chain of the avatar."""
    return Chain(bodies.model())


def settled(solver: InverseKinematics, goals: Goals, frames: int = 60) -> Solution:
    """Return the solution after solving for the same goals in many frames."""
    for _ in range(frames - 1):
        solver.solve(goals)
    return solver.solve(goals)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("waist", [True, False])
def test_a_pose_that_can_be_reached_is_reached(chain: Chain, seed: int, *, waist: bool) -> None:
    """Reachable goals are met within 2 mm and half a degree, which the rest pose's pull causes."""
    pose = bodies.random_pose(chain, np.random.default_rng(seed))
    goals = bodies.reached(chain, pose, HIPS_M, HIPS, waist=waist)
    solution = settled(InverseKinematics(bodies.model()), goals)
    assert float(np.nanmax(solution.position_errors_m)) < 0.002
    assert float(np.nanmax(solution.rotation_errors_rad)) < np.radians(0.5)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("waist", [True, False])
def test_without_a_rest_pose_the_error_vanishes(chain: Chain, seed: int, *, waist: bool) -> None:
    """With a negligible rest-pose weight the goal errors vanish."""
    pose = bodies.random_pose(chain, np.random.default_rng(seed))
    goals = bodies.reached(chain, pose, HIPS_M, HIPS, waist=waist)
    free = InverseKinematics(bodies.model(), weights=Weights(rest=1e-4))
    solution = settled(free, goals, 200)
    assert float(np.nanmax(solution.position_errors_m)) < 1e-6
    assert float(np.nanmax(solution.rotation_errors_rad)) < 1e-6


def test_the_rest_pose_itself_is_found_exactly(chain: Chain) -> None:
    """Goals of the rest pose give exactly the rest pose's angles."""
    rest = InverseKinematics(bodies.model())
    pose = rest.solve(goals_of({})).angles_rad
    found = settled(rest, bodies.reached(chain, pose, HIPS_M, HIPS))
    np.testing.assert_allclose(found.angles_rad, pose, atol=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_an_independent_optimiser_finds_nothing_better(chain: Chain, seed: int) -> None:
    """SciPy's trust-region solver cannot improve our solution under the same cost and limits."""
    pose = bodies.random_pose(chain, np.random.default_rng(seed))
    goals = bodies.reached(chain, pose, HIPS_M, HIPS)
    solution = settled(InverseKinematics(bodies.model()), goals, 200)
    at, start = chain.moving, solution.angles_rad[chain.moving]
    low, high = chain.low_rad[at], chain.high_rad[at]
    rest = InverseKinematics(bodies.model()).solve(goals_of({})).angles_rad[at]

    def residuals(angles: FloatArray) -> FloatArray:
        whole = solution.angles_rad.copy()
        whole[at] = angles
        chain.place(HIPS_M, HIPS, whole)
        return np.concatenate([*_errors(chain, goals), 0.1 * (angles - rest)])

    inside = np.clip(start, low + 1e-9, high - 1e-9)
    best = least_squares(residuals, inside, bounds=(low, high), xtol=1e-12, ftol=1e-12, gtol=1e-12)
    ours = 0.5 * float(np.sum(residuals(start) ** 2))
    assert ours <= best.cost * (1.0 + 1e-3)
    assert float(np.max(np.abs(best.x - start))) < np.radians(0.1)


def test_angles_stay_within_their_limits(chain: Chain) -> None:
    """No goals, even behind the back or inside the trunk, make an angle exceed its limits."""
    rng = np.random.default_rng(11)
    solver = InverseKinematics(bodies.model())
    for _ in range(60):
        goals = _anywhere(rng)
        solution = solver.solve(goals)
        assert (solution.angles_rad >= chain.low_rad).all()
        assert (solution.angles_rad <= chain.high_rad).all()
        assert np.isfinite(solution.angles_rad).all()
        assert np.isfinite(solution.position_errors_m).all()


def test_a_goal_out_of_reach_is_pointed_at(chain: Chain) -> None:
    """An arm whose goal is a metre too far stretches towards it and rests there."""
    solver = InverseKinematics(bodies.model())
    rest = bodies.reached(chain, solver.solve(goals_of({})).angles_rad, HIPS_M, bodies.UPRIGHT)
    shoulder = chain.data.body("LeftUpperArm").xpos.copy()
    positions = rest.positions_m.copy()
    positions[LEFT_HAND] = shoulder + np.array((-1.4, 0.3, -0.9))
    goals = Goals(positions, rest.rotations, rest.tracked)
    before = settled(solver, goals, 400)
    after = solver.solve(goals)
    assert np.degrees(np.max(np.abs(after.angles_rad - before.angles_rad))) < 0.05
    chain.place(after.hips_position_m, after.hips_rotation, after.angles_rad)
    joints = [chain.data.body(f"Left{part}").xpos for part in ("UpperArm", "LowerArm", "Hand")]
    upper, lower, reach = (
        joints[1] - joints[0], joints[2] - joints[1], positions[LEFT_HAND] - joints[0],
    )  # fmt: skip
    assert _angle_deg(upper, lower) < 15.0
    assert _angle_deg(joints[2] - joints[0], reach) < 10.0


@pytest.mark.parametrize("waist", [True, False])
def test_goals_that_move_smoothly_give_angles_that_do(chain: Chain, *, waist: bool) -> None:
    """Smoothly moving goals at 90 Hz move no axis three times as fast as the pose's own axes."""
    rng = np.random.default_rng(3)
    first, last = bodies.random_pose(chain, rng), bodies.random_pose(chain, rng)
    poses = [first + bodies.smooth(i / 90.0) * (last - first) for i in range(91)]
    solver = InverseKinematics(bodies.model())
    settled(solver, bodies.reached(chain, first, HIPS_M, HIPS, waist=waist))
    found = [
        solver.solve(bodies.reached(chain, pose, HIPS_M, HIPS, waist=waist)).angles_rad
        for pose in poses
    ]
    fastest = float(np.max(np.abs(np.diff(poses, axis=0))))
    assert float(np.max(np.abs(np.diff(found, axis=0)))) < 3.0 * fastest


def test_the_same_goals_give_the_same_angles() -> None:
    """After a reset the same goals give the same angles, whatever came before."""
    rng = np.random.default_rng(4)
    goals = [_anywhere(rng) for _ in range(5)]
    solver = InverseKinematics(bodies.model())
    first = [solver.solve(one).angles_rad for one in goals]
    solver.reset()
    np.testing.assert_array_equal(first, [solver.solve(one).angles_rad for one in goals])


def test_a_limb_whose_tracker_is_lost_is_held(chain: Chain) -> None:
    """An arm keeps its angles while its hand is not tracked; the other arm follows."""
    rng = np.random.default_rng(5)
    one, two = (bodies.random_pose(chain, rng) for _ in range(2))
    solver = InverseKinematics(bodies.model())
    before = settled(solver, bodies.reached(chain, one, HIPS_M, HIPS))
    goals = bodies.reached(chain, two, HIPS_M, HIPS)
    goals.tracked[LEFT_HAND] = False
    after = settled(solver, goals)
    moved = np.abs(after.angles_rad - before.angles_rad)
    for side, least, most in (("Left", 0.0, 0.0), ("Right", 0.05, np.inf)):
        arm = [
            at for at, name in enumerate(solver.axis_names) if name.startswith(f"{side}LowerArm")
        ]
        assert least <= float(np.max(moved[arm])) <= most
    assert np.isnan(after.position_errors_m[LEFT_HAND])


def test_hips_without_waist_and_head_trackers_stay(chain: Chain) -> None:
    """Without waist and head trackers the hips stay where they were."""
    pose = bodies.random_pose(chain, np.random.default_rng(6))
    solver = InverseKinematics(bodies.model())
    goals = bodies.reached(chain, pose, HIPS_M, HIPS)
    before = settled(solver, goals)
    goals.tracked[:2] = False
    after = settled(solver, goals)
    np.testing.assert_array_equal(after.hips_position_m, before.hips_position_m)


@pytest.mark.parametrize("seed", range(4))
def test_welded_hips_make_no_difference(seed: int) -> None:
    """The same goals give the same angles with welded hips and with carried hips."""
    found = []
    for welded in (False, True):
        model = bodies.model(welded=welded)
        pose = bodies.random_pose(Chain(model), np.random.default_rng(seed))
        goals = bodies.reached(Chain(model), pose, HIPS_M, HIPS, waist=seed % 2 == 0)
        found.append(settled(InverseKinematics(model), goals).angles_rad)
    np.testing.assert_allclose(found[0], found[1], atol=1e-9)


def test_turning_the_room_turns_only_the_hips(chain: Chain) -> None:
    """The angles do not depend on the person's position or facing in the room."""
    pose = bodies.random_pose(chain, np.random.default_rng(8))
    found = []
    for hips_m, yaw in ((HIPS_M, 0.0), (HIPS_M + np.array((3.0, 0.0, -2.0)), 2.5)):
        goals = bodies.reached(chain, pose, hips_m, bodies.turned_hips(yaw), waist=False)
        found.append(settled(InverseKinematics(bodies.model()), goals, 200))
    np.testing.assert_allclose(found[0].angles_rad, found[1].angles_rad, atol=1e-6)
    turn = geodesic_angle(found[1].hips_rotation, found[0].hips_rotation)
    assert float(turn) == pytest.approx(2.5, abs=1e-6)


def test_invalid_goals_and_models_are_rejected() -> None:
    """Errors about invalid goals and models name the part and what is wrong with it."""
    upright = (1.0, 0.0, 0.0, 0.0)
    with pytest.raises(IkError, match="'Tail' is not a tracked part"):
        goals_of({"Tail": ((0.0, 0.0, 0.0), upright)})
    with pytest.raises(IkError, match="Head lies at"):
        goals_of({"Head": ((0.0, float("nan"), 0.0), upright)})
    with pytest.raises(IkError, match="not a unit quaternion"):
        goals_of({"Head": ((0.0, 1.6, 0.0), (0.0, 0.0, 0.0, 0.0))})
    with pytest.raises(IkError, match="position of 3"):
        goals_of({"Head": ((0.0, 1.6), upright)})
    with pytest.raises(IkError, match="no axis 'LeftKnee'"):
        InverseKinematics(bodies.model(), rest_rad={"LeftKnee": 0.4})
    ball = "<mujoco><worldbody><body name='Hips'><geom size='1'/></body></worldbody></mujoco>"
    with pytest.raises(IkError, match="The model has no Head"):
        InverseKinematics(mujoco.MjModel.from_xml_string(ball))
    fixed = bodies.mjcf().replace('name="Hips" mocap="true"', 'name="Hips"')
    with pytest.raises(IkError, match="Hips are fixed"):
        InverseKinematics(mujoco.MjModel.from_xml_string(fixed))


def _errors(chain: Chain, goals: Goals) -> list[FloatArray]:
    found: list[FloatArray] = []
    for row in range(1, len(GOAL_PARTS)):
        w, x, y, z = chain.rotation(row).tolist()
        gw, gx, gy, gz = goals.rotations[row].tolist()
        found.append(10.0 * (goals.positions_m[row] - chain.position_m(row)))
        found.append(np.array(rotation_between((w, x, y, z), (gw, gx, gy, gz))))
    return found


def _anywhere(rng: np.random.Generator) -> Goals:
    count = len(GOAL_PARTS)
    rotations = rng.normal(size=(count, 4))
    rotations /= np.linalg.norm(rotations, axis=1, keepdims=True)
    positions = rng.uniform((-1.0, 0.0, -1.0), (1.0, 2.0, 1.0), (count, 3))
    return Goals(positions, rotations, np.ones(count, dtype=np.bool_))


def _angle_deg(a: FloatArray, b: FloatArray) -> float:
    cosine = float(a @ b / np.sqrt((a @ a) * (b @ b)))
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
