"""The tables of the equipment: clock probes, clock mappings, calibrations and self-tests."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.design.studies import study_by_key
from app.features.record.calibrations import calibrations
from app.features.record.self_tests import SelfTestView, self_tests
from app.features.results.analysis.codebook import columns_of
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.clocks import NS_PER_S, RunClock, run_clocks
from app.features.results.analysis.tables.context import finished, of_kind, read, sessions_context
from app.models import ClockProbe, StudySession

MS_PER_S = 1000.0
PPM = 1e6
_UNITS = (("bytes_per_s", "B/s"), ("bytes", "B"), ("_s", "s"), ("_hz", "Hz"), ("_m", "m"))
"""The ends of the names of figures, and their units; a figure of another name is a number."""


def clock_probes_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per clock probe, by session, run and the client's time."""
    query = (
        select(
            ClockProbe.session_id,
            ClockProbe.epoch,
            ClockProbe.client_sent_s,
            ClockProbe.server_received_ns,
            ClockProbe.server_sent_ns,
            ClockProbe.client_received_s,
            ClockProbe.server_utc,
            StudySession.time_scale,
        )
        .join(StudySession, StudySession.id == ClockProbe.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
        .order_by(ClockProbe.epoch, ClockProbe.client_sent_s, ClockProbe.id)
    )
    server = ("server_received_ns", "server_sent_ns")
    names = ("session_id", "epoch", "client_sent_s", *server, "client_received_s", "server_utc")
    probes = read(db, query, (*names, "time_scale"))
    sent_s, back_s = _number(probes["client_sent_s"]), _number(probes["client_received_s"])
    received_ns, answered_ns = _number(probes[server[0]]), _number(probes[server[1]])
    probes["server_received_s"] = received_ns / NS_PER_S
    probes["server_sent_s"] = answered_ns / NS_PER_S
    waited_s = (back_s - sent_s) / _number(probes["time_scale"])
    probes["round_trip_ms"] = MS_PER_S * (waited_s - (answered_ns - received_ns) / NS_PER_S)
    probes["offset_s"] = 0.5 * ((received_ns + answered_ns) / NS_PER_S - sent_s - back_s)
    probes["timed_out"] = probes["client_received_s"].isna()
    sessions = sessions_context(db, study_key, kind)
    return finished(sessions.merge(probes, on="session_id"), "clock_probes")


def clock_mapping_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per segment of a clock mapping, by session, run and segment."""
    sessions = sessions_context(db, study_key, kind)
    rows = [
        {"session_id": session_id, **row}
        for session_id in sessions["session_id"]
        for clock in run_clocks(db, session_id).values()
        for row in _segments(clock)
    ]
    names = ("session_id", "epoch", "segment", "from_s", "to_s", "from_utc", "to_utc", "offset_s")
    fitted = ("drift_ppm", "min_round_trip_ms", "uncertainty_ms", "probes", "left_out")
    steps = ("step_ms", "stepped", "server_utc_step_ms")
    mapping = pd.DataFrame(rows, columns=[*names, *fitted, *steps], dtype=object)
    return finished(sessions.merge(mapping, on="session_id"), "clock_mapping")


def _segments(clock: RunClock) -> list[dict[str, object]]:
    """Return a clock's segments, in the client's own seconds and the server's clock time."""
    rows: list[dict[str, object]] = []
    for number, segment in enumerate(clock.mapping.segments, start=1):
        from_s = segment.client_from_s * clock.time_scale
        to_s = segment.client_to_s * clock.time_scale
        utc, _ = clock.to_utc(np.array([from_s, to_s]))
        rows.append(
            {
                "epoch": clock.epoch,
                "segment": number,
                "from_s": from_s,
                "to_s": to_s,
                "from_utc": utc[0],
                "to_utc": utc[1],
                "offset_s": clock.base_s + segment.client_from_s + segment.offset_s - from_s,
                "drift_ppm": PPM * segment.drift,
                "min_round_trip_ms": MS_PER_S * segment.min_round_trip_s,
                "uncertainty_ms": MS_PER_S * segment.uncertainty_s,
                "probes": segment.probes,
                "left_out": segment.left_out,
                "step_ms": MS_PER_S * segment.step_s,
                "stepped": segment.stepped or None,
                "server_utc_step_ms": MS_PER_S * (segment.wall_s - clock.anchor_s),
            }
        )
    return rows


def _number(values: "pd.Series[float]") -> "pd.Series[float]":
    return values.astype("float64")


def calibrations_table(db: Session) -> pd.DataFrame:
    """Return one row per calibration, retired ones included, by equipment and newest first."""
    rows = [view.model_dump() for view in calibrations(db)]
    names = ("equipment", "motion_to_photon_ms", "sd_ms", "samples", "method", "measured_on")
    more = ("current", "note", "at", "retired_at", "retired_reason")
    frame = pd.DataFrame(rows, columns=[*names, *more], dtype=object)
    frame["measured_on"] = [day.isoformat() for day in frame["measured_on"]]
    renamed = {"at": "recorded_at_utc", "retired_at": "retired_at_utc"}
    return finished(frame.rename(columns=renamed), "calibrations")


def headset_tests_table(db: Session) -> pd.DataFrame:
    """Return one row per self-test of a headset and figure, newest test first.

    The verdicts of a test come first, with status and limit; then every figure as it was reported.
    """
    names = [column.name for column in columns_of("headset_tests")]
    rows = [row for view in self_tests(db) for row in _of_self_test(view)]
    return finished(pd.DataFrame(rows, columns=names, dtype=object), "headset_tests")


def _of_self_test(view: SelfTestView) -> Iterator[dict[str, object]]:
    report = view.report
    physics = report.physics
    test: dict[str, object] = {
        "self_test_id": view.id,
        "started_at_utc": report.started_at,
        "received_at_utc": view.received_at,
        "clock_ahead_s": view.clock_ahead_s,
        "device": report.device.name,
        "user_agent": report.device.user_agent,
        "inputs": " ".join(report.device.inputs) or None,
        "worn": view.worn,
        "rendering_mode": report.rendering.mode,
        "physics_where": None if physics is None else physics.where,
        "model_hash": None if physics is None else physics.model_hash,
        "errors": "; ".join(report.page.errors) or None,
    }
    for verdict in view.verdicts:
        judged = verdict.model_dump(include={"value", "unit", "status", "limit", "at_least"})
        yield {**test, "figure": f"verdict.{verdict.code}", **judged}
    for name, value in _figures(report.model_dump(include=_MEASURED)):
        unit = next((unit for end, unit in _UNITS if name.endswith(end)), None)
        yield {**test, "figure": name, "value": value, "unit": unit}


_MEASURED = {"duration_s", "rendering", "physics", "tracking", "storage", "page"}


def _figures(part: dict[str, Any], path: str = "") -> Iterator[tuple[str, float]]:
    """Yield every number of a report with its place in it."""
    for name, value in part.items():
        if isinstance(value, dict):
            yield from _figures(value, f"{path}{name}.")
        elif isinstance(value, int | float):
            yield f"{path}{name}", float(value)
