"""Make `tests/vectors/avatar/followed.json`, which holds the headset's remote body to Python's.

`python -m tests.science.avatar.simulation.followed_vectors` writes it: the same participant gives
the same body and touches as in the scripted headset (`app.simulated_people.avatars.PhysicsBody`).
`tests/vectors/avatar/README.md` describes the file.
"""

import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import mujoco
import numpy as np

from app.protocol.avatar import AvatarFile, configuration_of, file_of
from app.science.avatar.body import AXIS_NAMES
from app.science.avatar.ik import Chain
from app.science.avatar.mjcf.gains import default_configuration
from app.science.avatar.targets.targets import finger_rotations, joint_rotations
from app.science.rotations import FloatArray, from_rotation_vector, q_blend
from app.science.skeleton import FINGER_PARTS, Pose
from app.science.tasks import TaskLayout
from app.simulated_people.avatars import PhysicsBody
from app.wire import AvatarOrder
from tests.science.avatar.ik import bodies

FILE = Path(__file__).parents[3] / "vectors" / "avatar" / "followed.json"
MODEL = FILE.with_name("body.xml")
Json = dict[str, Any]
FRAMES, FRAMES_A_KEY, EVERY = 180, 30, 6
SURFACES = ("front", "left", "right")
NO_CHANGE: Json = {
    "gravity": None,
    "self_collision": None,
    "colliders": {},
    "layers": [],
    "held_rad": {},
    "motors": {},
}
CASES: tuple[Json, ...] = (
    {
        "name": "local targets, fingers, touches, a changed latency, a jump of the hips",
        "target_space": "local",
        "fingers": True,
        "hips_scale": 1.0,
        "events": [
            {"frame": 0, "surfaces": list(SURFACES)},
            {"frame": 40, "latency_s": 0.125},
            {"frame": 100, "latency_s": 0.35},
            {"frame": 140, "surfaces": []},
        ],
        "jump": 120,
    },
    {
        "name": "targets in the world, delayed, with hips of another height",
        "target_space": "world",
        "fingers": True,
        "hips_scale": 1.02,
        "events": [{"frame": 0, "latency_s": 0.05, "surfaces": list(SURFACES)}],
    },
    {
        "name": "changes, put on again in between",
        "target_space": "local",
        "fingers": False,
        "hips_scale": 1.0,
        "events": [
            {"frame": 0, "surfaces": list(SURFACES)},
            {
                "frame": 20,
                "order": NO_CHANGE
                | {
                    "revision": 1,
                    "gravity": False,
                    "held_rad": {"LeftLowerArmY": 1.2, "RightLowerArmY": None},
                    "colliders": {"LeftHand": "none", "RightHand": "mesh"},
                    "layers": [{"layers": ["left_hand", "torso"], "collide": False}],
                },
            },
            {
                "frame": 70,
                "order": NO_CHANGE
                | {
                    "revision": 2,
                    "self_collision": False,
                    "held_rad": {"RightLowerArmY": None},
                    "motors": {
                        "HeadX": {
                            "kp_nm_per_rad": 20.0,
                            "kd_nm_s_per_rad": 1.0,
                            "max_torque_nm": 5.0,
                        }
                    },
                },
            },
            {"frame": 110, "order": NO_CHANGE | {"revision": 3}, "latency_s": 0.125},
            {"frame": 130, "put_on": True},
        ],
    },
    {
        "name": "an arm that lags behind, and layers of its own",
        "target_space": "local",
        "fingers": False,
        "hips_scale": 1.0,
        "own_delays_s": {"LeftUpperArmY": 0.1, "LeftLowerArmY": 0.25},
        "layers": [
            {"layers": ["torso", "left_hand"], "collide": False},
            {"layers": ["torso", "right_arm"], "collide": True},
        ],
        "events": [
            {"frame": 0, "latency_s": 0.05, "surfaces": list(SURFACES)},
            {"frame": 30, "order": NO_CHANGE | {"revision": 1, "gravity": False}},
            {"frame": 90, "latency_s": 0.0},
            {"frame": 100, "order": NO_CHANGE | {"revision": 2, "self_collision": False}},
            {"frame": 130, "order": NO_CHANGE | {"revision": 3}},
        ],
    },
)


def make() -> Json:
    """Return the content of the file, for the stored model."""
    file = file_of(default_configuration())
    return {
        "fact": "The same participant moves the remote body in the same way.",
        "model": "body.xml",
        "configuration": file.model_dump(mode="json", exclude_none=True),
        "frames": FRAMES,
        "frames_a_key": FRAMES_A_KEY,
        "every": EVERY,
        "keys": _keys(),
        "cases": [one | followed(one, _keys()) for one in CASES],
    }


def followed(case: Json, keys: Json) -> Json:
    """Return the body's pose in every sixth frame, its touches and the angles of held axes."""
    content = file_of(default_configuration()).model_dump()
    own = {"target_space": case["target_space"], "layers": case.get("layers")}
    file = AvatarFile.model_validate(content | own)
    body = PhysicsBody(
        model_with(case.get("own_delays_s", {})),
        configuration_of(file),
        case["hips_scale"],
        with_fingers=case["fingers"],
    )
    samples: list[Json] = []
    held: list[dict[str, float]] = []
    events = {event["frame"]: event for event in case["events"]}
    for frame in range(FRAMES):
        event = events.get(frame, {})
        if event.get("put_on"):
            body.put_on()
        if "latency_s" in event:
            body.set_latency(event["latency_s"])
        if "surfaces" in event:
            body.show_boxes(_layout(event["surfaces"]))
        pose, fingers = participant(frame, keys, jump=case.get("jump"))
        shown = body.frame(time_s(frame), pose, fingers if case["fingers"] else None)
        if "order" in event:
            held.append(dict(body.change(AvatarOrder.model_validate(event["order"]))))
        touched, near = body.touches()
        if frame % EVERY == 0:
            samples.append(
                {
                    "pose": _rounded(
                        np.concatenate((shown.root_position_m, shown.rotations.ravel()))
                    ),
                    "touched": np.flatnonzero(touched).tolist(),
                    "near": np.flatnonzero(near).tolist(),
                }
                | ({} if body.fingers is None else {"fingers": _rounded(body.fingers.ravel()[::4])})
            )
    return {"held_rad": held, "samples": samples}


def model_with(own_delays_s: dict[str, float]) -> str:
    """Return the stored model with motors that lag behind the others."""
    text = MODEL.read_text()
    for name, delay_s in own_delays_s.items():
        text = re.sub(rf'(<pid name="{name}".* delay=")0"', rf'\g<1>{delay_s:g}"', text)
    return text


def _layout(keys: list[str]) -> TaskLayout | None:
    """Return a layout of walls around the vectors' model, of which a body reads only the keys."""
    surfaces = [SimpleNamespace(key=key) for key in keys]
    return cast("TaskLayout", SimpleNamespace(surfaces=surfaces)) if keys else None


def time_s(frame: int) -> float:
    """Return the time of a frame: 90 a second, each up to 2 ms late."""
    return frame / 90.0 + 0.001 * (frame % 3)


def participant(frame: int, keys: Json, *, jump: int | None) -> tuple[Pose, FloatArray]:
    """Return the participant's pose and fingers, blended between two key poses."""
    key, within = divmod(frame, FRAMES_A_KEY)
    fraction = within / FRAMES_A_KEY
    share = fraction * fraction * (3.0 - 2.0 * fraction)
    one, other = (np.array(keys["rotations"][at]) for at in (key, key + 1))
    blended = np.array(
        [
            q_blend(tuple(a), tuple(b), share)
            for a, b in zip(one.reshape(-1, 4).tolist(), other.reshape(-1, 4).tolist(), strict=True)
        ]
    )
    here, there = (np.array(keys["hips_m"][at]) for at in (key, key + 1))
    hips = here + share * (there - here)
    if jump is not None and frame >= jump:
        hips = hips + np.array((0.5, 0.0, 0.0))
    return Pose(hips, blended[: -len(FINGER_PARTS)]), blended[-len(FINGER_PARTS) :]


def _keys() -> Json:
    """Return key poses: local rotations of 22 joints and 30 fingers, and the hips' positions."""
    rng = np.random.default_rng(11)
    chain = Chain(mujoco.MjModel.from_xml_string(MODEL.read_text()))
    columns = [AXIS_NAMES.index(name) for name in chain.axis_names]
    rotations, places = [], []
    for key in range(FRAMES // FRAMES_A_KEY + 1):
        angles = np.zeros(len(AXIS_NAMES))
        angles[columns] = 0.5 * bodies.random_pose(chain, rng, share=0.4)
        for side in ("Left", "Right"):
            forward, raised = ((0.0, -40.0), (80.0, 0.0), (80.0, -10.0), (40.0, -20.0))[key % 4]
            angles[AXIS_NAMES.index(f"{side}UpperArmY")] = np.radians(forward)
            angles[AXIS_NAMES.index(f"{side}UpperArmZ")] = np.radians(raised)
            angles[AXIS_NAMES.index(f"{side}IndexProximalZ")] = np.radians(20.0 * (key % 3))
        hips = from_rotation_vector(np.array((0.0, 0.1 * (key % 3), 0.02)))
        whole = np.concatenate((joint_rotations(angles, hips), finger_rotations(angles)))
        # Rotations at the collar bones, which have no hinge, go to the upper arms.
        whole[6] = from_rotation_vector(np.array((0.0, 0.05, 0.1)))
        rotations.append([round(value, 6) + 0.0 for value in whole.ravel().tolist()])
        places.append([0.03 * (key % 2), 1.0, -0.02 * (key % 3)])
    return {"rotations": rotations, "hips_m": places}


def _rounded(values: FloatArray) -> list[float]:
    return [round(value, 11) + 0.0 for value in values.tolist()]


def as_text(vector: Json) -> str:
    """Return the vector as JSON with one sample per line."""
    cases = [dict(case) for case in vector["cases"]]
    texts = []
    for case in cases:
        samples = ",\n".join(json.dumps(one) for one in case.pop("samples"))
        texts.append(f'{json.dumps(case)[:-1]}, "samples": [\n{samples}\n]}}')
    head = {key: value for key, value in vector.items() if key != "cases"}
    return f'{json.dumps(head)[:-1]},\n"cases": [\n' + ",\n".join(texts) + "\n]}\n"


if __name__ == "__main__":
    FILE.write_text(as_text(make()))
