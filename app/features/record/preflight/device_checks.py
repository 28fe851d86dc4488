"""Tablet, headset, and how good what the headset sends is.

The headset's figures are those of its live watch, so they exist only while it is connected.
Movement comes from the avatar's appearance on: what cannot be told before that waits.
"""

from collections.abc import Iterator, Mapping
from typing import Any, Literal

from sqlalchemy.orm import Session

from app.features.record.alarms import WatchLimits, open_alarms
from app.features.record.devices import TABLET_SILENT_AFTER_S, devices_of_session
from app.features.record.preflight.schemas import Check
from app.models import Device, StudySession
from app.platform.context import AppContext
from app.science.skeleton import JOINT_COUNT

LIMITS = WatchLimits()
LEAST_RATE_HZ = 60.0
"""A headset that comes to less repeats pictures, however steady it is."""
MS_PER_S = 1000.0
_BROKEN: Mapping[str, Literal["trackers.frozen", "trackers.bad_values"]] = {
    "frozen": "trackers.frozen",
    "bad_values": "trackers.bad_values",
}


def device_checks(db: Session, context: AppContext, session: StudySession) -> Iterator[Check]:
    """The checks of the devices, in the order of the list."""
    paired = {device.kind: device for device in devices_of_session(db, session.id)}
    yield _tablet(context, paired.get("tablet"))
    connected = context.hub.headset_connected(session.id)
    yield _headset(paired.get("headset"), connected=connected)
    signal = context.hub.signal(session.id) or {}
    yield _frame_rate(signal, connected=connected)
    yield _clock(signal, connected=connected)
    yield _trackers(db, session, signal)


def _tablet(context: AppContext, tablet: Device | None) -> Check:
    if tablet is None:
        return Check(key="tablet", status="fail", code="tablet.unpaired")
    seen = context.hub.last_seen(tablet.id) or tablet.last_seen_at
    if seen is None:
        return Check(key="tablet", status="fail", code="tablet.away", details=_name(tablet))
    silent_s = max(0.0, (context.clock.utc_now() - seen).total_seconds())
    away = silent_s >= TABLET_SILENT_AFTER_S
    return Check(
        key="tablet",
        status="fail" if away else "ok",
        code="tablet.away" if away else "tablet.ok",
        value=round(silent_s, 1),
        unit="s",
        expected="at_most",
        limit=TABLET_SILENT_AFTER_S,
        details=_name(tablet),
    )


def _headset(headset: Device | None, *, connected: bool) -> Check:
    if headset is None:
        return Check(key="headset", status="fail", code="headset.unpaired")
    return Check(
        key="headset",
        status="ok" if connected else "fail",
        code="headset.ok" if connected else "headset.away",
        details=_name(headset),
    )


def _name(device: Device) -> tuple[str, ...]:
    return (device.name,) if device.name else ()


def _frame_rate(signal: Mapping[str, Any], *, connected: bool) -> Check:
    if not connected:
        return Check(key="frame_rate", status="wait", code="frame_rate.no_headset")
    rate_hz, usual_hz = signal.get("frame_rate_hz"), signal.get("usual_rate_hz")
    if not rate_hz:
        return Check(key="frame_rate", status="wait", code="frame_rate.no_movement")
    if usual_hz is None:
        return Check(
            key="frame_rate", status="wait", code="frame_rate.measuring", value=rate_hz, unit="Hz"
        )
    least_hz = round(max(LEAST_RATE_HZ, LIMITS.low_rate_share * usual_hz), 1)
    low = rate_hz < least_hz
    return Check(
        key="frame_rate",
        status="fail" if low else "ok",
        code="frame_rate.low" if low else "frame_rate.ok",
        value=rate_hz,
        unit="Hz",
        expected="at_least",
        limit=least_hz,
    )


def _clock(signal: Mapping[str, Any], *, connected: bool) -> Check:
    if not connected:
        return Check(key="clock", status="wait", code="clock.no_headset")
    uncertainty_ms = signal.get("clock_uncertainty_ms")
    if uncertainty_ms is None:
        return Check(key="clock", status="wait", code="clock.measuring")
    most_ms = MS_PER_S * LIMITS.clock_uncertain_s
    uncertain = uncertainty_ms > most_ms
    return Check(
        key="clock",
        status="fail" if uncertain else "ok",
        code="clock.uncertain" if uncertain else "clock.ok",
        value=uncertainty_ms,
        unit="ms",
        expected="at_most",
        limit=most_ms,
    )


def _trackers(db: Session, session: StudySession, signal: Mapping[str, Any]) -> Check:
    """Clients send joints, not trackers: one that is off shows in joints that are not sound."""
    for alarm in open_alarms(db, session.id):
        if alarm.code in _BROKEN:
            return Check(
                key="trackers",
                status="fail",
                code=_BROKEN[alarm.code],
                details=(alarm.message,),
            )
    if not signal.get("frame_rate_hz"):
        return Check(key="trackers", status="wait", code="trackers.no_movement")
    return Check(
        key="trackers",
        status="ok",
        code="trackers.ok",
        value=JOINT_COUNT,
        unit="joints",
        expected="at_least",
        limit=JOINT_COUNT,
    )
