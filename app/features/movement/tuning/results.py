"""Show a tuning's axes: from its journal while it is tuned, from its report afterwards."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from app.features.movement.tuning.folder import Measured
from app.features.movement.tuning.schemas import (
    GainChangeView,
    RelayView,
    StepResponseView,
    TunedAxis,
)
from app.science.avatar.configuration import AxisSettings, Configuration
from app.science.avatar.tuning import Experiment, NoOscillation, StepFigures, TuningOptions

Json = dict[str, Any]


def tuned_axes(configuration: Configuration, options: TuningOptions) -> tuple[str, ...]:
    """Return the axes that a tuning tunes: chosen, and free to turn."""
    locked = configuration.locked_axes
    return tuple(
        name for name in configuration.axes if name not in locked and options.includes(name)
    )


def measured_axes(
    configuration: Configuration, options: TuningOptions, measured: Iterable[Measured]
) -> list[TunedAxis]:
    """Return every axis of an unfinished tuning, with what was measured of it last."""
    found: dict[str, Json] = {}
    for one in measured:
        found.setdefault(one.axis, {}).update(_measured_json(one))
    tuned, locked = set(tuned_axes(configuration, options)), configuration.locked_axes

    def status(name: str) -> str:
        if name in locked:
            return "locked"
        return "waiting" if name in tuned else "kept"

    return [
        TunedAxis.model_validate(
            {"status": status(name), **_before(name, own), **found.get(name, {})}
        )
        for name, own in configuration.axes.items()
    ]


def reported_axes(configuration: Configuration, report: Mapping[str, Any]) -> list[TunedAxis]:
    """Return every axis of a finished tuning; `configuration` is the one before it."""
    return [_reported(one, configuration.axes[one["name"]]) for one in report["axes"]]


def with_accepted(
    before: Configuration, after: Configuration, accepted: Iterable[str]
) -> Configuration:
    """Return the configuration in which the accepted axes have their new gains."""

    axes = dict(before.axes)
    for name in accepted:
        axes[name] = after.axes[name]
    return replace(before, axes=axes)


def gain_changes(before: Configuration, after: Configuration) -> Iterator[GainChangeView]:
    """Yield every gain in which two configurations of the same axes differ."""
    for name, old in before.axes.items():
        new = after.axes[name]
        if old.kp != new.kp:
            yield GainChangeView(axis=name, field="kp_nm_per_rad", old=old.kp, new=new.kp)
        if old.kd != new.kd:
            yield GainChangeView(axis=name, field="kd_nm_s_per_rad", old=old.kd, new=new.kd)


def _before(name: str, own: AxisSettings) -> Json:
    return {"name": name, "kp_before": own.kp, "kd_before": own.kd}


def _measured_json(one: Measured) -> Json:
    result = one.result
    if isinstance(result, StepFigures):
        step = StepResponseView.model_validate(result, from_attributes=True)
        return {"status": "tested", "step": step, "attempts": one.attempt}
    if isinstance(result, NoOscillation):
        return {"status": "measured", "reason": result.reason, "attempts": one.attempt}
    return {
        "status": "measured", "reason": "", "relay": _relay_of(result), "attempts": one.attempt,
    }  # fmt: skip


def _relay_of(one: Experiment) -> RelayView:
    return RelayView(
        torque_nm=one.relay.torque_nm,
        torque_from="chosen" if one.push.chosen else "ramp",
        hysteresis_deg=math.degrees(one.relay.hysteresis_rad),
        pose=one.pose,
        amplitude_deg=math.degrees(one.found.amplitude_rad),
        period_s=one.found.period_s,
        ultimate_gain_nm_rad=one.found.ultimate_gain_nm_rad,
        inertia_kg_m2=one.found.inertia_kg_m2,
        simulated_s=one.found.simulated_s,
    )


def _reported(one: Json, own: AxisSettings) -> TunedAxis:
    status, _, reason = one["status"].partition(": ")
    step = None if one["step_deg"] is None else StepResponseView.model_validate(one)
    relay = None if one["relay"] is None else RelayView.model_validate(one["relay"])
    return TunedAxis(
        **_before(one["name"], own),
        status=status,
        reason=reason,
        note=one["note"],
        warning=one["warning"],
        kp=one["kp"],
        kd=one["kd"],
        attempts=one["attempts"],
        mirrored_from=one["mirrored_from"],
        relay=relay,
        step=step,
    )
