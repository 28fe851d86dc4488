"""Small generated capture files, and helpers to upload them."""

import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
from fastapi.testclient import TestClient
from httpx2 import Response

from tests.features.lab import Json, ok

FPS = 30.0
CHANNELS = "CHANNELS 3 Zrotation Xrotation Yrotation"
THIGH_M, SHIN_M, ANKLE_M, HIPS_M = 0.42, 0.41, 0.06, 0.87
SPEED_M_S, LIFT_M = 1.2, 0.12


def walk_bvh(frames: int = 150, *, metres_per_unit: float = 0.01) -> bytes:
    """Return a body that walks forward at 1.2 m/s, each foot in the air half of the time."""
    joints: list[str] = []
    lines = ["HIERARCHY", *_hierarchy(joints, metres_per_unit), "MOTION"]
    lines += [f"Frames: {frames}", f"Frame Time: {1.0 / FPS}"]
    lines += [_frame(joints, frame / FPS, metres_per_unit) for frame in range(frames)]
    return ("\n".join(lines) + "\n").encode()


def _hierarchy(joints: list[str], unit: float) -> list[str]:
    def joint(name: str, offset: tuple[float, float, float], *inner: list[str]) -> list[str]:
        root = name == "Hips"
        channels = f"CHANNELS 6 Xposition Yposition Zposition{CHANNELS[10:]}" if root else CHANNELS
        head = [f"{'ROOT' if root else 'JOINT'} {name}", "{", _offset(offset, unit), channels]
        end = ["End Site", "{", _offset((0.0, 0.0, 0.1), unit), "}"]
        return [*head, *(line for part in inner for line in part), *([] if inner else end), "}"]

    def limb(side: str, x: float) -> list[str]:
        toe = joint(f"{side}ToeBase", (0.0, -0.06, 0.14))
        foot = joint(f"{side}Foot", (0.0, -SHIN_M, 0.0), toe)
        shin = joint(f"{side}Leg", (0.0, -THIGH_M, 0.0), foot)
        return joint(f"{side}UpLeg", (x, -0.05, 0.0), shin)

    def arm(side: str, x: float) -> list[str]:
        hand = joint(f"{side}Hand", (x * 0.25, 0.0, 0.0))
        lower = joint(f"{side}ForeArm", (x * 0.28, 0.0, 0.0), hand)
        upper = joint(f"{side}Arm", (x * 0.12, 0.0, 0.0), lower)
        return joint(f"{side}Shoulder", (x * 0.05, 0.2, 0.0), upper)

    head = joint("Neck", (0.0, 0.25, 0.0), joint("Head", (0.0, 0.12, 0.0)))
    chest = joint("Spine1", (0.0, 0.15, 0.0), head, arm("Left", 1.0), arm("Right", -1.0))
    spine = joint("Spine", (0.0, 0.1, 0.0), chest)
    body = joint("Hips", (0.0, 0.0, 0.0), spine, limb("Left", 0.1), limb("Right", -0.1))
    joints += [line.split()[1] for line in body if line.startswith(("ROOT", "JOINT"))]
    return body


def _offset(offset: tuple[float, float, float], unit: float) -> str:
    return "OFFSET " + " ".join(f"{value / unit:.6f}" for value in offset)


def _frame(joints: list[str], time_s: float, unit: float) -> str:
    hips = (0.0, HIPS_M, SPEED_M_S * time_s)
    values = [value / unit for value in hips]
    bent = {side: _leg_deg(side, time_s) for side in ("Left", "Right")}
    for name in joints:
        side = "Left" if name.startswith("Left") else "Right"
        values += [0.0, bent[side].get(name.removeprefix(side), 0.0), 0.0]
    return " ".join(f"{value:.6f}" for value in values)


def _leg_deg(side: str, time_s: float) -> Mapping[str, float]:
    """Return the turns about x that put the ankle in place with a flat foot (law of cosines)."""
    forward_m, up_m = _ankle_m(time_s + (0.5 if side == "Right" else 0.0))
    down_m = HIPS_M - 0.05 - up_m
    far_m = float(np.hypot(forward_m, down_m))
    thigh = np.arctan2(forward_m, down_m) + _corner(THIGH_M, far_m, SHIN_M)
    flexed = np.pi - _corner(THIGH_M, SHIN_M, far_m)
    turns = {"UpLeg": -thigh, "Leg": flexed, "Foot": thigh - flexed}
    return {part: float(np.degrees(turn)) for part, turn in turns.items()}


def _ankle_m(time_s: float) -> tuple[float, float]:
    """Return the ankle's position ahead of the hips and above the ground at a time."""
    phase = time_s % 1.0
    reach_m = SPEED_M_S / 4.0
    if phase < 0.5:
        return reach_m - SPEED_M_S * phase, ANKLE_M
    swing = 2.0 * phase - 1.0
    travelled = (swing - np.sin(2.0 * np.pi * swing) / (2.0 * np.pi)) * SPEED_M_S
    ahead_m = -reach_m - SPEED_M_S * (phase - 0.5) + travelled
    return float(ahead_m), ANKLE_M + LIFT_M * float(np.sin(np.pi * swing) ** 2)


def _corner(a: float, b: float, opposite: float) -> float:
    """Return the angle between two sides of a triangle."""
    return float(np.arccos(np.clip((a * a + b * b - opposite**2) / (2.0 * a * b), -1.0, 1.0)))


def upload(client: TestClient, data: bytes, name: str = "walk.bvh", **more: Any) -> Response:
    """Upload a capture and return the response, even if it is an error."""
    return client.post("/api/captures", params={"name": name, **more}, content=data)


def uploaded(client: TestClient, data: bytes, name: str = "walk.bvh", **more: Any) -> Json:
    """Upload a capture that must be accepted and return it."""
    view: Json = ok(upload(client, data, name, **more))
    return view


def positions_of(body: bytes) -> tuple[Json, npt.NDArray[np.float32]]:
    """Return header and positions (N, J, 3) of a preview, decoded as a page does."""
    (length,) = struct.unpack("<I", body[:4])
    header: Json = json.loads(body[4 : 4 + length])
    numbers = np.frombuffer(body[4 + length :], dtype="<f4")
    return header, numbers.reshape(header["frames"], len(header["names"]), 3)
