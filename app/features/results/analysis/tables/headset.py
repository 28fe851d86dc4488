"""The tables of what headsets reported of themselves: goal states, calibrations, added latency."""

from collections.abc import Iterator
from typing import Any

import pandas as pd
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.design.studies import study_by_key
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.context import finished, of_kind, sessions_context
from app.models import ClientReport, Study, StudySession
from app.wire import GOALS

MS_PER_S = 1000.0
STATE_COLUMNS = {
    goal: f"state_{name}"
    for goal, name in zip(
        GOALS, ("hips", "head", "left_hand", "right_hand", "left_shin", "right_shin"), strict=True
    )
}
"""The column of each goal in goal_states."""
_MEASURED = ("revision", "cause", "stature_m", "span_m", "eye_height_m")
SEGMENT_COLUMNS = {"upper_arm": "upper_arm_m", "forearm": "forearm_m"}
"""The column of each segment of the body that headsets measure in body_calibrations."""
_POSE = (*(f"offset_{axis}_m" for axis in "xyz"), *(f"offset_q{axis}" for axis in "wxyz"))


def goal_states_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per change of a goal's state, by session, run and seq of the first frame."""
    rows = [
        {
            "session_id": row.session_id,
            "epoch": row.epoch,
            "frame_seq": row.payload["frame_seq"],
            "client_t_s": row.payload["t_s"],
            "source": row.payload["source"],
            **{STATE_COLUMNS[goal]: state for goal, state in row.payload["states"].items()},
        }
        for row in _reports(db, study_by_key(db, study_key), kind, "goals")
    ]
    names = ("session_id", "epoch", "frame_seq", "client_t_s", "source")
    return _of_sessions(db, study_key, kind, "goal_states", rows, (*names, *STATE_COLUMNS.values()))


def body_calibrations_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per calibration and goal it knows, by session, run and report."""
    rows = [
        {"session_id": report.session_id, "epoch": report.epoch, **row}
        for report in _reports(db, study_by_key(db, study_key), kind, "calibration")
        for row in _of_calibration(report.seq, report.payload)
    ]
    measured = (*_MEASURED, *SEGMENT_COLUMNS.values())
    names = ("session_id", "epoch", "seq", "client_t_s", *measured, "notices", "goal", "source")
    columns = (*names, "residual_m", *_POSE)
    return _of_sessions(db, study_key, kind, "body_calibrations", rows, columns)


def added_latencies(db: Session, study: Study, kind: Kind) -> pd.DataFrame:
    """Return what the headset's computing added in each phase that it reported on, in ms.

    Of several reports of a phase, the one that added the most counts.
    """
    found: dict[tuple[str, int], tuple[float, float]] = {}
    for row in _reports(db, study, kind, "added_latency"):
        key = (row.session_id, row.payload["phase_id"])
        added = (MS_PER_S * row.payload["added_s"], MS_PER_S * row.payload["compensated_s"])
        found[key] = max(found.get(key, added), added)
    rows = [(*key, *added) for key, added in found.items()]
    names = ["session_id", "phase_id", "headset_added_ms", "headset_compensated_ms"]
    return pd.DataFrame(rows, columns=names, dtype=object)


def _of_calibration(seq: int, payload: dict[str, Any]) -> Iterator[dict[str, object]]:
    """Yield a row for each goal of a calibration; one without a goal if it names none."""
    segments_m = payload.get("segments_m", {})
    measured = {
        **{name: payload.get(name) for name in _MEASURED},
        **{column: segments_m.get(name) for name, column in SEGMENT_COLUMNS.items()},
    }
    shared = {
        "seq": seq,
        "client_t_s": payload["t_s"],
        **measured,
        "notices": " ".join(payload["notices"]) or None,
    }
    known = {*payload["sources"], *payload["residuals_m"], *payload["tracker_from_goal"]}
    goals: list[str | None] = [goal for goal in GOALS if goal in known]
    for goal in goals or [None]:
        pose = payload["tracker_from_goal"].get(goal)
        values = (None,) * len(_POSE) if pose is None else (*pose["position_m"], *pose["rotation"])
        yield {
            **shared,
            "goal": goal,
            "source": payload["sources"].get(goal),
            "residual_m": payload["residuals_m"].get(goal),
            **dict(zip(_POSE, values, strict=True)),
        }


def _reports(db: Session, study: Study, kind: Kind, type_: str) -> list[ClientReport]:
    query = (
        select(ClientReport)
        .join(StudySession, StudySession.id == ClientReport.session_id)
        .where(of_kind(study, kind), ClientReport.type == type_, ClientReport.accepted)
        .order_by(ClientReport.session_id, ClientReport.epoch, ClientReport.seq)
    )
    return list(db.scalars(query))


def _of_sessions(
    db: Session,
    study_key: str,
    kind: Kind,
    table: str,
    rows: list[dict[str, object]],
    names: tuple[str, ...],
) -> pd.DataFrame:
    frame = pd.DataFrame(rows, columns=list(names), dtype=object)
    return finished(sessions_context(db, study_key, kind).merge(frame, on="session_id"), table)
