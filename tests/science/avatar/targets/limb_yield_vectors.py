"""Make `tests/vectors/avatar/limb_yield.json`: how limbs with world targets give way.

Run `python -m tests.science.avatar.targets.limb_yield_vectors`; the README beside the file explains
it.
"""

import json
from pathlib import Path
from typing import Any, Final

import numpy as np

from app.science.avatar.body import AXIS_NAMES
from app.science.avatar.configuration import LIMBS, axes_of
from app.science.avatar.targets import LimbYield

FILE: Final = Path(__file__).parents[3] / "vectors" / "avatar" / "limb_yield.json"
FRAMES, RATE_HZ, DECIMALS = 24, 90.0, 9
NO_HINGE: Final = ("LeftLowerArmZ", "RightLowerArmZ")
AXES: Final = [name for limb in LIMBS for name in axes_of(limb)]
COLUMNS: Final = [AXIS_NAMES.index(name) for name in AXES]


def given() -> list[dict[str, Any]]:
    """Return targets and actual angles of each frame, and the time since the frame before."""
    rng = np.random.default_rng(22)
    first, second = rng.uniform(-1.5, 1.5, (2, len(AXES)))
    apart = rng.uniform(-1.2, 1.2, len(AXES))
    frames = []
    for frame in range(FRAMES):
        share = frame / (FRAMES - 1)
        targets = np.round((1.0 - share) * first + share * second, DECIMALS)
        pushed = np.round(targets + np.sin(np.pi * share) * apart, DECIMALS)
        actual = [
            None if name in NO_HINGE else angle
            for name, angle in zip(AXES, pushed.tolist(), strict=True)
        ]
        elapsed_s = round((1.0 + 0.3 * (frame % 3)) / RATE_HZ, DECIMALS)
        frames.append(
            {"elapsed_s": elapsed_s, "targets_rad": targets.tolist(), "actual_rad": actual}
        )
    return frames


def answered(frames: list[dict[str, Any]], limbs: tuple[str, ...]) -> list[list[float]]:
    """Return the angles commanded in each frame, of `AXES`."""
    rule, commands = LimbYield(limbs), []
    for frame in frames:
        targets, actual = np.zeros(len(AXIS_NAMES)), np.zeros(len(AXIS_NAMES))
        targets[COLUMNS] = frame["targets_rad"]
        actual[COLUMNS] = [np.nan if one is None else one for one in frame["actual_rad"]]
        commands.append(rule.commands(targets)[COLUMNS].tolist())
        rule.note(targets, actual, frame["elapsed_s"])
    return commands


def made() -> dict[str, Any]:
    """Return the content of the file."""
    frames = given()
    cases = [
        {"limbs": limbs, "commands_rad": answered(frames, limbs)}
        for limbs in (LIMBS, ("right_leg",))
    ]
    return {"axes": AXES, "frames": frames, "cases": cases}


if __name__ == "__main__":
    FILE.write_text(json.dumps(made(), separators=(",", ":")) + "\n", encoding="utf-8")
