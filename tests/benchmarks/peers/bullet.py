"""Measure PyBullet, a common engine for simulating bodies, as a peer.

PyBullet gets the body of `bullet_body`, the same inputs and the same boxes, in steps of the same
length. The numbers of driven axes and the masses are checked to be equal, and the distances of both
bodies from their targets are reported.
"""

import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from app.science.rotations import FloatArray
from tests.benchmarks.peers.bullet_body import (
    colliding_pairs,
    has_floor,
    motor_gains,
    scene_boxes,
    urdf_of,
)
from tests.benchmarks.peers.bullet_environment import NoPyBullet, pybullet_python

PEER = "PyBullet"
_SAME_MASS_KG = 0.1
_LONGEST_S = 600
_USUAL_ITERATIONS, _FEW_ITERATIONS = 50, 10
_WORKER = Path(__file__).with_name("bullet_worker.py")


@dataclass(frozen=True)
class BulletRun:
    """One configuration in which PyBullet is run.

    Attributes:
        name: the name of the configuration.
        fastest_s: processor time of the fastest round.
        mean_error_deg: mean error of all axes and steps from their targets.
    """

    name: str
    fastest_s: float
    mean_error_deg: float


def bullet_avatar(
    model: mujoco.MjModel, controls: FloatArray, *, steps_per_frame: int, rounds: int
) -> list[BulletRun]:
    """Run PyBullet with the same targets: with its defaults, and with as little work as possible.

    Returns nothing, with a printed reason, if PyBullet is unavailable.

    Args:
        model: an avatar with carried hips.
        controls: (steps, nu) as in `data.ctrl`: angle, speed, angle, speed.
        steps_per_frame: how often the minimal run gets new targets, instead of at every step.
        rounds: the number of rounds of each run.
    """
    ways = {
        "PyBullet as it comes": {"every": 1, "iterations": _USUAL_ITERATIONS},
        "PyBullet, fewer targets and iterations": {
            "every": steps_per_frame,
            "iterations": _FEW_ITERATIONS,
        },
    }
    gains, dampers = motor_gains(model)
    with tempfile.TemporaryDirectory() as folder:
        urdf = Path(folder) / "avatar.urdf"
        urdf.write_text(urdf_of(model), encoding="utf-8")
        plan = {
            "kind": "avatar",
            "urdf": str(urdf),
            "timestep_s": model.opt.timestep,
            "hips_m": model.body("Hips").pos.tolist(),
            "axes": [model.actuator(row).name for row in range(model.nu // 2)],
            "pairs": list(colliding_pairs(model)),
            "boxes": list(scene_boxes(model)),
            "floor": has_floor(model),
            "targets_rad": controls[:, 0::2].tolist(),
            "speeds_rad_s": controls[:, 1::2].tolist(),
            "max_torques_nm": model.actuator_forcerange[:, 1].tolist(),
            "position_gains": gains.tolist(),
            "speed_gains": dampers.tolist(),
            "ways": list(ways.values()),
            "rounds": rounds,
        }
        found = _asked(plan)
    if found is None:
        return []
    # A fixed body has no mass in Bullet, so the hips' is left out.
    mass = float(np.sum(model.body_mass) - model.body("Hips").mass[0])
    if found["axes"] != len(plan["axes"]) or abs(found["mass_kg"] - mass) > _SAME_MASS_KG:
        raise AssertionError(f"{PEER} has another body: {found['axes']}, {found['mass_kg']} kg.")
    return [
        BulletRun(name, min(one["rounds_s"]), one["mean_error_deg"])
        for name, one in zip(ways, found["ways"], strict=True)
    ]


def bullet_humanoid_steps_per_s(timestep_s: float, steps: int, rounds: int) -> float | None:
    """Return the steps per second of PyBullet's own humanoid; None if it is unavailable."""
    plan = {"kind": "humanoid", "timestep_s": timestep_s, "steps": steps, "rounds": rounds}
    found = _asked(plan)
    return None if found is None else steps / min(found["steps_s"])


def _asked(plan: dict[str, Any]) -> dict[str, Any] | None:
    try:
        python = pybullet_python()
    except NoPyBullet as error:
        print(f"  {PEER} is left out: {error}", file=sys.stderr)
        return None
    done = subprocess.run(
        [python, _WORKER],
        input=json.dumps(plan),
        capture_output=True,
        text=True,
        check=False,
        timeout=_LONGEST_S,
    )
    if done.returncode != 0:
        raise RuntimeError(f"{PEER} failed:\n{(done.stdout + done.stderr)[-4000:]}")
    # Bullet prints to standard output, too.
    answer: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return answer
