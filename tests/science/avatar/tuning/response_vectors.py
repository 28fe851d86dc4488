"""The vectors `tests/vectors/avatar/responses.json`: what the figures of a response are.

The console's page computes the figures of steps and pushes while they happen; both sides read this
file, so that a word means the same in a tuning, in a benchmark and on the page.
"""

import json
from pathlib import Path
from typing import Any, Final

import numpy as np

from app.science.avatar.mjcf import default_configuration
from app.science.avatar.tuning.disturbance import Disturbance, disturb, returned_after_s
from app.science.avatar.tuning.step_response import step_figures
from app.science.rotations import FloatArray, identity
from app.science.skeleton import JOINT_INDEX

Json = dict[str, Any]
FILE: Final = Path(__file__).parents[3] / "vectors" / "avatar" / "responses.json"
STEP_S: Final = 0.01
RATE_HZ: Final = 100.0


def _oscillator(damping: float, omega: float, ticks: int, delay: int = 0) -> FloatArray:
    """Return the unit step response of a second-order system, in closed form."""
    t = np.maximum(np.arange(1 - delay, ticks + 1 - delay), 0) * STEP_S
    root = np.sqrt(1.0 - damping**2)
    swing = np.cos(omega * root * t) + damping / root * np.sin(omega * root * t)
    response: FloatArray = 1.0 - np.exp(-damping * omega * t) * swing
    return response


STEPS: Final[tuple[tuple[str, FloatArray, float, float], ...]] = (
    ("overshoots", _oscillator(0.3, 20.0, 200), 0.0, 1.0),
    ("creeps", _oscillator(0.99, 12.0, 150), 0.0, 1.0),
    ("downwards, short of its target", 0.7 - 0.6 * _oscillator(0.5, 25.0, 100), 0.7, 0.0),
    ("125 ms late", 0.2 + 0.5 * _oscillator(0.7, 30.0, 100, 12), 0.2, 0.7),
    ("swings on and on", 1.0 + 0.2 * np.sin(0.6 * np.arange(150)), 0.0, 1.0),
    ("ends before it arrives", _oscillator(0.9, 3.0, 30), 0.0, 1.0),
    ("does not move", np.zeros(50), 0.0, 0.5),
    ("shorter than its rest", np.array([0.4, 0.5, 0.5]), 0.0, 0.5),
)
PUSHES: Final[tuple[tuple[str, Disturbance], ...]] = (
    ("100 N at the shin", Disturbance("LeftLowerLeg", (0.0, 0.0, 100.0))),
    ("200 N sideways at the hand", Disturbance("LeftHand", (0.0, 0.0, 200.0), 0.5)),
    ("a nudge that stays within 2 degrees", Disturbance("Head", (0.0, 0.0, 2.0))),
    ("until the end", Disturbance("RightHand", (0.0, -60.0, 0.0), 2.5)),
)


def step_case(name: str, angles: FloatArray, start_rad: float, target_rad: float) -> Json:
    """Return a step with the figures that follow from it."""
    angles = np.round(angles, 12)
    return {
        "name": name,
        "start_rad": start_rad,
        "target_rad": target_rad,
        "step_s": STEP_S,
        "angles_rad": angles.tolist(),
        "figures": vars(step_figures(angles, start_rad, target_rad, STEP_S)),
    }


def push_case(name: str, push: Disturbance) -> Json:
    """Return a push of the shipped body with the figures that follow from its deflection."""
    pose = identity(len(JOINT_INDEX))
    found = disturb(default_configuration(), 1.75, push, pose, rate_hz=RATE_HZ)
    deflection = np.round(found.deflection_rad, 9)
    ticks = round(push.duration_s * RATE_HZ)
    return {
        "name": name,
        "pushed_ticks": ticks,
        "tick_s": 1.0 / RATE_HZ,
        "deflection_rad": deflection.tolist(),
        "figures": {
            "peak_rad": float(deflection.max()),
            "return_s": returned_after_s(deflection, ticks, RATE_HZ),
        },
    }


def make() -> str:
    """Return the file's text, with one case per line."""
    steps = ",\n".join(json.dumps(step_case(*one)) for one in STEPS)
    pushes = ",\n".join(json.dumps(push_case(*one)) for one in PUSHES)
    fact = json.dumps("A step and a push have the same figures on every side.")
    return f'{{"fact": {fact},\n"steps": [\n{steps}\n],\n"pushes": [\n{pushes}\n]}}\n'


if __name__ == "__main__":
    FILE.write_text(make())
