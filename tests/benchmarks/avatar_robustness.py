"""Test that the avatar withstands extreme input, and that the browser computes the same.

`wall` drives a hand at 2 m/s into a wall of 2 cm and continues to press: it may penetrate by 5 mm,
and never comes out on the other side. `thrown` commands 10,000 random poses and teleports the hips
1,000 times by up to 10 m, next to walls: no reset may occur, and the clock must be exact. `browser`
gives the model and the inputs of `tests/vectors/avatar` to MuJoCo in Python and, as WebAssembly,
under Node: the greatest difference of any angle over 10 s with contacts, and of the inverse
kinematics, both 1e-9 at most. Both sides are recomputed in each run and compared unrounded.
"""

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import mujoco
import numpy as np

from app.science.avatar.configuration import Hips
from app.science.avatar.ik import InverseKinematics
from tests.benchmarks.report import Figure, Report
from tests.science.avatar.captured import RATE_HZ
from tests.science.avatar.ik.vector_files import FOLDER, goals_from, read, simulate
from tests.science.avatar.stress import (
    STEP_S,
    WALL_FACE_M,
    run_random_poses,
    swing_into_a_wall,
)
from tests.support.node import install_packages, run_node

PARTS = ("wall", "thrown", "browser")
DEEPEST_MM, ALIKE = 5.0, 1e-9
JUMPS, EVERY = 10_000, 10
REPOSITORY = Path(__file__).resolve().parents[2]


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts; their duration cannot be chosen."""
    report = Report("avatar_robustness")
    if "wall" in parts:
        report.add(*_wall())
    if "thrown" in parts:
        for hips in get_args(Hips):
            report.add(*_thrown(hips))
    if "browser" in parts:
        report.add(*_browser())
    return report


def _wall() -> Iterator[Figure]:
    found = swing_into_a_wall()
    yield Figure("wall", "speed of the hand before the wall", found.speed_m_s, "m/s")
    yield Figure("wall", "deepest in it", 1e3 * found.deepest_m, "mm", "at most", DEEPEST_MM)
    left_mm = 1e3 * (found.farthest_m - WALL_FACE_M)
    yield Figure("wall", "the hand's middle from the wall's, least", left_mm, "mm", "at least", 0.0)


def _thrown(hips: Hips) -> Iterator[Figure]:
    thrown = run_random_poses(hips, JUMPS, EVERY)
    body, health = thrown.body, thrown.body.health
    told = f"hips {hips}"
    yield Figure("thrown", f"{told}: random poses", JUMPS, "poses")
    yield Figure("thrown", f"{told}: teleports", health.teleports, "teleports")
    yield Figure("thrown", f"{told}: put back after a failure", health.restored, "times")
    never = 0.0 if thrown.always_finite else 1.0
    yield Figure("thrown", f"{told}: angles that were not finite", never, "times")
    clock_s = abs(body.data.time - round(JUMPS / RATE_HZ / STEP_S) * STEP_S)
    yield Figure("thrown", f"{told}: clock off by", 1e6 * clock_s, "us", "at most", 1.0)


def _browser() -> Iterator[Figure]:
    frontend = REPOSITORY / "frontend"
    install_packages(frontend)
    script = Path(__file__).with_name("avatar_wasm.mjs")
    theirs = json.loads(run_node(str(script), str(frontend), str(FOLDER), cwd=frontend))
    model = mujoco.MjModel.from_xml_string((FOLDER / "body.xml").read_text())
    samples, vector = simulate(model, read("trajectory")), read("ik")
    touching = max(ncon for ncon, _ in samples)
    gap = max(
        _apart(qpos, other["qpos"])
        for (_, qpos), other in zip(samples, theirs["samples"], strict=True)
    )
    told = f"{len(samples) * read('trajectory')['sample_s']:g} s, up to {touching} contact points"
    yield Figure("browser", f"angles, {told}", gap, "rad", "at most", ALIKE)
    same = [
        ncon == other["ncon"] for (ncon, _), other in zip(samples, theirs["samples"], strict=True)
    ]
    yield Figure("browser", "samples with other contact points", same.count(False), "samples")
    for case, other in zip(vector["cases"], theirs["cases"], strict=True):
        gap = _solved_apart(model, vector, case, other)
        yield Figure("browser", f"kinematics {case['name']}", gap, "rad or m", "at most", ALIKE)


def _solved_apart(
    model: mujoco.MjModel, vector: dict[str, Any], case: dict[str, Any], other: dict[str, Any]
) -> float:
    solver, gaps = InverseKinematics(model), [0.0]
    for row, frame in enumerate(vector["frames"]):
        solved = solver.solve(goals_from(frame, waist=case["waist"]))
        for ours, name in (
            (solved.angles_rad, "angles_rad"),
            (solved.hips_position_m, "hips_m"),
            (solved.hips_rotation, "hips"),
        ):
            gaps.append(_apart(ours, other[name][row]))
    return max(gaps)


def _apart(ours: Any, theirs: list[float]) -> float:
    gap = float(np.max(np.abs(np.asarray(ours) - np.array(theirs))))
    # A maximum would ignore NaN.
    return math.inf if math.isnan(gap) else gap
