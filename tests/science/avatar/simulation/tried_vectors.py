"""Make `tests/vectors/avatar/tried.json`, which holds the physics of the console to Python's.

`python -m tests.science.avatar.simulation.tried_vectors` writes it: the same commands, a driven
joint, a push, a dropped box and a switched latency, move the same body in the same way. One body
has a soft leg whose parts return to their own directions.
`tests/vectors/avatar/README.md` describes the file.
"""

import json
import re
from dataclasses import dataclass
from math import floor, inf, pi, sin, sqrt
from pathlib import Path
from typing import Any

import numpy as np

from app.protocol.avatar import AvatarFile, configuration_of, file_of
from app.science.avatar.body import AXIS_NAMES
from app.science.avatar.configuration import parts_of, world_limbs
from app.science.avatar.mjcf.gains import default_configuration
from app.science.avatar.simulation import Follower, PhysicsAvatar
from app.science.avatar.targets import TargetAngles
from app.science.avatar.targets.targets import finger_rotations, joint_rotations
from app.science.rotations import FloatArray, identity, rotate

FILE = Path(__file__).parents[3] / "vectors" / "avatar" / "tried.json"
MODEL = FILE.with_name("body.xml")
Json = dict[str, Any]
TICK_S, TICKS, EVERY = 0.01, 200, 10
BOX = """    <body name="box" pos="0 4 0" gravcomp="1">
      <freejoint name="box"/>
      <geom name="box" type="box" size="0.1 0.1 0.1" mass="2" contype="1" conaffinity="1"
        priority="1" solref="0.004 1" solimp="0.99 0.999 0.001 0.5 2" friction="0.5 0.005 0.0001"/>
    </body>
"""
PLANE = 'type="plane"'
LOW_PLANE = 'type="plane" pos="0 -1 0"'
"""The floor is a metre lower: feet that stand on it make a difference in the last digit grow."""
PUSH: Json = {
    "part": "LeftLowerLeg",
    "pointM": [0.0, -0.2, 0.03],
    "forceN": [60.0, 0.0, 80.0],
    "forS": 0.2,
}
SHIN: Json = {"part": "LeftLowerLeg", "pointM": [0.0, -0.188, 0.0], "forS": 0.2}


def softened(group: str, share: float) -> list[list[str]]:
    """Return what a soft group has in the stored model instead: weaker motors, carried parts."""
    text, changes = MODEL.read_text(), list[list[str]]()
    for part in parts_of(group):
        changes.append([f'<body name="{part}" ', f'<body name="{part}" gravcomp="1" '])
        for found in re.finditer(rf'(<pid name="{part}[XYZ]" .*)kp="(.*?)" kv="(.*?)"', text):
            motor, kp, kv = found[1], share * float(found[2]), sqrt(share) * float(found[3])
            changes.append([found[0], f'{motor}kp="{kp:.6g}" kv="{kv:.6g}"'])
    return changes


CASES: tuple[Json, ...] = (
    {
        "name": "a pushed shin, a step and a sine, a latency, a dropped box",
        "target_space": "local",
        "watched": "LeftUpperArmZ",
        "events": [
            {"tick": 0, "command": {"kind": "drive", "drive": {
                "axis": "LeftUpperArmZ",
                "wave": {"kind": "step", "centerRad": -0.3, "amplitudeRad": 0.2, "periodS": 0.8},
            }}},
            {"tick": 50, "command": {"kind": "push", "push": PUSH}},
            {"tick": 80, "command": {"kind": "latency", "latencyS": 0.125}},
            {"tick": 90, "command": {"kind": "drive", "drive": {
                "axis": "RightIndexProximalZ",
                "wave": {"kind": "sine", "centerRad": 0.4, "amplitudeRad": 0.3, "periodS": 0.5},
            }}},
            {"tick": 130, "command": {"kind": "drop", "centerM": [0.5, 2.0, -0.05]}},
        ],
    },
    {
        "name": "targets in the room, reset in between, in the end without gravity",
        "target_space": "world",
        "watched": "HeadY",
        "events": [
            {"tick": 0, "command": {"kind": "drive", "drive": {
                "axis": "HeadY", "wave": {"kind": "hold", "angleRad": 0.5},
            }}},
            {"tick": 20, "command": {"kind": "push", "push": PUSH | {
                "part": "UpperChest", "pointM": [0.1, 0.05, 0.0], "forceN": [0.0, 0.0, 60.0],
                "forS": None,
            }}},
            {"tick": 100, "command": {"kind": "reset"}},
            {"tick": 180, "command": {"kind": "gravity", "isOn": False}},
        ],
    },
    {
        "name": "a shin pushed from the front and the side, of a soft leg with world targets",
        "target_space": "local",
        "compliance": {"left_leg": {"stiffness_percent": 10.0, "targets": "world"}},
        "replaced": softened("left_leg", 0.1),
        "watched": "LeftLowerLegX",
        "events": [
            {"tick": 0, "command": {"kind": "pose", "anglesRad": {
                "LeftUpperLegX": 0.52, "LeftLowerLegX": 0.87,
            }}},
            {"tick": 0, "command": {"kind": "reset"}},
            {"tick": 20, "command": {"kind": "push", "push": SHIN | {
                "forceN": [0.0, 0.0, 100.0],
            }}},
            {"tick": 90, "command": {"kind": "latency", "latencyS": 0.125}},
            {"tick": 100, "command": {"kind": "pose", "anglesRad": {
                "LeftUpperLegX": 0.35, "LeftUpperLegY": 0.1, "LeftLowerLegX": 0.6,
            }}},
            {"tick": 105, "command": {"kind": "push", "push": SHIN | {
                "forceN": [120.0, 0.0, 0.0],
            }}},
        ],
    },
)  # fmt: skip


@dataclass
class Push:
    """A force on a point of a part."""

    part: str
    point_m: FloatArray
    force_n: FloatArray
    until_s: float


class Tried:
    """One body that is driven, pushed and hit by a box, in steps of 10 ms."""

    def __init__(self, mjcf: str, case: Json) -> None:
        content = file_of(default_configuration()).model_dump()
        own = {"target_space": case["target_space"], "compliance": case.get("compliance")}
        file = AvatarFile.model_validate(content | own)
        self.avatar = PhysicsAvatar(mjcf)
        configuration = configuration_of(file)
        angles = TargetAngles(configuration.in_force, self.avatar.parts)
        self.angles = angles
        self.follower = Follower(
            self.avatar,
            angles,
            target_space=case["target_space"],
            world_limbs=world_limbs(configuration.compliance),
        )
        self.standing = self.avatar.data.mocap_pos[0].copy()
        self.pose: dict[str, float] = {}
        self.drive: Json | None = None
        self.push: Push | None = None
        self.ticks = 0
        self._weigh_box(gravcomp=1.0, mask=0)
        self.reset()

    def obey(self, command: Json) -> None:
        """Change what holds from the next tick on."""
        kind = command["kind"]
        if kind == "drive":
            self.drive = command["drive"]
        elif kind == "pose":
            self.pose = command["anglesRad"]
        elif kind == "push":
            given = command["push"]
            self.push = Push(
                given["part"], np.array(given["pointM"]), np.array(given["forceN"]), inf
            )
            if given["forS"] is not None:
                self.push.until_s = TICK_S * self.ticks + given["forS"]
        elif kind == "latency":
            self.follower.set_delay(command["latencyS"])
        elif kind == "gravity":
            self.avatar.switches.set_gravity(on=command["isOn"])
        elif kind == "drop":
            self._weigh_box(gravcomp=0.0, mask=1)
            joint = self.avatar.data.joint("box")
            joint.qpos[:] = [*command["centerM"], 1.0, 0.0, 0.0, 0.0]
            joint.qvel[:] = 0.0
        else:
            self.reset()

    def tick(self) -> None:
        """Simulate 10 ms."""
        self.ticks += 1
        time_s = TICK_S * self.ticks
        self._apply_push(time_s)
        rotations, fingers = self._commanded(time_s)
        self.follower.frame(time_s, self.standing, rotations, fingers)

    def reset(self) -> None:
        """Start again at time zero."""
        self.ticks = 0
        self.push = None
        self.avatar.data.xfrc_applied[:] = 0.0
        self._weigh_box(gravcomp=1.0, mask=0)
        self.avatar.rewind()
        rotations, fingers = self._commanded(0.0)
        self.follower.start(self.standing, rotations, fingers)

    def torque_nm(self, axis: str) -> float:
        """Return the torque of an axis's motor in the last step."""
        return float(self.avatar.data.actuator(axis).force[0])

    def _commanded(self, time_s: float) -> tuple[FloatArray, FloatArray]:
        angles = np.zeros(len(AXIS_NAMES))
        for axis, angle_rad in self.pose.items():
            angles[AXIS_NAMES.index(axis)] = angle_rad
        if self.drive is not None:
            angles[AXIS_NAMES.index(self.drive["axis"])] = wave_at(self.drive["wave"], time_s)
        return joint_rotations(angles, identity()), finger_rotations(angles)

    def _apply_push(self, time_s: float) -> None:
        push, data = self.push, self.avatar.data
        if push is None:
            return
        if time_s > push.until_s + TICK_S / 2:
            self.push = None
            data.xfrc_applied[:] = 0.0
            return
        body = data.body(push.part)
        point = body.xpos + rotate(body.xquat, push.point_m)
        body.xfrc_applied[:] = [
            *push.force_n, *np.cross(point - body.xipos, push.force_n)
        ]  # fmt: skip

    def _weigh_box(self, *, gravcomp: float, mask: int) -> None:
        model = self.avatar.model
        body, geom = model.body("box").id, model.geom("box").id
        model.body_gravcomp[body] = gravcomp
        for masks, row in (
            (model.geom_contype, geom),
            (model.geom_conaffinity, geom),
            (model.body_contype, body),
            (model.body_conaffinity, body),
        ):
            masks[row] = mask


def wave_at(wave: Json, time_s: float) -> float:
    """Return the angle of a wave at a time."""
    if wave["kind"] == "hold":
        return float(wave["angleRad"])
    turn = time_s / wave["periodS"] - floor(time_s / wave["periodS"])
    share = (-1.0 if turn < 0.5 else 1.0) if wave["kind"] == "step" else sin(2.0 * pi * turn)
    return float(wave["centerRad"] + share * wave["amplitudeRad"])


def tried(case: Json) -> list[Json]:
    """Return `qpos` and the watched motor's torque after every tenth tick."""
    lowered = MODEL.read_text().replace(PLANE, LOW_PLANE)
    for old, new in case.get("replaced", ()):
        lowered = lowered.replace(old, new)
    body = Tried(lowered.replace("  </worldbody>", f"{BOX}  </worldbody>"), case)
    samples: list[Json] = []
    for tick in range(TICKS):
        for event in case["events"]:
            if event["tick"] == tick:
                body.obey(event["command"])
        body.tick()
        if (tick + 1) % EVERY == 0:
            qpos = [round(value, 11) + 0.0 for value in body.avatar.data.qpos.tolist()]
            samples.append(
                {"torque_nm": round(body.torque_nm(case["watched"]), 9) + 0.0, "qpos": qpos}
            )
    assert body.avatar.health.restored == 0
    return samples


def make() -> str:
    """Return the file's text, with one sample per line."""
    file = file_of(default_configuration())
    head = {
        "fact": "The same commands move a body in the same way.",
        "model": "body.xml",
        "box": BOX,
        "floor": [PLANE, LOW_PLANE],
        "configuration": file.model_dump(mode="json", exclude_none=True),
        "ticks": TICKS,
        "every": EVERY,
    }
    cases = []
    for case in CASES:
        samples = ",\n".join(json.dumps(one) for one in tried(case))
        cases.append(f'{json.dumps(case)[:-1]}, "samples": [\n{samples}\n]}}')
    return f'{json.dumps(head)[:-1]},\n"cases": [\n' + ",\n".join(cases) + "\n]}\n"


if __name__ == "__main__":
    FILE.write_text(make())
