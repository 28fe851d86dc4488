"""Checks of the tablet, the headset, and the quality of what the headset sends.

The headset's figures come from its live watch, so they exist only while it is connected. Movement
is sent only once the avatar has appeared; until then the checks that depend on it wait.
"""

from app.features.record.alarms import WatchLimits, open_alarms
from app.features.record.devices import TABLET_SILENT_AFTER_S, devices_of_session
from app.features.record.preflight.check import Finding, Found, Situation, StateCheck
from app.models import Device
from app.science.skeleton import JOINT_COUNT
from app.texts import Words

LIMITS = WatchLimits()
MIN_RATE_HZ = 60.0
"""A headset with a lower frame rate repeats images, however steady the rate is."""
MS_PER_S = 1000.0
_BROKEN = frozenset({"frozen", "bad_values"})
"""Codes of the alarms about invalid joints, which are also keys of the check's findings."""

UNPAIRED = Finding(
    "unpaired",
    "fail",
    Words(en="Not paired", de="Nicht gekoppelt"),
    remedy=Words(en="Pair it under Devices.", de="Koppeln Sie es unter Geräte."),
)


def _tablet(situation: Situation) -> Found:
    tablet = _paired(situation, "tablet")
    if tablet is None:
        return Found("unpaired")
    context = situation.context
    seen = context.hub.last_seen(tablet.id) or tablet.last_seen_at
    if seen is None:
        return Found("away", details=_name(tablet))
    silent_s = max(0.0, (context.clock.utc_now() - seen).total_seconds())
    return Found(
        "away" if silent_s >= TABLET_SILENT_AFTER_S else "ok",
        value=round(silent_s, 1),
        unit="s",
        expected="at_most",
        limit=TABLET_SILENT_AFTER_S,
        details=_name(tablet),
    )


TABLET = StateCheck(
    key="tablet",
    title=Words(en="Tablet", de="Tablet"),
    findings=(
        UNPAIRED,
        Finding(
            "away",
            "fail",
            Words(en="Not seen for {{value}}", de="Seit {{value}} nicht gesehen"),
            remedy=Words(
                en="Wake the tablet and check that its page is open.",
                de="Wecken Sie das Tablet auf und prüfen Sie, ob seine Seite offen ist.",
            ),
        ),
        Finding(
            "ok",
            "ok",
            Words(en="Paired, seen {{value}} ago", de="Gekoppelt, vor {{value}} gesehen"),
        ),
    ),
    run=_tablet,
    mended_in_seconds=True,
)


def _headset(situation: Situation) -> Found:
    headset = _paired(situation, "headset")
    if headset is None:
        return Found("unpaired")
    return Found("ok" if situation.headset_connected else "away", details=_name(headset))


HEADSET = StateCheck(
    key="headset",
    title=Words(en="Headset", de="Headset"),
    findings=(
        UNPAIRED,
        Finding(
            "away",
            "fail",
            Words(en="Paired, not connected", de="Gekoppelt, nicht verbunden"),
            remedy=Words(
                en="Wake the headset and open the page /vr in its browser.",
                de="Wecken Sie das Headset auf und öffnen Sie in seinem Browser die Seite /vr.",
            ),
        ),
        Finding("ok", "ok", Words(en="Paired and connected", de="Gekoppelt und verbunden")),
    ),
    run=_headset,
    mended_in_seconds=True,
)


def _paired(situation: Situation, kind: str) -> Device | None:
    devices = devices_of_session(situation.db, situation.session.id)
    return {device.kind: device for device in devices}.get(kind)


def _name(device: Device) -> tuple[str, ...]:
    return (device.name,) if device.name else ()


def _frame_rate(situation: Situation) -> Found:
    if not situation.headset_connected:
        return Found("no_headset")
    rate_hz = situation.signal.get("frame_rate_hz")
    usual_hz = situation.signal.get("usual_rate_hz")
    if not rate_hz:
        return Found("no_movement")
    if usual_hz is None:
        return Found("measuring", value=rate_hz, unit="Hz")
    min_hz = round(max(MIN_RATE_HZ, LIMITS.low_rate_share * usual_hz), 1)
    return Found(
        "low" if rate_hz < min_hz else "ok",
        value=rate_hz,
        unit="Hz",
        expected="at_least",
        limit=min_hz,
    )


FRAME_RATE = StateCheck(
    key="frame_rate",
    title=Words(en="Frame rate", de="Bildrate"),
    findings=(
        Finding("no_headset", "wait", Words(en="Needs the headset", de="Braucht das Headset")),
        Finding(
            "no_movement",
            "wait",
            Words(
                en="Measured once the avatar appears",
                de="Wird gemessen, sobald der Avatar erscheint",
            ),
        ),
        Finding(
            "measuring",
            "wait",
            Words(en="{{value}}, still stabilising", de="{{value}}, pendelt sich noch ein"),
        ),
        Finding(
            "low",
            "fail",
            Words(en="{{value}}", de="{{value}}"),
            remedy=Words(
                en="Close other programs on the headset's computer; check that it is plugged in.",
                de="Schließen Sie andere Programme auf dem Rechner des Headsets; prüfen Sie das "
                "Netzteil.",
            ),
        ),
        Finding("ok", "ok", Words(en="{{value}}", de="{{value}}")),
    ),
    run=_frame_rate,
)


def _clock(situation: Situation) -> Found:
    if not situation.headset_connected:
        return Found("no_headset")
    uncertainty_ms = situation.signal.get("clock_uncertainty_ms")
    if uncertainty_ms is None:
        return Found("measuring")
    max_ms = MS_PER_S * LIMITS.clock_uncertain_s
    return Found(
        "uncertain" if uncertainty_ms > max_ms else "ok",
        value=uncertainty_ms,
        unit="ms",
        expected="at_most",
        limit=max_ms,
    )


CLOCK = StateCheck(
    key="clock",
    title=Words(en="Clock", de="Uhr"),
    findings=(
        Finding("no_headset", "wait", Words(en="Needs the headset", de="Braucht das Headset")),
        Finding(
            "measuring",
            "wait",
            Words(en="The clocks are being compared", de="Die Uhren werden verglichen"),
        ),
        Finding(
            "uncertain",
            "fail",
            Words(en="Known only to ± {{value}}", de="Nur auf ± {{value}} bekannt"),
            remedy=Words(
                en="The network is slow: use the 5 GHz band or a cable, and stop downloads.",
                de="Das Netz ist langsam: Nehmen Sie das 5-GHz-Band oder ein Kabel und halten "
                "Sie Downloads an.",
            ),
        ),
        Finding("ok", "ok", Words(en="Accurate to ± {{value}}", de="Auf ± {{value}} genau")),
    ),
    run=_clock,
    mended_in_seconds=True,
)


def _trackers(situation: Situation) -> Found:
    """Check that no joint is frozen or invalid.

    Clients send joints, not trackers, so a tracker that is off shows as joints that are not valid.
    """
    for alarm in open_alarms(situation.db, situation.session.id):
        if alarm.code in _BROKEN:
            return Found(alarm.code, details=(alarm.message,))
    if not situation.signal.get("frame_rate_hz"):
        return Found("no_movement")
    return Found("ok", value=JOINT_COUNT, unit="joints", expected="at_least", limit=JOINT_COUNT)


TRACKERS = StateCheck(
    key="trackers",
    title=Words(en="Tracking", de="Tracking"),
    findings=(
        Finding(
            "no_movement",
            "wait",
            Words(
                en="Checked once the avatar appears",
                de="Wird geprüft, sobald der Avatar erscheint",
            ),
        ),
        Finding(
            "frozen",
            "fail",
            Words(en="Part of the body does not move", de="Ein Körperteil bewegt sich nicht"),
            remedy=Words(
                en="Switch the trackers on, and check that the cameras see them.",
                de="Schalten Sie die Tracker ein und prüfen Sie, ob die Kameras sie sehen.",
            ),
        ),
        Finding(
            "bad_values",
            "fail",
            Words(
                en="Invalid joint data received",
                de="Ungültige Gelenkdaten empfangen",
            ),
            remedy=Words(
                en="Restart the headset's program and calibrate again.",
                de="Starten Sie das Programm des Headsets neu und kalibrieren Sie neu.",
            ),
        ),
        Finding(
            "ok",
            "ok",
            Words(
                en="All {{value}} joints move and are valid",
                de="Alle {{value}} Gelenke bewegen sich und sind gültig",
            ),
        ),
    ),
    run=_trackers,
)
