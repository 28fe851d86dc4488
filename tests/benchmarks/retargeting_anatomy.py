"""Check every capture of the shared data by anatomy, and retarget it to an avatar of 165 cm.

One row per file with movement: what kind of body it is, what was checked for it and found, its
lengths, its steps and strides, their ratios on the avatar, and how deep the avatar's feet are under
the floor. Which checks apply:

- whole bodies: left and right, sides, lengths, toes, step heights, depth;
- lower bodies: the same without arms;
- upper bodies: left and right by the elbows, sides and lengths of the arms, depth. They have no
  steps, and the avatar's legs stand below the hips.

Each capture is also mirrored, and those with toes stripped of them, to see that this is noticed.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from app.adapters.captures import CaptureError, read_capture_file
from app.science.anatomy import (
    Notice,
    mirrored_bodies,
    mirrored_markers,
    mirrored_skeleton,
    segment_lengths,
    stature_from,
)
from app.science.fitting import FitError, fit_skeleton
from app.science.retargeting import (
    REFERENCE_JOINT_MAP,
    Retargeted,
    Walk,
    checked_skeleton,
    propose_joint_map,
    reference_avatar,
    retarget_motion,
)
from app.science.rig import BodyMotion, MarkerMotion, RigMotion
from tests.benchmarks.report import Figure
from tests.science.retargeting.test_anatomy_checks import without_toes
from tests.support.shared_data import shared_data_folder

STATURE_M = 1.65
DEPTH_LIMIT_M = 0.01
_ENDINGS = frozenset({".amc", ".bvh", ".c3d", ".csv", ".trc"})
_LEGS, _ARMS = frozenset({"LeftFoot", "RightFoot"}), frozenset({"LeftHand", "RightHand"})
Movement = RigMotion | MarkerMotion | BodyMotion


def rows() -> Iterator[dict[str, Any]]:
    """Return one row per file of the shared data that a capture's name ends like."""
    folder = shared_data_folder() / "motion"
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() in _ENDINGS:
            yield {"capture": str(path.relative_to(folder)), **_row(path)}


def figures(found: list[dict[str, Any]]) -> Iterator[Figure]:
    """Return the figures that have limits, and how many captures each rule refuses."""
    read = [row for row in found if row["refused"] is None]
    deepest = max(row["left_m"] for row in read)
    yield Figure("anatomy", "captures read", len(read), "files")
    yield Figure("anatomy", "deepest foot", 100.0 * deepest, "cm", "at most", 100.0 * DEPTH_LIMIT_M)
    missed = sum(not row["mirrored_noticed"] for row in read)
    yield Figure("anatomy", "mirror images that pass unnoticed", missed, "files", "at most", 0.0)
    for rule, count in refusals(found).items():
        yield Figure("anatomy", f"refused: {rule}", count, "files")


def refusals(found: list[dict[str, Any]]) -> dict[str, int]:
    """Return how many captures are refused by each rule."""
    rules = [row["rule"] for row in found if row["refused"] is not None]
    return {rule: rules.count(rule) for rule in sorted(set(rules))}


@dataclass(frozen=True, eq=False)
class _Done:
    motion: RigMotion
    joint_map: dict[str, str]
    notices: tuple[Notice, ...]
    result: Retargeted


def _row(path: Path) -> dict[str, Any]:
    try:
        motion = read_capture_file(path).motion
        done = _retargeted(motion)
    except CaptureError as error:
        return {"refused": str(error), "rule": "not a capture"}
    except FitError as error:
        return {"refused": str(error), "rule": "not a body"}
    lengths = _lengths(done)
    floor, walks = done.result.floor, done.result.walks
    return {
        "refused": None,
        "body": _kind(done.joint_map),
        "contains": type(motion).__name__.removesuffix("Motion").lower(),
        "notices": [[one.rule, one.action, one.value, one.valid] for one in done.notices],
        "stature_m": stature_from(lengths),
        "lengths_m": lengths,
        "leg_ratio": done.result.leg_ratio,
        "source": None if walks is None else _steps(walks.source),
        "avatar": None if walks is None else _steps(walks.avatar),
        "stride_length_ratio": _ratio(done, "mean_stride_length_m"),
        "step_height_ratio": _ratio(done, "mean_step_height_m"),
        "sunk_m": floor.sunk_m,
        "left_m": floor.left_m,
        "raised_m": floor.raised_m,
        "mean_raised_m": floor.mean_raised_m,
        "mirrored_noticed": _mirror_is_noticed(motion),
        "step_height_ratio_without_toes": _without_toes(done),
    }


def _retargeted(motion: Movement) -> _Done:
    notices: tuple[Notice, ...]
    if isinstance(motion, RigMotion):
        joint_map = dict(propose_joint_map(motion.rig).joint_map)
        skeleton, notices = checked_skeleton(motion, joint_map)
    else:
        fitted = fit_skeleton(motion)
        skeleton, notices = fitted.motion, fitted.notices
        joint_map = dict(propose_joint_map(skeleton.rig).joint_map)
    avatar = reference_avatar(STATURE_M)
    result = retarget_motion(skeleton, joint_map, avatar, REFERENCE_JOINT_MAP)
    return _Done(skeleton, joint_map, (*notices, *result.notices), result)


def _mirror_is_noticed(motion: Movement) -> bool:
    if isinstance(motion, RigMotion):
        done = _retargeted(mirrored_skeleton(motion))
    elif isinstance(motion, MarkerMotion):
        done = _retargeted(mirrored_markers(motion))
    else:
        done = _retargeted(mirrored_bodies(motion))
    return any(notice.rule == "mirrored" for notice in done.notices)


def _without_toes(done: _Done) -> float | None:
    if done.result.walks is None:
        return None
    bare = without_toes(done.motion)
    joint_map = {part: name for part, name in done.joint_map.items() if name in bare.rig.names}
    avatar = reference_avatar(STATURE_M)
    result = retarget_motion(bare, joint_map, avatar, REFERENCE_JOINT_MAP)
    return _ratio(replace(done, result=result), "mean_step_height_m")


def _lengths(done: _Done) -> dict[str, float]:
    rest, _ = done.motion.rig.rest_world()
    index = done.motion.rig.index
    return segment_lengths({part: rest[index(name)] for part, name in done.joint_map.items()})


def _kind(joint_map: dict[str, str]) -> str:
    has_legs, has_arms = set(joint_map) >= _LEGS, set(joint_map) >= _ARMS
    if has_legs and has_arms:
        return "whole body"
    return "lower body" if has_legs else "upper body"


def _steps(walk: Walk) -> dict[str, float | int | None]:
    return {
        "strides": len(walk.strides),
        "stride_length_m": walk.mean_stride_length_m,
        "step_length_m": walk.mean_step_length_m,
        "step_height_m": walk.mean_step_height_m,
    }


def _ratio(done: _Done, name: str) -> float | None:
    walks = done.result.walks
    if walks is None:
        return None
    avatar, source = getattr(walks.avatar, name), getattr(walks.source, name)
    return float(avatar / source) if avatar is not None and source else None
