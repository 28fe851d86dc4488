"""The tasks of the worker processes for tunings; the server only passes their names."""

import math
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from app.features.movement.captures import Cannot, Mapped
from app.features.movement.tuning.folder import TuningFolder
from app.features.movement.tuning.order import CannotTune, TunedBody, TuningOrder, tuning_options
from app.features.movement.tuning.report import followed_json, report_json
from app.protocol.avatar import loaded
from app.science.avatar.body import BodyError
from app.science.avatar.tuning import (
    Followed,
    Pose,
    RelaySettings,
    TuningError,
    follow_capture,
    relay_curve,
    step_curve,
    tune,
)
from app.science.retargeting import REFERENCE_JOINT_MAP, example_walk, movement_in_place
from app.science.rig import RigError
from app.science.rotations import FloatArray
from app.science.skeleton import Movement, SkeletonError, build_skeleton, resample

Json = dict[str, Any]
RATE_HZ = 90.0
"""The frame rate of a headset."""
SHORTEST_S = 1.0
"""The shortest movement that is compared."""
MAX_POINTS = 800
_DIGITS = 5


def run_tuning(order: TuningOrder, folder: Path) -> Json:
    """Tune a body, with what is measured kept in `folder`; raise CannotTune.

    Returns the report as it is stored, the tuned configuration, and the processor time.
    """
    files = TuningFolder(folder)
    started_s = time.process_time()
    try:
        report = tune(
            order.body.configuration(),
            order.body.stature_m,
            tuning_options(order.options),
            figure=order.body.parsed_figure(),
            wall_s=time.monotonic,
            progress=files.write_progress,
            journal=files.opened(),
        )
    except (TuningError, BodyError) as error:
        raise CannotTune(str(error)) from None
    return {
        "report": report_json(report, None),
        "canonical_json": loaded(report.configuration).canonical_json,
        "cpu_s": round(time.process_time() - started_s, 3),
    }


@dataclass(frozen=True)
class RelayRun:
    """The settings of a relay experiment and the pose of elbows and knees."""

    settings: RelaySettings
    pose: Pose


def axis_curves(
    before: TunedBody, after: TunedBody, axis: str, relay_axis: str, relay: RelayRun | None
) -> Json:
    """Return the curves of one axis, as an `AxisCurvesView` without its name; raise CannotTune.

    `relay_axis` had the experiment: the axis itself, or the one on the other side.
    """
    try:
        return {
            "relay": None if relay is None else _relay_json(after, relay_axis, relay),
            "before": _step_json(before, axis),
            "after": _step_json(after, axis),
        }
    except BodyError as error:
        raise CannotTune(str(error)) from None


def _relay_json(body: TunedBody, axis: str, relay: RelayRun) -> Json:
    found = relay_curve(
        body.configuration(),
        body.stature_m,
        axis,
        relay.settings,
        pose=relay.pose,
        wall_s=time.monotonic,
        figure=body.parsed_figure(),
    )
    return {
        "time_s": _thinned(found.times_s),
        "angle_deg": _thinned(np.degrees(found.angles_rad)),
        "torque_nm": _thinned(found.torques_nm),
        "hysteresis_deg": math.degrees(relay.settings.hysteresis_rad),
    }


def _step_json(body: TunedBody, axis: str) -> Json:
    found = step_curve(body.configuration(), body.stature_m, axis, figure=body.parsed_figure())
    return {
        "time_s": _thinned(found.times_s),
        "angle_deg": _thinned(np.degrees(found.angles_rad)),
        "torque_nm": _thinned(found.torques_nm),
        "target_deg": round(math.degrees(found.target_rad), _DIGITS),
        "saturated_share": found.saturated_share,
    }


def _thinned(values: FloatArray) -> list[float]:
    step = math.ceil(len(values) / MAX_POINTS)
    return [float(value) for value in np.round(values[::step], _DIGITS)]


def compared(before: TunedBody, after: TunedBody, mapped: Mapped | None, longest_s: float) -> Json:
    """Return how both bodies follow a capture, or a generated walk, as a `ComparisonView`.

    Raises CannotTune.
    """
    try:
        movement = _movement(mapped, before.stature_m, longest_s)
        return {
            "frames": movement.frame_count,
            "duration_s": movement.duration_s,
            "before": _followed(before, movement),
            "after": _followed(after, movement),
        }
    except Cannot as error:
        raise CannotTune(error.reason) from None
    except (TuningError, BodyError, RigError, SkeletonError) as error:
        raise CannotTune(str(error)) from None


def _movement(mapped: Mapped | None, stature_m: float, longest_s: float) -> Movement:
    skeleton = build_skeleton(stature_m)
    if mapped is None:
        found = movement_in_place(example_walk(), REFERENCE_JOINT_MAP, skeleton)
    else:
        found = movement_in_place(mapped.moving, dict(mapped.joint_map), skeleton)
    if found.duration_s < SHORTEST_S:
        raise CannotTune(
            f"the capture is {found.duration_s:.2f} s long, and its first half second, in which the"
            " body takes up the movement, does not count",
            value=f"{found.duration_s:.2f} s",
            valid=f"{SHORTEST_S:g} s or longer",
        )
    whole = resample(found, RATE_HZ)
    frames = int(longest_s * RATE_HZ)
    return replace(
        whole,
        root_positions_m=whole.root_positions_m[:frames],
        rotations=whole.rotations[:frames],
    )


def _followed(body: TunedBody, movement: Movement) -> Json:
    found: Followed = follow_capture(
        body.configuration(), body.stature_m, movement, figure=body.parsed_figure()
    )
    return {
        **followed_json(found),
        "rms_error_deg": dict(found.alone.rms_deg),
        "rms_torque_nm": dict(found.alone.rms_torque_nm),
    }
