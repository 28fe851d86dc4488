"""Compute which parts move each point of the skin, and by how much.

Along every chain of bones a point belongs to the bone that it lies beside; around a joint its
weight passes smoothly to the next bone, over about the thickness of the limb. Where limbs and
fingers begin, the weights are then averaged with those of neighbouring points, so that the skin
there follows both sides.
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import FINGERS, PART_NAMES, SEGMENTS, Proportions, mirrored_name
from app.science.avatar.mannequin.patchwork import IndexArray, Sewn, averages, neighbours
from app.science.rotations import FloatArray

MOST_PARTS = 4
_LEAST = 0.004
_ROUNDS = 5
_SMOOTHING = {"trunk": 0.55, "arm": 0.3, "leg": 0.35, "palm": 0.4, "Thumb": 0.2}
_INDEX = {part: number for number, part in enumerate(PART_NAMES)}
_OTHER_SIDE = np.array([_INDEX[mirrored_name(part)] for part in PART_NAMES])


def weights_of(mesh: Sewn, body: Proportions) -> tuple[IndexArray, FloatArray]:
    """Return for each point up to four parts, (V, 4) in `PART_NAMES`, and weights, (V, 4).

    Weights are in descending order and add up to one; unused ones are zero, with part 0.
    """
    shares = _Shares(mesh, body)
    half = shares.all()
    right = np.arange(mesh.half_count)
    other = np.arange(mesh.half_count, len(mesh.points_m))
    whole = np.concatenate((half, half[mesh.mirrored[other]][:, _OTHER_SIDE]))
    on_seam = right[mesh.mirrored[right] == right]
    whole[on_seam] = (whole[on_seam] + whole[on_seam][:, _OTHER_SIDE]) / 2.0
    strength = np.array([_SMOOTHING.get(region, 0.0) for region in mesh.regions.tolist()])
    strength = np.concatenate((strength, strength[mesh.mirrored[other]]))[:, np.newaxis]
    rows, columns = neighbours(mesh.triangles, len(whole))
    for _ in range(_ROUNDS):
        whole += strength * (averages(rows, columns, whole) - whole)
    # Sums in another order differ in the last digit, so both sides get the right side's sums.
    whole[other] = whole[mesh.mirrored[other]][:, _OTHER_SIDE]
    whole[on_seam] = (whole[on_seam] + whole[on_seam][:, _OTHER_SIDE]) / 2.0
    return _strongest(whole)


def _strongest(shares: FloatArray) -> tuple[IndexArray, FloatArray]:
    parts = np.argsort(-shares, axis=1, kind="stable")[:, :MOST_PARTS]
    weights = np.take_along_axis(shares, parts, axis=1)
    weights[weights < _LEAST * weights[:, :1]] = 0.0
    weights /= weights.sum(axis=1, keepdims=True)
    return np.where(weights > 0.0, parts, 0), weights


class _Shares:
    """The shares of all parts in each point of the sewn half, before they are averaged."""

    def __init__(self, mesh: Sewn, body: Proportions) -> None:
        self._body = body
        self._stature = body.stature_m
        self._places = body.places_m()
        self._points = mesh.points_m[: mesh.half_count]
        self._regions = mesh.regions
        self._shares = np.zeros((mesh.half_count, len(PART_NAMES)))

    def all(self) -> FloatArray:
        """Return the shares, (N, 52)."""
        self._trunk(self._regions == "trunk", 0.0)
        self._trunk(self._regions == "head", 0.0)
        self._trunk(self._regions == "arm", 1.0)
        self._leg()
        self._foot()
        self._palm()
        for finger in FINGERS:
            self._finger(finger)
        return self._shares

    def _trunk(self, rows: npt.NDArray[np.bool_], arm: float) -> None:
        stature = self._stature
        x, y, z = self._points[rows].T
        # The neck is inclined: a level through the chin passes below the back of the head.
        above = (y - self._places["RightUpperArm"][1]) / stature  # the shoulders
        level = y - 0.4 * z * _rise((above + 0.018) / 0.03)
        trunk = ("Hips", "Spine", "Chest", "UpperChest", "Neck", "Head")
        heights = [self._places[part][1] for part in trunk[1:]]
        widths = [share * stature for share in (0.024, 0.024, 0.026, 0.016, 0.014)]
        along = _chain(level, heights, widths)
        shoulder, elbow, wrist = (
            self._places[f"Right{part}"][0] for part in ("UpperArm", "LowerArm", "Hand")
        )
        inwards = (x - 0.25 * shoulder) / (0.40 * shoulder)
        upwards = (above + 0.053) / 0.04
        below_neck = 1.0 - _rise((level - heights[3]) / (0.03 * stature))
        lateral = np.maximum(arm, _rise(inwards) * _rise(upwards) * below_neck)
        arms = _chain(
            x,
            (shoulder + 0.002 * stature, elbow, wrist),
            [share * stature for share in (0.026, 0.024, 0.014)],
        )
        thigh = self._thigh(x, y) * (1.0 - lateral)
        self._put(rows, trunk, along * (1.0 - lateral - thigh)[:, np.newaxis])
        self._put(
            rows,
            ("RightShoulder", "RightUpperArm", "RightLowerArm", "RightHand"),
            arms * lateral[:, np.newaxis],
        )
        self._put(rows, ("RightUpperLeg",), thigh[:, np.newaxis])

    def _thigh(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return the share of the thigh: all below the crotch, none at the seam above it."""
        hip = self._places["RightUpperLeg"][1]
        down = (hip - 0.012 * self._stature - y) / (0.09 * self._stature) + 0.5
        outwards = _rise(x / (0.038 * self._stature))
        below = _rise((hip - 0.058 * self._stature - y) / (0.028 * self._stature))
        share: FloatArray = _rise(down) * np.maximum(outwards, below)
        return share

    def _leg(self) -> None:
        rows = self._regions == "leg"
        x, y, _ = self._points[rows].T
        knee, ankle = (self._places[f"Right{part}"][1] for part in ("LowerLeg", "Foot"))
        widths = [share * self._stature for share in (0.030, 0.016)]
        legs = _chain(-y, (-knee, -ankle), widths)
        hips = 1.0 - self._thigh(x, y)
        self._put(rows, ("Hips",), hips[:, np.newaxis])
        parts = ("RightUpperLeg", "RightLowerLeg", "RightFoot")
        self._put(rows, parts, legs * (1.0 - hips)[:, np.newaxis])

    def _foot(self) -> None:
        rows = self._regions == "foot"
        _, y, z = self._points[rows].T
        ankle, toes = self._places["RightFoot"], self._places["RightToes"]
        shank = _rise((y - ankle[1]) / (0.032 * self._stature) + 0.35)
        along = _chain(-z, (-toes[2],), (0.016 * self._stature,))
        parts = ("RightFoot", "RightToes")
        self._put(rows, ("RightLowerLeg",), shank[:, np.newaxis])
        self._put(rows, parts, along * (1.0 - shank)[:, np.newaxis])

    def _palm(self) -> None:
        rows = self._regions == "palm"
        x, _, z = self._points[rows].T
        wrist = self._places["RightHand"][0]
        knuckles = np.array([self._places[f"Right{finger}Proximal"] for finger in FINGERS[1:]])
        fingers = np.array(
            [np.interp(z, knuckles[:, 2], np.eye(4)[number]) for number in range(4)]
        ).T
        knuckle = np.interp(z, knuckles[:, 2], knuckles[:, 0])
        bent = _rise((x - knuckle) / (0.018 * self._stature) + 0.5)
        hand = _rise((x - wrist) / (0.028 * self._stature) + 0.5)
        thumb = self._thenar(self._points[rows]) * (1.0 - bent)
        self._put(rows, ("RightLowerArm",), (1.0 - hand)[:, np.newaxis])
        proximal = tuple(f"Right{finger}Proximal" for finger in FINGERS[1:])
        self._put(rows, proximal, fingers * (hand * bent)[:, np.newaxis])
        self._put(rows, ("RightThumbProximal",), (hand * thumb)[:, np.newaxis])
        self._put(rows, ("RightHand",), (hand * (1.0 - bent - thumb))[:, np.newaxis])

    def _thenar(self, points: FloatArray) -> FloatArray:
        """Return the share of the thumb's first bone in the ball of the thumb."""
        root = np.array(self._places["RightThumbProximal"])
        bone = np.array(self._places["RightThumbIntermediate"]) - root
        length = float(np.linalg.norm(bone))
        along = (points - root) @ (bone / length)
        aside = np.linalg.norm(points - root - np.outer(along, bone / length), axis=1)
        near = _rise(1.6 - aside / (0.013 * self._stature))
        # It ends before the knuckle of the index finger, which must not follow the thumb.
        between = _rise((along / length - 0.05) / 0.6) * _rise((1.3 - along / length) / 0.5)
        share: FloatArray = near * between
        return share

    def _finger(self, finger: str) -> None:
        rows = self._regions == finger
        joints = np.array([self._places[f"Right{finger}{segment}"] for segment in SEGMENTS])
        towards = (joints[1] - joints[0]) / np.linalg.norm(joints[1] - joints[0])
        along = (self._points[rows] - joints[0]) @ towards
        at = [float((joint - joints[0]) @ towards) for joint in joints]
        thick = [self._body.radii_m[f"Right{finger}{segment}"] for segment in SEGMENTS]
        widths = (1.1 * thick[0], 0.85 * thick[1], 0.8 * thick[2])
        parts = ("RightHand", *(f"Right{finger}{segment}" for segment in SEGMENTS))
        self._put(rows, parts, _chain(along, at, widths))

    def _put(self, rows: npt.NDArray[np.bool_], parts: Sequence[str], shares: FloatArray) -> None:
        columns = np.array([_INDEX[part] for part in parts])
        self._shares[np.flatnonzero(rows)[:, np.newaxis], columns] += shares


def _chain(at: FloatArray, joints: Sequence[float], widths: Sequence[float]) -> FloatArray:
    """Return the shares of a chain of bones, (N, joints + 1), at places along it.

    The share passes from one bone to the next over twice the joint's width.
    """
    passed = [np.ones_like(at)]
    for joint, width in zip(joints, widths, strict=True):
        passed.append(passed[-1] * _rise((at - joint) / (2.0 * width) + 0.5))
    passed.append(np.zeros_like(at))
    return np.array([passed[n] - passed[n + 1] for n in range(len(joints) + 1)]).T


def _rise(share: FloatArray) -> FloatArray:
    """Return a smooth step from 0 at 0 to 1 at 1."""
    clipped = np.clip(share, 0.0, 1.0)
    smooth: FloatArray = clipped * clipped * (3.0 - 2.0 * clipped)
    return smooth
