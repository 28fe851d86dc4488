"""Make the avatar's vectors: `python -m tests.science.avatar.ik.vector_files` writes them.

`tests/vectors/avatar/README.md` describes the files. With them the browser's physics and inverse
kinematics are checked against the server's. They describe the algorithms, not today's gains: tests
read the model from its file, so that they stay valid when the body or the tuning changes.
"""

import json
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from app.science.avatar.ik import GOAL_PARTS, Goals, InverseKinematics
from app.science.avatar.ik.chain import Chain
from app.science.rotations import FloatArray
from tests.science.avatar.ik import bodies

FOLDER = Path(__file__).parents[3] / "vectors" / "avatar"
Json = dict[str, Any]
FRAMES, RATE_HZ = 100, 90.0
FAR, LOST = range(40, 55), range(70, 80)
KEY_S, KEYS, SAMPLE_S = 0.5, 21, 0.1
_DECIMALS = 12


def make_all() -> dict[str, Json]:
    """Return the contents of every JSON file by its name, for the stored model."""
    model = mujoco.MjModel.from_xml_string((FOLDER / "body.xml").read_text())
    goals = _goal_frames(Chain(model))
    controls = _controls(Chain(model))
    return {
        "ik": {
            "fact": "Solved frame after frame from the rest pose, the goals give these angles.",
            "model": "body.xml",
            "parts": list(GOAL_PARTS),
            "frames": [_as_json(frame) for frame in goals],
            "cases": [
                _case(model, name, goals, waist=waist)
                for name, waist in (("with a waist tracker", True), ("without one", False))
            ],
        },
        "trajectory": {
            "fact": "The same commands move the simulated body through the same angles.",
            "model": "body.xml",
            **controls,
            "samples": samples(model, controls),
        },
    }


def read(name: str) -> Json:
    """Return one stored vector file."""
    found: Json = json.loads((FOLDER / f"{name}.json").read_text())
    return found


def as_text(vector: Json) -> str:
    """Return a vector as JSON with one frame or sample per line."""
    lines = []
    for key, value in vector.items():
        rows = isinstance(value, list) and value and not isinstance(value[0], str)
        text = (
            "[\n" + ",\n".join(json.dumps(row) for row in value) + "\n]"
            if rows
            else json.dumps(value)
        )
        lines.append(f"{json.dumps(key)}: {text}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def goals_from(frame: Json, *, waist: bool) -> Goals:
    """Return the goals of one frame of ik.json."""
    tracked = np.array(frame["tracked"], dtype=np.bool_)
    tracked[0] &= waist
    return Goals(np.array(frame["positions_m"]), np.array(frame["rotations"]), tracked)


def _goal_frames(chain: Chain) -> list[Goals]:
    """Return the goals of a body that goes through five poses.

    For some frames one hand is out of reach, and for others one is not tracked.
    """
    rng = np.random.default_rng(7)
    poses = np.array([bodies.random_pose(chain, rng) for _ in range(6)])
    places = (0.0, 0.9, 0.0) + 0.2 * rng.uniform(-0.5, 0.5, (6, 3))
    yaws = rng.uniform(-0.5, 0.5, 6)
    frames = []
    for index in range(FRAMES):
        leg, within = divmod(index, 20)
        blend = bodies.smooth(within / 20.0)
        angles, hips_m, yaw = (
            keys[leg] + blend * (keys[leg + 1] - keys[leg]) for keys in (poses, places, yaws)
        )
        goals = bodies.reached(chain, angles, hips_m, bodies.turned_hips(float(yaw)))
        positions, tracked = goals.positions_m.copy(), goals.tracked.copy()
        if index in FAR:
            positions[GOAL_PARTS.index("LeftHand")] += (-0.5, 0.3, 0.2)
        if index in LOST:
            tracked[GOAL_PARTS.index("RightHand")] = False
        # Rounded to six digits, so that the stored goals are exactly those that are solved.
        frames.append(Goals(np.round(positions, 6), np.round(goals.rotations, 6), tracked))
    return frames


def _as_json(goals: Goals) -> Json:
    return {
        "positions_m": goals.positions_m.tolist(),
        "rotations": goals.rotations.tolist(),
        "tracked": goals.tracked.tolist(),
    }


def _case(model: mujoco.MjModel, name: str, goals: list[Goals], *, waist: bool) -> Json:
    solver = InverseKinematics(model)
    solved = [solver.solve(goals_from(_as_json(frame), waist=waist)) for frame in goals]
    moving = Chain(model).moving
    return {
        "name": name,
        "waist": waist,
        "axes": [solver.axis_names[at] for at in moving],
        "angles_rad": [_rounded(one.angles_rad[moving]) for one in solved],
        "hips_m": [_rounded(one.hips_position_m) for one in solved],
        "hips": [_rounded(one.hips_rotation) for one in solved],
        "position_errors_m": [_rounded(one.position_errors_m) for one in solved],
        "rotation_errors_rad": [_rounded(one.rotation_errors_rad) for one in solved],
    }


def _controls(chain: Chain) -> Json:
    """Return motor targets at key moments: hands forward into the wall, aside, and back."""
    rng = np.random.default_rng(8)
    keys = []
    for key in range(KEYS):
        pose = 0.5 * bodies.random_pose(chain, rng, share=0.4)
        for side in ("Left", "Right"):
            forward, raised = ((0.0, -40.0), (80.0, 0.0), (80.0, -10.0), (40.0, -20.0))[key % 4]
            pose[chain.axis_names.index(f"{side}UpperArmY")] = np.radians(forward)
            pose[chain.axis_names.index(f"{side}UpperArmZ")] = np.radians(raised)
        keys.append(np.round(pose, 4).tolist())
    hips = [[0.03 * (key % 2), 1.0, -0.02 * (key % 3)] for key in range(KEYS)]
    return {"key_s": KEY_S, "sample_s": SAMPLE_S, "targets_rad": keys, "hips_m": hips}


def samples(model: mujoco.MjModel, controls: Json) -> list[Json]:
    """Return the simulated body every `sample_s`: its qpos and number of contacts, rounded."""
    found = simulate(model, controls)
    return [{"ncon": touching, "qpos": _rounded(qpos)} for touching, qpos in found]


def simulate(model: mujoco.MjModel, controls: Json) -> list[tuple[int, FloatArray]]:
    """Return the number of contacts and the qpos of every sample, not rounded."""
    data = mujoco.MjData(model)
    keys, hips = np.array(controls["targets_rad"]), np.array(controls["hips_m"])
    steps_a_key = round(controls["key_s"] / model.opt.timestep)
    steps_a_sample = round(controls["sample_s"] / model.opt.timestep)
    found = []
    for step in range(steps_a_key * (len(keys) - 1)):
        key, within = divmod(step, steps_a_key)
        fraction = within / steps_a_key
        blend = bodies.smooth(fraction)
        speed = 6.0 * fraction * (1.0 - fraction) / controls["key_s"]
        data.ctrl[0::2] = keys[key] + blend * (keys[key + 1] - keys[key])
        data.ctrl[1::2] = speed * (keys[key + 1] - keys[key])
        data.mocap_pos[0] = hips[key] + blend * (hips[key + 1] - hips[key])
        mujoco.mj_step(model, data)
        if (step + 1) % steps_a_sample == 0:
            found.append((int(data.ncon), data.qpos.copy()))
    return found


def _rounded(values: FloatArray) -> list[float | None]:
    """Round numbers to twelve decimals and replace NaN with null."""
    return [None if np.isnan(one) else round(one, _DECIMALS) + 0.0 for one in values.tolist()]


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    (FOLDER / "body.xml").write_text(bodies.mjcf())
    for file, made in make_all().items():
        (FOLDER / f"{file}.json").write_text(as_text(made))
