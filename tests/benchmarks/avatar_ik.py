"""Measure the avatar's inverse kinematics: time per frame, and error of its end effectors.

`python` and `javascript` time the same frames, those of `tests/vectors/avatar/ik.json` forwards and
backwards: a quickly moving body with a hand out of reach for some frames, with and without a waist
tracker. The limit is a millisecond in the median, a tenth of a headset's frame. `captures` follows
real people if the shared data are available and measures the remaining errors of the goals at 90
Hz, and the distance from the untracked parts of the person: the places of the elbows, and the
rotations of the joints between the tracked parts (geodesic angle of each to its parent, mean).
"""

import json
import time
from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np

from app.science.avatar.body import PARENT_OF
from app.science.avatar.ik import GOAL_PARTS, Chain, Goals, InverseKinematics
from app.science.rotations import FloatArray, conjugate, geodesic_angle, multiply
from app.science.skeleton import (
    JOINT_INDEX,
    JOINT_NAMES,
    build_skeleton,
    forward_kinematics,
    resample,
)
from app.simulated_people.body import captured_movement
from tests.benchmarks.report import Figure, Report
from tests.science.avatar.ik import bodies
from tests.science.avatar.ik.vector_files import FOLDER, goals_from, read
from tests.support.node import install_packages, run_node
from tests.support.shared_data import shared_data_folder

PARTS = ("python", "javascript", "captures")
ROUNDS = 15
LIMIT_MS = 1.0
RATE_HZ, LONGEST = 90.0, 900
REPOSITORY = Path(__file__).resolve().parents[2]
JOINTS = tuple(
    name
    for name in JOINT_NAMES
    if name != "Hips" and not name.endswith(("Shoulder", "Foot", "Toes"))
)
CLIPS = {
    "walk": "cmu_bvh/02_01.bvh",
    "dance": "cmu_bvh/05_06.bvh",
    "tai chi": "cmu_bvh/12_02.bvh",
    "reaching": "vicon_tracker/ObjectInspection_0.csv",
}


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts; their duration cannot be chosen."""
    report = Report("avatar_ik")
    if "python" in parts:
        for name, times_us in _python().items():
            report.add(*_figures("python", name, times_us))
    if "javascript" in parts:
        for name, times_us in _javascript().items():
            report.add(*_figures("javascript", name, times_us))
    if "captures" in parts:
        for name, path in _clips():
            for waist in (True, False):
                report.add(*_followed(name, path, waist=waist))
    return report


def _figures(part: str, name: str, times_us: FloatArray) -> Iterator[Figure]:
    p50, p99 = (float(np.percentile(times_us, percent)) / 1e3 for percent in (50.0, 99.0))
    yield Figure(part, f"frame {name}, p50", p50, "ms", "at most", LIMIT_MS)
    yield Figure(part, f"frame {name}, p99", p99, "ms")


def _python() -> dict[str, FloatArray]:
    vector, found = read("ik"), {}
    model = mujoco.MjModel.from_xml_string((FOLDER / "body.xml").read_text())
    for case in vector["cases"]:
        goals = [goals_from(frame, waist=case["waist"]) for frame in vector["frames"]]
        solver, times_us = InverseKinematics(model), []
        for _ in range(ROUNDS):
            for goal in (*goals, *reversed(goals)):
                began_ns = time.perf_counter_ns()
                solver.solve(goal)
                times_us.append((time.perf_counter_ns() - began_ns) / 1e3)
        found[case["name"]] = np.array(times_us)
    return found


def _javascript() -> dict[str, FloatArray]:
    frontend = REPOSITORY / "frontend"
    install_packages(frontend)
    script = Path(__file__).with_suffix(".mjs")
    said = run_node(str(script), str(frontend), str(FOLDER), str(ROUNDS), cwd=frontend)
    return {name: np.array(times) for name, times in json.loads(said).items()}


def _clips() -> Iterator[tuple[str, Path]]:
    folder = shared_data_folder() / "motion"
    return ((name, folder / file) for name, file in CLIPS.items() if (folder / file).is_file())


def _followed(name: str, path: Path, *, waist: bool) -> Iterator[Figure]:
    skeleton = build_skeleton(bodies.STATURE_M)
    movement = resample(captured_movement(path, skeleton), RATE_HZ)
    world = forward_kinematics(skeleton, movement.root_positions_m, movement.rotations)
    rows = [JOINT_INDEX[part] for part in GOAL_PARTS]
    elbows = [JOINT_INDEX[f"{side}LowerArm"] for side in ("Left", "Right")]
    tracked = np.ones(len(rows), dtype=np.bool_)
    tracked[0] = waist
    model = bodies.model()
    solver, chain = InverseKinematics(model), Chain(model)
    errors = []
    for frame in range(min(movement.frame_count, LONGEST)):
        goals = Goals(world.positions_m[frame, rows], world.rotations[frame, rows], tracked)
        solved = solver.solve(goals)
        chain.place(solved.hips_position_m, solved.hips_rotation, solved.angles_rad)
        places = [chain.data.body(f"{side}LowerArm").xpos for side in ("Left", "Right")]
        off = np.linalg.norm(np.array(places) - world.positions_m[frame, elbows], axis=1)
        hips = float(np.linalg.norm(solved.hips_position_m - world.positions_m[frame, 0]))
        goal_errors = solved.position_errors_m[1:], solved.rotation_errors_rad[1:]
        turn = _joint_error_rad(chain, movement.rotations[frame])
        errors.append((*(float(np.mean(e)) for e in (*goal_errors, off)), turn, hips))
    told = f"{name}, {'with' if waist else 'without'} a waist tracker"
    settled = np.array(errors)[round(RATE_HZ / 2) :]
    position, rotation, elbow, turns, hips_off = np.mean(settled, axis=0).tolist()
    yield Figure("captures", f"{told}: goals, mean", 1e3 * position, "mm")
    yield Figure("captures", f"{told}: goals, p95 of frames",
                 1e3 * float(np.percentile(settled[:, 0], 95.0)), "mm")  # fmt: skip
    yield Figure("captures", f"{told}: goals, mean turn", float(np.degrees(rotation)), "deg")
    yield Figure("captures", f"{told}: elbows, mean", 1e3 * elbow, "mm")
    yield Figure("captures", f"{told}: joints, mean turn", float(np.degrees(turns)), "deg")
    if not waist:
        yield Figure("captures", f"{told}: hips, mean", 1e3 * hips_off, "mm")


def _joint_error_rad(chain: Chain, person: FloatArray) -> float:
    """Return the mean angle of the joints from the person's, (22, 4) parent_from_joint."""
    data = chain.data
    above = [data.body(PARENT_OF[name]).xquat for name in JOINTS]
    local = multiply(conjugate(np.array(above)), np.array([data.body(n).xquat for n in JOINTS]))
    return float(np.mean(geodesic_angle(local, person[[JOINT_INDEX[n] for n in JOINTS]])))
