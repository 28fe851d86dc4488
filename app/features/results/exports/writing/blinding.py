"""Remove from an export what would reveal the condition of a blinded session.

The session stays in the export with what its participant answered and did; only what reveals its
condition is removed. Cells are emptied if a column names the condition, the avatar's latency, or a
hash: with three possible latencies, trying them on the hash finds the right one. Rows are left out
if a table has what the avatar did next to what the participant did, since the avatar lags behind
the participant by the latency. Of the frames only the participant's own remain.
"""

import json
from collections.abc import Collection

import pandas as pd

from app.features.record.sessions import canonical, without_condition

LEFT_OUT = frozenset(
    {"contacts", "completions", "joint_errors", "joint_error_course", "road_crossings"}
)
"""Tables from which the rows of blinded sessions are left out."""
EMPTIED = frozenset(
    {
        "order",
        "slot_index",
        "condition",
        "latency_ms",
        "body",
        "achieved_latency_ms",
        "achieved_latency_low_ms",
        "achieved_latency_high_ms",
        "latency_reason",
        "headset_compensated_ms",
        "previous_hash",
        "hash",
    }
)
"""Columns, of any table, whose cells are emptied for blinded sessions."""


def without_conditions(table: str, frame: pd.DataFrame, hidden: Collection[str]) -> pd.DataFrame:
    """Return a table without what reveals the condition of the `hidden` sessions (ids).

    `frame` is not modified. Columns and types are the same whether or not anything was removed.
    """
    rows = frame["session_id"].isin(list(hidden))
    if not rows.any():
        return frame
    if table in LEFT_OUT:
        return frame[~rows]
    masked = frame.copy()
    for name in EMPTIED & set(masked.columns):
        masked[name] = masked[name].mask(rows)
    if "payload" in masked.columns:
        of_hidden = masked.loc[rows, ["type", "payload"]].itertuples(index=False, name=None)
        masked.loc[rows, "payload"] = [_payload(kind, text) for kind, text in of_hidden]
    return masked


def _payload(kind: str, text: str) -> str:
    return canonical(without_condition(kind, json.loads(text)))
