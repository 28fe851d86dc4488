"""What an export leaves out of a session whose condition must not be known yet.

The session stays in the export with what its participant said and did; only what tells its
condition is taken out. Cells are emptied where a column names the condition, the latency that the
avatar had, or a hash: with three latencies to try, a hash tells which it was. Rows are left out
where a table holds what the avatar did beside what the participant did, since the one lags behind
the other by the latency. Of the frames only the participant's own stay.
"""

import json
from collections.abc import Collection

import pandas as pd

from app.features.record.sessions import canonical, without_condition

LEFT_OUT = frozenset({"contacts", "completions", "joint_errors", "joint_error_course"})
"""Tables without rows of such a session."""
EMPTIED = frozenset(
    {
        "order",
        "slot_index",
        "condition",
        "latency_ms",
        "achieved_latency_ms",
        "achieved_latency_low_ms",
        "achieved_latency_high_ms",
        "latency_reason",
        "previous_hash",
        "hash",
    }
)
"""Columns, of whatever table, without values of such a session."""


def without_conditions(table: str, frame: pd.DataFrame, hidden: Collection[str]) -> pd.DataFrame:
    """The rows of a table as they may leave; `hidden` are ids of sessions. `frame` stays as it is.

    Columns and their types are the same whether or not anything was taken out.
    """
    rows = frame["session_id"].isin(list(hidden))
    if not rows.any():
        return frame
    if table in LEFT_OUT:
        return frame[~rows]
    told = frame.copy()
    for name in EMPTIED & set(told.columns):
        told[name] = told[name].mask(rows)
    if "payload" in told.columns:
        told.loc[rows, "payload"] = told.loc[rows, "payload"].map(_payload)
    return told


def _payload(text: str) -> str:
    return canonical(without_condition(json.loads(text)))
